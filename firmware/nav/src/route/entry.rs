//! Where a drone beside the stored way joins it: the part of the way beyond that point is left out.

use nalgebra::Point2;

use super::Route;
use super::vector::{ODOMETRY_RESOLUTION_M, OdometryVector};

/// A point of the stored way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Entry {
    /// How far it is, metres.
    pub(crate) distance_m: f32,
    /// Where it lies; none at the end of the way, or where the drone is still on its way there.
    at: Option<Cut>,
}

/// A point on a vector of the way.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cut {
    /// Vectors on the stack below that vector.
    below: usize,
    /// Share of the vector that lies beyond the point, 0..=1.
    beyond: f32,
}

impl Route {
    /// Where a drone that is `here` joins the way: at the point with the least sum of its distance and
    /// `drift` times the way from it to the route's end, metres.
    ///
    /// The estimate has drifted along that way when it was recorded. Where the way crosses itself, or was
    /// flown to and fro, the part that was flown last is therefore the one to be trusted. A way home that is
    /// longer than it might be leads home; a shortcut to a place where the drone is not does not.
    pub(crate) fn entry(&self, here: Point2<f32>, drift: f32) -> Entry {
        let mut upper = self.tip;
        let (distance_m, _) = self.nearest(upper, self.popped, here, -1.0);
        let mut best = Entry {
            distance_m,
            at: None,
        };
        let (mut way_m, mut least) = (0.0, distance_m);
        for (below, &vector) in self.vectors.iter().enumerate().rev() {
            if drift * way_m >= least {
                break;
            }
            let (distance_m, beyond) = self.nearest(upper, vector, here, 1.0);
            let length_m = vector.metres().norm();
            let price = distance_m + drift * (way_m + beyond * length_m);
            if price < least {
                least = price;
                let at = Some(Cut { below, beyond });
                best = Entry { distance_m, at };
            }
            way_m += length_m;
            upper = step_back(upper, vector);
        }
        best
    }

    /// Forgets the way beyond a point of it, and the snapshots there.
    pub(crate) fn cut(&mut self, entry: &Entry) {
        let Some(Cut { below, beyond }) = entry.at else {
            return;
        };
        while self.vectors.len() > below.saturating_add(1) {
            self.pop_vector();
        }
        let Some(whole) = self.pop_vector() else {
            return;
        };
        let share = |counts: i8| libm::roundf(f32::from(counts) * (1.0 - beyond)) as i8;
        let kept = OdometryVector {
            x: share(whole.x),
            y: share(whole.y),
        };
        // One was taken off: there is room.
        if kept != OdometryVector::default() && self.vectors.push(kept).is_ok() {
            self.tip[0] += i32::from(kept.x);
            self.tip[1] += i32::from(kept.y);
        }
        self.popped = OdometryVector::default();
        let highest = if kept == whole { below + 1 } else { below };
        self.snapshots.drop_above(highest);
    }

    /// The distance of a place from the straight way that leads from a point back by a vector (`sign` 1) or
    /// onward by it (-1), metres, and the share of the vector up to the nearest point.
    #[inline(never)] // Flash counts more than cycles here.
    fn nearest(
        &self,
        from: [i32; 2],
        vector: OdometryVector,
        place: Point2<f32>,
        sign: f32,
    ) -> (f32, f32) {
        let way = vector.metres() * -sign;
        let away = place - self.point(from);
        let length = way
            .norm_squared()
            .max(ODOMETRY_RESOLUTION_M * ODOMETRY_RESOLUTION_M);
        let share = (away.dot(&way) / length).clamp(0.0, 1.0);
        ((away - way * share).norm(), share)
    }
}

fn step_back(from: [i32; 2], vector: OdometryVector) -> [i32; 2] {
    [from[0] - i32::from(vector.x), from[1] - i32::from(vector.y)]
}

#[cfg(test)]
mod tests;
