//! Where things that move are at a time.

use nalgebra::Vector3;

/// A closed way walked at constant speed, for ever.
#[derive(Clone, Debug)]
pub struct Path {
    /// Corners relative to the start, the start first and last.
    corners: Vec<[f64; 2]>,
    /// Length of the way up to each corner.
    lengths_m: Vec<f64>,
    speed_m_s: f64,
    ahead_s: f64,
}

impl Path {
    /// From the start through `places` (relative to it) and back. `None` if that has no length.
    pub fn new(places: &[[f32; 2]], speed_m_s: f32, ahead_s: f32) -> Option<Self> {
        let mut corners = vec![[0.0, 0.0]];
        corners.extend(places.iter().map(|place| place.map(f64::from)));
        corners.push([0.0, 0.0]);
        let mut way_m = 0.0;
        let mut lengths_m = vec![0.0];
        for leg in corners.windows(2) {
            let (x, y) = (leg[1][0] - leg[0][0], leg[1][1] - leg[0][1]);
            way_m += (x * x + y * y).sqrt();
            lengths_m.push(way_m);
        }
        (way_m > 0.0).then(|| Self {
            corners,
            lengths_m,
            speed_m_s: f64::from(speed_m_s),
            ahead_s: f64::from(ahead_s),
        })
    }

    /// How far from its start a thing is at `time_s`.
    pub fn offset_m(&self, time_s: f64) -> Vector3<f32> {
        let whole_m = self.lengths_m[self.lengths_m.len() - 1];
        let way_m = ((time_s + self.ahead_s) * self.speed_m_s) % whole_m;
        let next = self.lengths_m.partition_point(|length| *length <= way_m);
        let next = next.clamp(1, self.corners.len() - 1);
        let (start_m, end_m) = (self.lengths_m[next - 1], self.lengths_m[next]);
        let share = if end_m > start_m {
            (way_m - start_m) / (end_m - start_m)
        } else {
            0.0
        };
        let [from, to] = [self.corners[next - 1], self.corners[next]];
        let at = |axis: usize| (from[axis] + share * (to[axis] - from[axis])) as f32;
        Vector3::new(at(0), at(1), 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_walker_goes_round_at_its_speed_and_comes_back() {
        let path = Path::new(&[[3.0, 0.0], [3.0, 4.0]], 2.0, 0.0).unwrap();
        assert_eq!(path.offset_m(0.0), Vector3::zeros());
        assert_eq!(path.offset_m(0.5), Vector3::new(1.0, 0.0, 0.0));
        assert_eq!(path.offset_m(2.5), Vector3::new(3.0, 2.0, 0.0));
        // The way back is 5 m, so the round takes 6 s.
        assert_eq!(path.offset_m(4.75), Vector3::new(1.5, 2.0, 0.0));
        assert_eq!(path.offset_m(12.5), path.offset_m(0.5));
    }

    #[test]
    fn who_is_ahead_is_where_others_come_later() {
        let start = Path::new(&[[3.0, 0.0]], 1.0, 0.0).unwrap();
        let ahead = Path::new(&[[3.0, 0.0]], 1.0, 1.5).unwrap();
        assert_eq!(ahead.offset_m(1.0), start.offset_m(2.5));
    }

    #[test]
    fn a_way_without_length_is_none() {
        assert!(Path::new(&[[0.0, 0.0]], 1.0, 0.0).is_none());
    }
}
