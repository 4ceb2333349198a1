//! Whether a STATE goes on from the one before, or the autopilot has begun to count anew.
//!
//! A Crazyflie that has restarted, by a brown-out or its watchdog, resets its filter at take-off:
//! position (0, 0), heading 0, wherever it stands. The filter's own supervisor does the same in mid-air.
//! Every target in the old coordinates would then lead astray. Nothing on the link says so; these do:
//!
//! | what is seen | what it is taken for |
//! |---|---|
//! | a pose that the drone can have flown to since the last | the flight goes on |
//! | one that it cannot, once | a broken STATE: it is not answered |
//! | the same for two STATEs that agree, or after a silence: | |
//! | - a pose at the origin, and the view of the last known place | a new origin: the route goes on from the last known place |
//! | - a pose at the origin, and another view or none | a new origin, but the drone may have been carried: lost |
//! | - a pose elsewhere, within reach | the link, or this board, was away: the flight goes on |
//! | - a pose out of reach; or a second of poses that do not agree | lost |
//!
//! Lost is a safe stop: the drone is told to stay where it is and nothing is recorded, until the route
//! is cleared, or a new mode is asked for where the view is that of the last known place.

use nalgebra::Point2;
use nav::homing::Resemblance;
use nav::navigator::Correction;
use nav::{Parameters, Pose, Snapshot, Spectrum, Step};

use crate::anchor::Anchor;

/// Silence after which the autopilot may have restarted, milliseconds. STATE comes every 100 ms in the
/// air; from the filter's reset to the first of them a take-off takes 2 s (published app).
const SILENCE_MS: u32 = 1_500;

/// Silence that does not show on this board's clock, milliseconds: its own watchdog's time.
const UNSEEN_MS: u32 = 3_000;

/// Poses that never agree, for so long, are no flight, milliseconds.
const DOUBT_LIMIT_MS: u32 = 1_000;

/// Fastest flight, m/s: the position controller asks for 1.1 m/s along each axis; a correction kicks
/// the estimated velocity by up to 1.3 m/s for a moment.
const FASTEST_M_S: f32 = 2.0;
/// Fastest turn, rad/s: the heading is held.
const FASTEST_RAD_S: f32 = 2.0;
/// What an estimate may jump in flight, m and rad.
const JUMP_M: f32 = 0.5;
const JUMP_RAD: f32 = 0.5;

/// How long a correction may take to show in STATE, milliseconds.
const CORRECTION_MS: u32 = 1_500;

/// How far from the origin a flight begins, m and rad: what the drone and its estimate drift in 3 s of
/// take-off and hover.
const START_M: f32 = 0.5;
const START_RAD: f32 = 0.35;

/// Two views are of one place if no more than this share of their power differs once one is moved and
/// turned to fit the other. In the rig's arena 98 of 100 pairs of views up to 0.5 m apart have less, 10 of
/// 100 of those 2 to 3 m apart, and 2 of 100 of those farther apart.
const SAME_PLACE: f32 = 0.1;

/// Farther than this from where it is told to stay, m, a lost drone has been given another origin once
/// more.
const STRAY_M: f32 = 1.0;

/// What a STATE is worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// The flight goes on: the pose in the route's coordinates.
    GoesOn(Pose),
    /// The autopilot counts from a new origin; the pose in the route's coordinates.
    NewOrigin(Pose),
    /// It may be broken. `news`: the one before was not.
    Doubtful {
        /// Whether doubt begins here.
        news: bool,
    },
    /// Nobody knows where the drone is on the route.
    Lost {
        /// Where it shall stay, in the autopilot's coordinates.
        stay: Point2<f32>,
        /// Whether that begins here, or was asked again and has not changed.
        news: bool,
    },
}

/// What is known of the flight so far.
#[derive(Clone, Debug, Default)]
pub struct Continuity {
    /// None as long as the autopilot counts as it did when the route was recorded.
    anchor: Option<Anchor>,
    known: Option<Known>,
    doubt: Option<Doubt>,
    expected: Option<Expected>,
    lost: Option<Lost>,
}

/// The last pose that was believed.
#[derive(Clone, Copy, Debug)]
struct Known {
    at_ms: u32,
    /// In the route's coordinates.
    pose: Pose,
    /// What was to be seen there.
    view: Option<Spectrum>,
}

/// Poses that are not believed yet, in the autopilot's coordinates.
#[derive(Clone, Copy, Debug)]
struct Doubt {
    since_ms: u32,
    at_ms: u32,
    pose: Pose,
}

/// The jump that a correction is to make.
#[derive(Clone, Copy, Debug)]
struct Expected {
    at_ms: u32,
    shift_m: f32,
    turn_rad: f32,
}

#[derive(Clone, Copy, Debug)]
struct Lost {
    stay: Point2<f32>,
    /// A new mode was asked for since.
    look_again: bool,
}

impl Continuity {
    /// What the autopilot's `pose` at `now_ms` is worth. `view` is the newest, aligned with the heading
    /// of the last pose that was believed.
    pub fn judge(
        &mut self,
        now_ms: u32,
        pose: &Pose,
        view: Option<&Spectrum>,
        parameters: &Parameters,
    ) -> Verdict {
        if let Some(lost) = self.lost {
            let look_again = view.filter(|_| lost.look_again);
            return match self.recognise(look_again, parameters) {
                Some(here) => self.go_on_from(&here, pose),
                None => self.stay(lost, pose),
            };
        }
        let here = self.to_route(pose);
        let Some(known) = self.known else {
            return Verdict::GoesOn(here);
        };
        let elapsed_ms = now_ms.wrapping_sub(known.at_ms);
        if elapsed_ms < SILENCE_MS && self.is_within_reach(&known, &here, now_ms, elapsed_ms) {
            self.doubt = None;
            return Verdict::GoesOn(here);
        }
        let doubt = Doubt {
            since_ms: self.doubt.map_or(now_ms, |doubt| doubt.since_ms),
            at_ms: now_ms,
            pose: *pose,
        };
        match self.doubt.replace(doubt) {
            None => Verdict::Doubtful { news: true },
            Some(before) if agree(&before, &doubt) => {
                self.doubt = None;
                let away_ms = elapsed_ms.saturating_add(UNSEEN_MS);
                if is_at_the_origin(&before.pose) {
                    match self.recognise(view, parameters) {
                        Some(here) => self.go_on_from(&here, pose),
                        None => self.lose(pose),
                    }
                } else if self.is_within_reach(&known, &here, now_ms, away_ms) {
                    Verdict::GoesOn(here)
                } else {
                    self.lose(pose)
                }
            }
            Some(before) if now_ms.wrapping_sub(before.since_ms) >= DOUBT_LIMIT_MS => {
                self.lose(pose)
            }
            Some(_) => Verdict::Doubtful { news: false },
        }
    }

    /// Remembers a pose that was believed, with the view there, and what the step asked for.
    pub fn remember(&mut self, now_ms: u32, pose: &Pose, view: Option<Spectrum>, step: &Step) {
        self.known = Some(Known {
            at_ms: now_ms,
            pose: *pose,
            view,
        });
        if let Some(Correction { from, to, .. }) = &step.correction {
            self.expected = Some(Expected {
                at_ms: now_ms,
                shift_m: (to.position - from.position).norm(),
                turn_rad: (to.heading - from.heading).abs(),
            });
        }
    }

    /// A step in the autopilot's coordinates.
    pub fn to_autopilot(&self, step: Step) -> Step {
        match self.anchor {
            None => step,
            Some(anchor) => anchor.to_autopilot(step),
        }
    }

    /// Stops safely: the drone stays at `pose`, in the autopilot's coordinates.
    pub fn lose(&mut self, pose: &Pose) -> Verdict {
        self.doubt = None;
        let stay = pose.position;
        self.lost = Some(Lost {
            stay,
            look_again: false,
        });
        Verdict::Lost { stay, news: true }
    }

    /// A new mode is asked for: where the drone is lost, it looks round once more.
    pub fn look_again(&mut self) {
        if let Some(lost) = &mut self.lost {
            lost.look_again = true;
        }
    }

    fn to_route(&self, pose: &Pose) -> Pose {
        match self.anchor {
            None => *pose,
            Some(anchor) => anchor.to_route(pose),
        }
    }

    fn stay(&mut self, lost: Lost, pose: &Pose) -> Verdict {
        let strayed = (lost.stay - pose.position).norm() > STRAY_M;
        let stay = if strayed { pose.position } else { lost.stay };
        self.lost = Some(Lost {
            stay,
            look_again: false,
        });
        let news = lost.look_again;
        Verdict::Lost { stay, news }
    }

    /// The autopilot's `pose` is `here` on the route.
    fn go_on_from(&mut self, here: &Pose, pose: &Pose) -> Verdict {
        self.lost = None;
        self.anchor = Some(Anchor::between(pose, here));
        Verdict::NewOrigin(*here)
    }

    /// Where the drone is on the route if the view is the one from the last known place.
    fn recognise(&self, view: Option<&Spectrum>, parameters: &Parameters) -> Option<Pose> {
        let known = self.known?;
        let there = Snapshot::quantise(&known.view?);
        let seen = Resemblance::of(view?, &there, &parameters.homing).ok()?;
        // As in a realignment: the heading is the one assumed less the rotation.
        let heading = known.pose.heading - seen.rotation;
        let way = seen.displacement * parameters.environment_radius_m;
        (seen.difference <= SAME_PLACE).then(|| Pose::new(known.pose.position - way, heading))
    }

    fn is_within_reach(&self, known: &Known, here: &Pose, now_ms: u32, elapsed_ms: u32) -> bool {
        let correction = self
            .expected
            .filter(|expected| now_ms.wrapping_sub(expected.at_ms) < CORRECTION_MS);
        let (shift_m, turn_rad) =
            correction.map_or((0.0, 0.0), |expected| (expected.shift_m, expected.turn_rad));
        let reach = Reach::within(elapsed_ms);
        reach.plus(shift_m, turn_rad).spans(&known.pose, here)
    }
}

/// How far a pose may be from another.
#[derive(Clone, Copy, Debug)]
struct Reach {
    metres: f32,
    radians: f32,
}

impl Reach {
    fn within(elapsed_ms: u32) -> Self {
        let seconds = elapsed_ms as f32 * 0.001;
        Self {
            metres: JUMP_M + FASTEST_M_S * seconds,
            radians: JUMP_RAD + FASTEST_RAD_S * seconds,
        }
    }

    fn plus(self, metres: f32, radians: f32) -> Self {
        Self {
            metres: self.metres + metres,
            radians: self.radians + radians,
        }
    }

    fn spans(self, a: &Pose, b: &Pose) -> bool {
        (a.position - b.position).norm() <= self.metres
            && turn(b.heading - a.heading).abs() <= self.radians
    }
}

/// Whether the newer of two doubtful poses goes on from the older.
fn agree(older: &Doubt, newer: &Doubt) -> bool {
    let elapsed_ms = newer.at_ms.wrapping_sub(older.at_ms);
    elapsed_ms < SILENCE_MS && Reach::within(elapsed_ms).spans(&older.pose, &newer.pose)
}

/// Whether a flight can have begun here a moment ago.
fn is_at_the_origin(pose: &Pose) -> bool {
    pose.position.coords.norm() <= START_M && turn(pose.heading).abs() <= START_RAD
}

/// The turn within half a turn either way, radians.
fn turn(radians: f32) -> f32 {
    libm::remainderf(radians, core::f32::consts::TAU)
}

#[cfg(test)]
mod tests;
