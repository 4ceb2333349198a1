//! The navigator's constants.

use crate::homing::HomingParameters;
#[cfg(doc)]
use crate::navigator::Drift;
use crate::route::SIMPLIFY_TOLERANCE_M;
use crate::snapshot::SnapshotFormat;

/// Half a STATE period (STATE comes every 100 ms): taken off every time-out, so that a millisecond of
/// jitter never decides in which period it falls.
pub(super) const SLACK_MS: u32 = 50;

/// Bounds of the way between two snapshots that theory finds, metres: less than the paper's denser
/// setting of 1 m is memory without use, and beyond 10 m a single odometry vector does not span it.
pub(super) const THEORY_M: (f32, f32) = (1.0, 10.0);

/// The speed at which a drone comes back, metres a second: what the published app's flights average.
pub(super) const RETURN_SPEED_M_S: f32 = 0.5;

/// How the navigator records and follows. Lengths in metres, times in milliseconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters {
    /// Way between two snapshots along odometry.
    pub snapshot_spacing_m: f32,
    /// Instead, snapshots along odometry as far apart as the drift lets them be ([`Drift::DEFAULT`]).
    pub spacing_by_theory: bool,
    /// With which probability the drone then arrives in the catchment of the next snapshot, 0..1.
    pub catchment_probability: f32,
    /// Way between two snapshots of a purely visual sequence.
    pub sequence_spacing_m: f32,
    /// How a route that is begun stores its views.
    pub snapshot_format: SnapshotFormat,
    /// How far the stored way may deviate from the one flown.
    pub simplify_tolerance_m: f32,
    /// A point of the route counts as reached within this distance.
    pub acceptance_radius_m: f32,
    /// The distance R of the surroundings, which is one unit of the homing vector, until the way flown has
    /// measured it.
    pub environment_radius_m: f32,
    /// The least and the greatest R that the way flown may give.
    pub environment_bounds_m: (f32, f32),
    /// Weight of that first R against the way flown: the variance of a vector over that of 1/R between
    /// places, m².
    pub environment_prior_m2: f32,
    /// R is measured by this many vectors of a run: those of the approach.
    pub measuring_vectors: f32,
    /// A snapshot's place is the mean of about this many of the newest vectors.
    pub fitted_vectors: f32,
    /// Bound of the set-point's distance while homing.
    pub homing_step_m: f32,
    /// Share of each new homing vector in the low-passed set-point and turn, 0..=1.
    pub smoothing: f32,
    /// Time at a snapshot.
    pub homing_time_ms: u32,
    /// Time at a snapshot of a purely visual sequence.
    pub sequence_homing_time_ms: u32,
    /// Homing at such a snapshot ends early when it looks nearer than this.
    pub sequence_arrival_radius_m: f32,
    /// Time at the last snapshot, which is home; homing does not end earlier there.
    pub final_homing_time_ms: u32,
    /// Homing ends early when the snapshot looks nearer than this; zero never ends it early.
    pub arrival_radius_m: f32,
    /// Homing vectors needed before homing may end early or realign the pose.
    pub least_vectors: u16,
    /// The same at a snapshot of a visual sequence; and before a snapshot that was searched for counts as
    /// found.
    pub few_vectors: u16,
    /// After a realignment, how far the drone's heading may be off at the next snapshot however near that
    /// is, radians.
    pub heading_error_rad: f32,
    /// The same for each metre of the way there, radians.
    pub heading_drift_rad_m: f32,
    /// Homing ends when this many frames in a row brought no new minimum of the difference; zero for
    /// time-outs alone.
    pub frames_without_minimum: u16,
    /// The farthest that homing may take the set-point from where the snapshot is expected; one that
    /// begins farther away, that much more.
    pub leash_m: f32,
    /// A view of which this share of the power differs from the snapshot's, moved and turned to fit, is
    /// of another place, 0..=1.
    pub other_place: f32,
    /// Between two turns of the search round a snapshot that was not found.
    pub search_spacing_m: f32,
    /// Speed of the set-point in that search, metres a second.
    pub search_speed_m_s: f32,
    /// So many snapshots in a row whose views were of another place: the drone is lost.
    pub most_other_places: u8,
    /// The way by odometry since the last realignment beyond which a snapshot that is not found means
    /// that the drone is lost.
    pub farthest_unseen_m: f32,
    /// Time to the next point of the route; a drone that does not get there is lost.
    pub leg_time_ms: u32,
    /// After a realignment: rest until the autopilot's filter has taken it over.
    pub settling_time_ms: u32,
    /// Least time between two realignments.
    pub realignment_interval_ms: u32,
    /// At home: time between two MAP messages that say so.
    pub home_period_ms: u32,
    /// Mean age of a view when a step looks at it, seconds.
    pub view_age_s: f32,
    /// Fourier homing.
    pub homing: HomingParameters,
    /// Farther than this from where odometry has the snapshot, homing is that from afar.
    pub far_m: f32,
}

impl Parameters {
    /// The paper's settings where it gives them, else what a study of some hundred thousand simulated
    /// flights found.
    ///
    /// - Snapshots every 2 m: paper, "Route following"; with it the U route of 56 m takes 0.65 kB. A
    ///   visual sequence needs 0.25 m: paper, Fig. 6C.
    /// - Acceptance 0.2 m: two STATE periods of flight at 1 m/s. Homing starts that near.
    /// - R 1.5 m: in rooms of 10 m, 1 m homes too slowly, 4 m too nervously. The way flown gives 1.5 m in
    ///   the rig's corridors, 3 to 7 m in its halls and some 10 m in its forest; 6 m at most, because with
    ///   more the noise of a vector would lead half as far as the next snapshot is. 1/R differs by 0.3 /m
    ///   between them, and a vector is off by 0.02: (0.02/0.3)² m². Two seconds of vectors for R; for the
    ///   place all of a stay at home, so that a view that is a little off does not lead a drone that hovers
    ///   farther and farther away.
    /// - Homing step 0.3 m and smoothing 0.3: pitch and roll stay small, so that the horizon stays in
    ///   the picture.
    /// - 3 s at a snapshot: the paper replaced its 10-frame rule by a time-out of unknown length; 2 to
    ///   3 s suffice for 0.3 m. 7 s at home, where precision matters and nothing follows.
    /// - At a snapshot of a visual sequence up to 4 s, until it looks nearer than 0.03 m: in a room whose
    ///   walls are 5 m away that is 0.1 m of the 0.25 m to the next. A fixed 2 s left the drone behind its
    ///   sequence where the walls are far.
    /// - Early end below 0.06 m: a fifth of the time is saved at no loss. Twelve vectors: on the way to the
    ///   snapshot and over it the drone has moved by some 0.3 m, and the fit has a base. With five, drones
    ///   went on past their snapshots, each a little farther, until they were lost. Five, half a second, at a
    ///   snapshot of a sequence: the next is as near, and on a search the drone soon is elsewhere.
    /// - Once realigned, the heading drifts by 1.6 degrees in 5 m (crazyflie-firmware kalman_core with this
    ///   drone's sensors): 1.1 degrees a metre are three times that. 11 degrees for what a vector from some
    ///   0.3 m away is off by: the 58 realignments of a flight along 120 m of corridor turn by 7 at most.
    /// - The 10-frame rule is off, as in the paper's final flights.
    /// - Leash 2 m: from farther away the paper's homing does not find home (Fig. 4), and odometry is off by
    ///   0.3 m after 5 m (its Fig. 5).
    /// - Another place beyond four fifths of the power: two views that have nothing in common differ by
    ///   all of it. Where a snapshot is found the rig's rooms, corridors and forest leave 0.11 at most, its
    ///   rows of plants up to 0.5.
    /// - Search every 0.4 m, on five legs of an expanding square (IAMSAR Manual, "expanding square
    ///   search"): up to 0.57 m away, twice the odometry's error after 5 m, and homing sees a snapshot 0.5 m
    ///   away. At 0.25 m/s it is seen from one place in five frames, and over after 13 s.
    /// - Two other places in a row: one may have changed since the way out.
    /// - 20 m without sight: odometry is then off by 1 m (crazyflie-firmware kalman_core with this
    ///   drone's sensors), as far as a search and homing reach together.
    /// - 60 s to the next point: the longest stored vector of 18 m at 0.3 m/s.
    /// - From afar beyond 1 m: nearer, a turn is told from a move. On a route homing never starts so far
    ///   away; only back to a single snapshot (paper, Fig. 4) does it.
    /// - The app applies a correction once it arrives and the filter within two periods: 300 ms. Two
    ///   realignments within a second could contradict each other.
    /// - A frame takes 39 ms, of which the horizon is the middle; it waits up to as long for a step, and the
    ///   shutter was open for some 20 ms: 19 + 19 + 10 ms, and 10 for what the link and the filter take.
    /// - Each MAP goes out once, and a broken one is lost. That the drone is home, the autopilot must
    ///   hear some time: once a second.
    pub const DEFAULT: Self = Self {
        snapshot_spacing_m: 2.0,
        spacing_by_theory: false,
        catchment_probability: 0.99,
        sequence_spacing_m: 0.25,
        snapshot_format: SnapshotFormat::Paper,
        simplify_tolerance_m: SIMPLIFY_TOLERANCE_M,
        acceptance_radius_m: 0.2,
        environment_radius_m: 1.5,
        environment_bounds_m: (1.0, 6.0),
        environment_prior_m2: 0.005,
        measuring_vectors: 20.0,
        fitted_vectors: 70.0,
        homing_step_m: 0.3,
        smoothing: 0.3,
        homing_time_ms: 3_000,
        sequence_homing_time_ms: 4_000,
        sequence_arrival_radius_m: 0.03,
        final_homing_time_ms: 7_000,
        arrival_radius_m: 0.06,
        least_vectors: 12,
        few_vectors: 5,
        heading_error_rad: 0.2,
        heading_drift_rad_m: 0.02,
        frames_without_minimum: 0,
        leash_m: 2.0,
        other_place: 0.8,
        search_spacing_m: 0.4,
        search_speed_m_s: 0.25,
        most_other_places: 2,
        farthest_unseen_m: 20.0,
        leg_time_ms: 60_000,
        settling_time_ms: 300,
        realignment_interval_ms: 1_000,
        home_period_ms: 1_000,
        view_age_s: 0.06,
        homing: HomingParameters::DEFAULT,
        far_m: 1.0,
    };
}

impl Default for Parameters {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Whether `limit_ms` have passed, within [`SLACK_MS`]. The clock may wrap.
pub(super) const fn has_passed(since_ms: u32, now_ms: u32, limit_ms: u32) -> bool {
    now_ms.wrapping_sub(since_ms) >= limit_ms.saturating_sub(SLACK_MS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_millisecond_of_jitter_does_not_delay_a_time_out_by_a_period() {
        assert!(!has_passed(0, 2_901, 3_000));
        assert!(has_passed(0, 2_999, 3_000));
        assert!(has_passed(0, 3_001, 3_000));
    }

    #[test]
    fn a_time_out_survives_the_wrap_of_the_clock() {
        assert!(!has_passed(u32::MAX - 1_000, 1_000, 3_000));
        assert!(has_passed(u32::MAX - 1_000, 2_000, 3_000));
    }
}
