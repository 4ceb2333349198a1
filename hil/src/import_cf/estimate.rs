//! Where the drone believed it was.

use core::f64::consts::{PI, TAU};

use super::series::{GAP_MS, Series, Variables, share};
use crate::record::PlanarPose;

/// Time between two points of the track, ms.
const TRACK_PERIOD_MS: u64 = 100;

/// Variables that hold the place, best first: x north and y west, and what makes metres of each.
///
/// `stateEstimate` and `kalman.state` are the filter's state in the world, m; `stateEstimateZ` is the same in mm
/// (crazyflie-firmware `stabilizer`, `kalman_core`). `vh.v_pos` is where the flight app was when it took its last
/// vector, east and north.
const PLACES: [[(&str, f64); 2]; 4] = [
    [("stateEstimate.x", 1.0), ("stateEstimate.y", 1.0)],
    [("kalman.stateX", 1.0), ("kalman.stateY", 1.0)],
    [("stateEstimateZ.x", 1e-3), ("stateEstimateZ.y", 1e-3)],
    [("vh.v_pos_n", 1.0), ("vh.v_pos_e", -1.0)],
];

/// Variables that hold the height, best first, and what makes metres of them.
const HEIGHTS: [(&str, f64); 3] = [
    ("stateEstimate.z", 1.0),
    ("kalman.stateZ", 1.0),
    ("stateEstimateZ.z", 1e-3),
];

/// Variables that hold the heading in degrees, counter-clockwise, best first.
const YAWS: [(&str, f64); 2] = [("stateEstimate.yaw", 1.0), ("stabilizer.yaw", 1.0)];

/// A variable in SI units.
#[derive(Clone, Copy, Debug)]
struct Scaled<'v> {
    name: &'static str,
    series: &'v Series,
    factor: f64,
}

impl<'v> Scaled<'v> {
    fn of(variables: &'v Variables, (name, factor): (&'static str, f64)) -> Option<Self> {
        let series = variables.get(name)?;
        Some(Self {
            name,
            series,
            factor,
        })
    }

    fn between(&self, ms: u64) -> Option<f64> {
        Some(self.factor * self.series.between(ms)?)
    }
}

/// The drone's own estimate over time.
#[derive(Clone, Debug)]
pub struct Track<'v> {
    x: Scaled<'v>,
    y: Scaled<'v>,
    yaw: Option<Scaled<'v>>,
    height: Option<Scaled<'v>>,
}

impl<'v> Track<'v> {
    /// The best estimate in the logs; none where there is none at all.
    pub fn of(variables: &'v Variables) -> Option<Self> {
        let scaled = |source| Scaled::of(variables, source);
        let [x, y] = PLACES
            .into_iter()
            .find_map(|[x, y]| Some([scaled(x)?, scaled(y)?]))?;
        Some(Self {
            x,
            y,
            yaw: YAWS.into_iter().find_map(scaled),
            height: HEIGHTS.into_iter().find_map(scaled),
        })
    }

    /// Names of the variables that place, heading and height come from.
    pub fn sources(&self) -> [Option<&'static str>; 3] {
        let name = |scaled: Scaled| scaled.name;
        [Some(self.x.name), self.yaw.map(name), self.height.map(name)]
    }

    /// Whole tenths of a second at which the place is known, ms.
    pub fn instants(&self) -> Vec<u64> {
        let times: Vec<u64> = self.x.series.times().collect();
        let mut instants = Vec::new();
        let mut next = 0;
        for pair in times.windows(2) {
            if pair[1] - pair[0] > GAP_MS {
                continue;
            }
            next = pair[0].next_multiple_of(TRACK_PERIOD_MS).max(next);
            while next <= pair[1] {
                instants.push(next);
                next += TRACK_PERIOD_MS;
            }
        }
        instants.retain(|ms| self.is_known(*ms));
        instants
    }

    /// Where the drone believed it was; the heading is NaN where it is not known.
    pub fn pose(&self, ms: u64) -> Option<PlanarPose> {
        Some(PlanarPose {
            x: self.x.between(ms)?,
            y: self.y.between(ms)?,
            yaw: self.yaw(ms).unwrap_or(f64::NAN),
        })
    }

    /// Height above the ground, metres.
    pub fn height(&self, ms: u64) -> Option<f64> {
        self.height?.between(ms)
    }

    /// The last height that was logged up to about this time, metres; none where no height was logged at all.
    pub fn height_held(&self, ms: u64) -> Option<f64> {
        let height = self.height?;
        Some(height.factor * height.series.left_by(ms)?)
    }

    fn is_known(&self, ms: u64) -> bool {
        self.x.between(ms).is_some() && self.y.between(ms).is_some()
    }

    /// The heading, the short way round between two samples, radians within half a turn.
    fn yaw(&self, ms: u64) -> Option<f64> {
        let [before, after] = self.yaw?.series.around(ms)?;
        let [from, to] = [before.1, after.1].map(f64::to_radians);
        let turn = libm::remainder(to - from, TAU);
        let yaw = from + share([before.0, after.0], ms) * turn;
        // A heading that was met exactly is left as it was logged.
        Some(if yaw.abs() <= PI {
            yaw
        } else {
            libm::remainder(yaw, TAU)
        })
    }
}
