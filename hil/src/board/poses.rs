//! Where the camera has been of late: a row of an image is seen from the middle of its exposure, which
//! lies in the past when the row is read out.

use std::collections::VecDeque;

use fake_sensors::camera::{Moment, Pose};

/// Poses that are kept, one a millisecond: half of the longest shutter (525 lines, at half rate 78 ms)
/// and a row's way through the board's clock.
const KEPT: usize = 64;

/// What the camera's times are rounded to, nanoseconds. An emulated board's flight begins with a cycle
/// of its processor, up to 6 ns late by the camera's clock, and its edges are whole nanoseconds: less
/// than the rounding, so that it sees what a board without a processor sees, to the bit.
const GRAIN_NS: i64 = 1_000;

/// Half a grain, to the nearest, and half of the least step between two of the camera's times (a half
/// of 1/21 us): the border between two grains is as far from those as it can be.
const BORDER_NS: i64 = GRAIN_NS / 2 + 12;

/// Poses on the camera's clock.
#[derive(Clone, Debug)]
pub struct Poses {
    /// Oldest first; never empty.
    known: VecDeque<(u64, Pose)>,
    /// When the flight began on the camera's clock.
    epoch_ns: Option<u64>,
}

impl Poses {
    /// A camera that has stood there.
    pub fn new(pose: Pose) -> Self {
        Self {
            known: VecDeque::from([(0, pose)]),
            epoch_ns: None,
        }
    }

    /// From `now_ns` (camera's clock, never backwards) on it is there. The first call begins the flight.
    pub fn push(&mut self, now_ns: u64, pose: Pose) {
        self.epoch_ns.get_or_insert(now_ns);
        if self.known.len() == KEPT {
            self.known.pop_front();
        }
        self.known.push_back((now_ns, pose));
    }

    /// Pose and time of flight at `at_ns`: between two poses on the way from one to the other, before
    /// the oldest and after the newest at rest.
    pub fn at(&self, at_ns: u64) -> Moment {
        let at_ns = self.rounded(at_ns);
        let begun_ns = at_ns.saturating_sub(self.epoch_ns.unwrap_or(at_ns));
        let next = self
            .known
            .partition_point(|(since_ns, _)| *since_ns <= at_ns);
        let before = next.checked_sub(1).and_then(|index| self.known.get(index));
        let pose = match (before, self.known.get(next)) {
            (Some((from_ns, from)), Some((to_ns, to))) => {
                let way = (at_ns - from_ns) as f32 / (to_ns - from_ns) as f32;
                between(from, to, way)
            }
            (Some((_, pose)), None) | (None, Some((_, pose))) => *pose,
            (None, None) => unreachable!("there always is a pose"),
        };
        Moment {
            pose,
            time_s: begun_ns as f64 * 1e-9,
        }
    }

    /// What [`at`](Self::at) says of `at_ns` from now on, whatever poses come; none where the next may change it.
    pub fn settled(&self, at_ns: u64) -> Option<Moment> {
        let (newest_ns, _) = self.known.back()?;
        (self.rounded(at_ns) < *newest_ns).then(|| self.at(at_ns))
    }
}

impl Poses {
    /// Whole grains from the beginning of the flight.
    fn rounded(&self, at_ns: u64) -> u64 {
        let Some(epoch_ns) = self.epoch_ns else {
            return at_ns;
        };
        let since_ns = at_ns.wrapping_sub(epoch_ns).cast_signed();
        let grains = (since_ns + BORDER_NS).div_euclid(GRAIN_NS);
        epoch_ns.saturating_add_signed(grains * GRAIN_NS)
    }
}

/// `way` (0..=1) from one pose to the next: a millisecond apart, so a chord will do for the arc.
fn between(from: &Pose, to: &Pose, way: f32) -> Pose {
    Pose {
        position_m: from.position_m.lerp(&to.position_m, way),
        attitude: from.attitude.nlerp(&to.attitude, way),
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{UnitQuaternion, Vector3};

    use super::*;

    fn pose(x: f32) -> Pose {
        Pose {
            position_m: Vector3::new(x, 0.0, 0.5),
            attitude: UnitQuaternion::from_euler_angles(0.0, 0.0, 0.1 * x),
        }
    }

    fn path() -> Poses {
        let mut poses = Poses::new(pose(0.0));
        for ms in 0..100 {
            poses.push(5_000_000 + ms * 1_000_000, pose(ms as f32));
        }
        poses
    }

    #[test]
    fn between_two_poses_the_camera_is_on_its_way() {
        let moment = path().at(90_250_000);
        assert!((moment.pose.position_m.x - 85.25).abs() < 1e-4);
        let (_, _, yaw) = moment.pose.attitude.euler_angles();
        let turned = (yaw - 8.525).rem_euclid(core::f32::consts::TAU);
        assert!(turned.min(core::f32::consts::TAU - turned) < 1e-4);
        assert!((moment.time_s - 0.085_25).abs() < 1e-9);
    }

    #[test]
    fn a_clock_that_is_a_few_nanoseconds_late_sees_the_same() {
        let poses = path();
        for cycle in 0..42 {
            // A time of the camera's, in halves of 1/21 us.
            let at_ns = 90_250_000 + (cycle * 1_000_u64).div_ceil(42);
            let moment = poses.at(at_ns);
            for late_ns in 0..=7 {
                let late = poses.at(at_ns - late_ns);
                assert_eq!(late.pose, moment.pose, "cycle {cycle}, {late_ns} ns");
            }
        }
    }

    #[test]
    fn before_and_after_all_that_is_known_it_is_at_rest() {
        let poses = path();
        assert_eq!(poses.at(1_000_000).pose, pose(36.0), "the oldest of 64");
        assert_eq!(poses.at(900_000_000).pose, pose(99.0));
        assert_eq!(Poses::new(pose(3.0)).at(7).pose, pose(3.0));
        assert_eq!(Poses::new(pose(3.0)).at(7).time_s, 0.0);
    }
}
