//! Where the wire's frame of reference becomes everybody else's, and back. Nowhere else.
//!
//! | | wire (north, east, down) | everywhere else |
//! |---|---|---|
//! | axes | n north, e east | x north, y west |
//! | heading | psi, clockwise from north | yaw, counter-clockwise from x |
//!
//! so x = n, y = -e, yaw = -psi. All conversions are changes of sign: exact, and exact again on the
//! way back. Whatever came from the wire can be NaN or infinite: the accessors refuse it, and the
//! constructors refuse to send it, because the autopilot checks nothing.

use core::error::Error;
use core::f32::consts::TAU;
use core::fmt;

use heapless::Vec;

use crate::message::{InsCorrection, MAP_CAPACITY, Map, Source, State, Vector};

/// A place in the autopilot's world, metres. Its origin is where the filter was last reset.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct WorldPoint {
    /// Northward (forward at yaw 0), m.
    pub x: f32,
    /// Westward (left at yaw 0), m.
    pub y: f32,
}

/// A place and a heading in the autopilot's world.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct WorldPose {
    /// Northward (forward at yaw 0), m.
    pub x: f32,
    /// Westward (left at yaw 0), m.
    pub y: f32,
    /// Counter-clockwise from x, rad. Not unwrapped.
    pub yaw: f32,
}

/// A coordinate was NaN or infinite.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct NotFinite;

impl fmt::Display for NotFinite {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a coordinate is not a finite number")
    }
}

impl Error for NotFinite {}

impl WorldPoint {
    /// A place from its coordinates north and east, m.
    pub const fn from_north_east(north: f32, east: f32) -> Self {
        Self { x: north, y: -east }
    }

    const fn north(self) -> f32 {
        self.x
    }

    const fn east(self) -> f32 {
        -self.y
    }

    fn finite(self) -> Result<Self, NotFinite> {
        finite(self, [self.x, self.y])
    }
}

impl WorldPose {
    /// A pose from its coordinates north and east, m, and its heading clockwise from north, rad.
    pub const fn from_north_east(north: f32, east: f32, psi: f32) -> Self {
        Self {
            x: north,
            y: -east,
            yaw: -psi,
        }
    }

    /// The place without the heading.
    pub const fn point(self) -> WorldPoint {
        WorldPoint {
            x: self.x,
            y: self.y,
        }
    }

    const fn psi(self) -> f32 {
        -self.yaw
    }

    fn finite(self) -> Result<Self, NotFinite> {
        finite(self, [self.x, self.y, self.yaw])
    }
}

fn finite<T, const N: usize>(value: T, coordinates: [f32; N]) -> Result<T, NotFinite> {
    if coordinates.iter().all(|c| c.is_finite()) {
        Ok(value)
    } else {
        Err(NotFinite)
    }
}

impl State {
    /// The message that reports `pose`; roll and pitch are sent as zero, as the flight app does.
    pub const fn from_world(pose: WorldPose) -> Self {
        Self {
            ins_e: pose.point().east(),
            ins_n: pose.point().north(),
            phi: 0.0,
            theta: 0.0,
            psi: pose.psi(),
        }
    }

    /// Where the autopilot believes to be.
    ///
    /// # Errors
    /// [`NotFinite`] when position or heading is no number (roll and pitch are not looked at).
    pub fn pose(&self) -> Result<WorldPose, NotFinite> {
        WorldPose::from_north_east(self.ins_n, self.ins_e, self.psi).finite()
    }
}

impl Vector {
    /// The message that sends the drone from `start` to `target` and, for the log alone, tells it
    /// to turn by `turn` (rad, counter-clockwise).
    ///
    /// # Errors
    /// [`NotFinite`] when any coordinate is no number.
    pub fn from_world(
        target: WorldPoint,
        turn: f32,
        start: WorldPoint,
        source: Source,
    ) -> Result<Self, NotFinite> {
        let (target, start) = (target.finite()?, start.finite()?);
        finite((), [turn])?;
        Ok(Self {
            target_e: target.east(),
            target_n: target.north(),
            delta_yaw: -turn,
            start_e: start.east(),
            start_n: start.north(),
            source: source as u8,
        })
    }

    /// Where the drone shall fly to.
    ///
    /// # Errors
    /// [`NotFinite`] when a coordinate is no number.
    pub fn target(&self) -> Result<WorldPoint, NotFinite> {
        WorldPoint::from_north_east(self.target_n, self.target_e).finite()
    }

    /// Where the drone was when the vector was computed.
    ///
    /// # Errors
    /// [`NotFinite`] when a coordinate is no number.
    pub fn start(&self) -> Result<WorldPoint, NotFinite> {
        WorldPoint::from_north_east(self.start_n, self.start_e).finite()
    }

    /// How far the drone should turn, rad, counter-clockwise.
    ///
    /// # Errors
    /// [`NotFinite`] when the angle is no number.
    pub fn turn(&self) -> Result<f32, NotFinite> {
        finite(-self.delta_yaw, [self.delta_yaw])
    }
}

impl InsCorrection {
    /// The message that says: what you call `from` is `to`.
    ///
    /// The autopilot takes the difference of the two headings as it stands, so the heading of `to`
    /// is sent within half a turn of the heading of `from`.
    ///
    /// # Errors
    /// [`NotFinite`] when any coordinate is no number.
    pub fn from_world(
        snapshot_index: u16,
        from: WorldPose,
        to: WorldPose,
    ) -> Result<Self, NotFinite> {
        let (from, to) = (from.finite()?, to.finite()?);
        let turn = finite(to.psi() - from.psi(), [to.psi() - from.psi()])?;
        Ok(Self {
            snapshot_index,
            e_from: from.point().east(),
            n_from: from.point().north(),
            psi_from: from.psi(),
            e_to: to.point().east(),
            n_to: to.point().north(),
            psi_to: from.psi() + libm::remainderf(turn, TAU),
        })
    }

    /// What the drone believed, and what holds instead.
    ///
    /// # Errors
    /// [`NotFinite`] when any coordinate is no number.
    pub fn poses(&self) -> Result<(WorldPose, WorldPose), NotFinite> {
        let from = WorldPose::from_north_east(self.n_from, self.e_from, self.psi_from).finite()?;
        let to = WorldPose::from_north_east(self.n_to, self.e_to, self.psi_to).finite()?;
        Ok((from, to))
    }
}

impl Map {
    /// The message that shows the operator the active snapshot and the active odometry vector:
    /// their numbers, where the camera believes them to be, and the snapshot's coefficients.
    ///
    /// # Errors
    /// [`NotFinite`] when any coordinate is no number.
    pub fn from_world(
        (snapshot_index, snapshot): (u16, WorldPoint),
        (odometry_index, odometry): (u16, WorldPoint),
        snapshot_ak_bk: Vec<i8, MAP_CAPACITY>,
    ) -> Result<Self, NotFinite> {
        let (snapshot, odometry) = (snapshot.finite()?, odometry.finite()?);
        Ok(Self {
            snapshot_index,
            snapshot_e: snapshot.east(),
            snapshot_n: snapshot.north(),
            odometry_index,
            odometry_e: odometry.east(),
            odometry_n: odometry.north(),
            snapshot_ak_bk,
        })
    }

    /// Where the camera believes the active snapshot to be.
    ///
    /// # Errors
    /// [`NotFinite`] when a coordinate is no number.
    pub fn snapshot(&self) -> Result<WorldPoint, NotFinite> {
        WorldPoint::from_north_east(self.snapshot_n, self.snapshot_e).finite()
    }

    /// Where the camera believes the active odometry vector to end.
    ///
    /// # Errors
    /// [`NotFinite`] when a coordinate is no number.
    pub fn odometry(&self) -> Result<WorldPoint, NotFinite> {
        WorldPoint::from_north_east(self.odometry_n, self.odometry_e).finite()
    }
}

#[cfg(test)]
mod tests {
    use core::f32::consts::PI;

    use super::{WorldPoint, WorldPose};
    use crate::message::{InsCorrection, Source, State, Vector};

    const ORIGIN: WorldPoint = WorldPoint { x: 0.0, y: 0.0 };

    #[test]
    fn a_target_one_north_and_two_east_is_x_1_y_minus_2() {
        let vector = Vector {
            target_e: 2.0,
            target_n: 1.0,
            ..Vector::default()
        };
        assert_eq!(vector.target(), Ok(WorldPoint { x: 1.0, y: -2.0 }));
    }

    #[test]
    fn a_state_facing_east_has_a_yaw_of_minus_a_quarter_turn() {
        let state = State {
            psi: PI / 2.0,
            ..State::default()
        };
        assert_eq!(state.pose().map(|pose| pose.yaw), Ok(-PI / 2.0));
    }

    #[test]
    fn a_turn_to_the_right_is_sent_as_a_positive_delta_yaw() {
        let vector = Vector::from_world(ORIGIN, -0.25, ORIGIN, Source::Visual);
        assert_eq!(vector.map(|vector| vector.delta_yaw), Ok(0.25));
    }

    #[test]
    fn a_correction_across_the_back_turns_the_short_way() {
        let at = |yaw| WorldPose {
            x: 0.0,
            y: 0.0,
            yaw,
        };
        let Ok(correction) = InsCorrection::from_world(1, at(3.0), at(-3.0)) else {
            panic!("both poses are finite");
        };
        // Counter-clockwise from 3.0 to -3.0 + 2 pi: clockwise by minus that.
        let turn = correction.psi_to - correction.psi_from;
        assert!((turn - -(2.0 * PI - 6.0)).abs() < 1e-6, "{turn}");
    }

    #[test]
    fn what_is_no_number_is_neither_sent_nor_taken() {
        let nowhere = WorldPoint {
            x: f32::NAN,
            y: 0.0,
        };
        assert!(Vector::from_world(nowhere, 0.0, ORIGIN, Source::Visual).is_err());
        assert!(Vector::from_world(ORIGIN, f32::INFINITY, ORIGIN, Source::Visual).is_err());
        let state = State {
            ins_e: f32::NEG_INFINITY,
            ..State::default()
        };
        assert!(state.pose().is_err());
    }
}
