//! Light that changes in time.

/// A light's level over time: straight lines between times, constant before the first and after the
/// last; it may begin again.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Seconds, ascending, and levels; never empty.
    points: Vec<(f64, f32)>,
    period_s: Option<f64>,
}

impl Curve {
    /// A curve through `points`; `None` if there are none, or their times do not ascend.
    pub fn new(points: Vec<(f64, f32)>, period_s: Option<f64>) -> Option<Self> {
        let ascending = points.windows(2).all(|pair| pair[0].0 < pair[1].0);
        (ascending && !points.is_empty()).then_some(Self { points, period_s })
    }

    /// The level at `time_s`.
    pub fn level(&self, time_s: f64) -> f32 {
        let time_s = match self.period_s {
            Some(period_s) => time_s % period_s,
            None => time_s,
        };
        let after = self.points.partition_point(|(at_s, _)| *at_s <= time_s);
        match (after.checked_sub(1), self.points.get(after)) {
            (Some(before), Some(&(end_s, end))) => {
                let (start_s, start) = self.points[before];
                start + (end - start) * ((time_s - start_s) / (end_s - start_s)) as f32
            }
            (Some(last), None) => self.points[last].1,
            (None, _) => self.points[0].1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_light_is_straight_between_its_times_and_constant_outside() {
        let curve = Curve::new(vec![(10.0, 1.0), (20.0, 3.0)], None).unwrap();
        let levels = [0.0, 10.0, 12.5, 20.0, 99.0].map(|time_s| curve.level(time_s));
        assert_eq!(levels, [1.0, 1.0, 1.5, 3.0, 3.0]);
    }

    #[test]
    fn a_periodic_light_begins_again() {
        let curve = Curve::new(vec![(0.0, 0.0), (2.0, 1.0), (4.0, 0.0)], Some(4.0)).unwrap();
        assert_eq!(curve.level(1.0), 0.5);
        assert_eq!(curve.level(1.0 + 12.0), 0.5);
    }

    #[test]
    fn times_that_do_not_ascend_make_no_light() {
        assert!(Curve::new(vec![(1.0, 0.0), (1.0, 2.0)], None).is_none());
        assert!(Curve::new(Vec::new(), None).is_none());
    }
}
