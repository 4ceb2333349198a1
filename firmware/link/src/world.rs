//! Where the wire's frame of reference becomes everybody else's, and back. Nowhere else.
//!
//! | | wire (north, east, down) | everywhere else |
//! |---|---|---|
//! | axes | n north, e east | x north, y west |
//! | heading | psi, clockwise from north | yaw, counter-clockwise from x |
//!
//! so x = n, y = -e, yaw = -psi. All conversions are changes of sign: exact, and exact again on the
//! way back. Whatever came from the wire can be NaN, infinite or absurd: the accessors refuse it
//! ([`Implausible`]), and the constructors of the camera's messages refuse to send it, because the
//! autopilot checks nothing.

use core::f32::consts::TAU;

use heapless::Vec;

use crate::message::{InsCorrection, MAP_CAPACITY, Map, Source, State, Vector};
use crate::plausible::{Implausible, coordinate, heading};

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

    fn plausible(self) -> Result<Self, Implausible> {
        coordinate(self.x)?;
        coordinate(self.y)?;
        Ok(self)
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

    fn plausible(self) -> Result<Self, Implausible> {
        self.point().plausible()?;
        heading(self.yaw)?;
        Ok(self)
    }
}

impl State {
    /// The message that reports `pose`; roll and pitch are sent as zero, as the flight app does.
    ///
    /// It does not refuse anything, as the flight app does not either: the camera must bear it.
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
    /// [`Implausible`] position or heading (roll and pitch are not looked at).
    pub fn pose(&self) -> Result<WorldPose, Implausible> {
        WorldPose::from_north_east(self.ins_n, self.ins_e, self.psi).plausible()
    }
}

impl Vector {
    /// The message that sends the drone from `start` to `target` and, for the log alone, tells it
    /// to turn by `turn` (rad, counter-clockwise).
    ///
    /// # Errors
    /// [`Implausible`] coordinates or headings.
    pub fn from_world(
        target: WorldPoint,
        turn: f32,
        start: WorldPoint,
        source: Source,
    ) -> Result<Self, Implausible> {
        let (target, start) = (target.plausible()?, start.plausible()?);
        heading(turn)?;
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
    /// [`Implausible`] coordinates.
    pub fn target(&self) -> Result<WorldPoint, Implausible> {
        WorldPoint::from_north_east(self.target_n, self.target_e).plausible()
    }

    /// Where the drone was when the vector was computed.
    ///
    /// # Errors
    /// [`Implausible`] coordinates.
    pub fn start(&self) -> Result<WorldPoint, Implausible> {
        WorldPoint::from_north_east(self.start_n, self.start_e).plausible()
    }

    /// How far the drone should turn, rad, counter-clockwise.
    ///
    /// # Errors
    /// [`Implausible`] angle.
    pub fn turn(&self) -> Result<f32, Implausible> {
        heading(self.delta_yaw)?;
        Ok(-self.delta_yaw)
    }
}

impl InsCorrection {
    /// The message that says: what you call `from` is `to`.
    ///
    /// The autopilot takes the difference of the two headings as it stands, so the heading of `to`
    /// is sent within half a turn of the heading of `from`.
    ///
    /// # Errors
    /// [`Implausible`] coordinates or headings.
    pub fn from_world(
        snapshot_index: u16,
        from: WorldPose,
        to: WorldPose,
    ) -> Result<Self, Implausible> {
        let (from, to) = (from.plausible()?, to.plausible()?);
        let turn = libm::remainderf(to.psi() - from.psi(), TAU);
        let psi_to = from.psi() + turn;
        heading(psi_to)?;
        Ok(Self {
            snapshot_index,
            e_from: from.point().east(),
            n_from: from.point().north(),
            psi_from: from.psi(),
            e_to: to.point().east(),
            n_to: to.point().north(),
            psi_to,
        })
    }

    /// What the drone believed, and what holds instead.
    ///
    /// # Errors
    /// [`Implausible`] coordinates or headings.
    pub fn poses(&self) -> Result<(WorldPose, WorldPose), Implausible> {
        let from =
            WorldPose::from_north_east(self.n_from, self.e_from, self.psi_from).plausible()?;
        let to = WorldPose::from_north_east(self.n_to, self.e_to, self.psi_to).plausible()?;
        Ok((from, to))
    }
}

impl Map {
    /// The message that shows the operator the active snapshot and the active odometry vector:
    /// their numbers, where the camera believes them to be, and the snapshot's coefficients.
    ///
    /// # Errors
    /// [`Implausible`] coordinates or headings.
    pub fn from_world(
        (snapshot_index, snapshot): (u16, WorldPoint),
        (odometry_index, odometry): (u16, WorldPoint),
        snapshot_ak_bk: Vec<i8, MAP_CAPACITY>,
    ) -> Result<Self, Implausible> {
        let (snapshot, odometry) = (snapshot.plausible()?, odometry.plausible()?);
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
    /// [`Implausible`] coordinates.
    pub fn snapshot(&self) -> Result<WorldPoint, Implausible> {
        WorldPoint::from_north_east(self.snapshot_n, self.snapshot_e).plausible()
    }

    /// Where the camera believes the active odometry vector to end.
    ///
    /// # Errors
    /// [`Implausible`] coordinates.
    pub fn odometry(&self) -> Result<WorldPoint, Implausible> {
        WorldPoint::from_north_east(self.odometry_n, self.odometry_e).plausible()
    }
}

#[cfg(test)]
mod tests {
    use core::f32::consts::PI;

    use super::{WorldPoint, WorldPose};
    use crate::message::{InsCorrection, Source, State, Vector};
    use crate::plausible::Implausible;

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
        assert_refused(f32::NAN, Implausible::NotFinite);
        assert_refused(f32::NEG_INFINITY, Implausible::NotFinite);
    }

    #[test]
    fn what_is_beyond_a_kilometre_is_neither_sent_nor_taken() {
        assert_refused(-1000.1, Implausible::TooLarge);
        assert_refused(f32::MAX, Implausible::TooLarge);
        let edge = WorldPoint { x: 1000.0, y: 0.0 };
        assert!(Vector::from_world(edge, 0.0, ORIGIN, Source::Visual).is_ok());
    }

    #[test]
    fn a_turn_of_more_than_four_turns_is_not_sent() {
        let sent = |turn| Vector::from_world(ORIGIN, turn, ORIGIN, Source::Visual);
        assert!(sent(-8.0 * PI).is_ok());
        assert_eq!(sent(-25.2), Err(Implausible::TooLarge));
        assert_eq!(sent(f32::INFINITY), Err(Implausible::NotFinite));
    }

    /// A coordinate is refused in a target, a report and a correction, on the way in and out.
    fn assert_refused(y: f32, why: Implausible) {
        let place = WorldPoint { x: 0.0, y };
        let pose = WorldPose {
            x: 0.0,
            y,
            yaw: 0.0,
        };
        let sent = Vector::from_world(place, 0.0, ORIGIN, Source::Visual);
        assert_eq!(sent, Err(why));
        assert_eq!(State::from_world(pose).pose(), Err(why));
        let correction = InsCorrection::from_world(1, WorldPose::default(), pose);
        assert_eq!(correction, Err(why));
    }
}
