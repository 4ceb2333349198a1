//! What the operator does during an experiment, step by step.

use link::{Mode, Record, WorldPoint};

use super::route::{Arrival, Route};

/// Number of a route's first snapshot in the camera's MAP messages.
pub(super) const FIRST_SNAPSHOT: u16 = 0;

/// How long the single-snapshot experiment homes, ms (published app).
const SINGLE_SNAPSHOT_MS: u64 = 20_000;

/// One step of a script. The next begins when it is done.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// Send a command; done when the camera has echoed it.
    Command {
        /// The mode to ask for.
        mode: Mode,
        /// Arguments of the command; the published app sends none.
        args: Vec<u8>,
    },
    /// Fly to a place; done when it is reached.
    FlyTo {
        /// Where to.
        place: WorldPoint,
        /// When it is reached.
        arrival: Arrival,
    },
    /// Command [`Mode::Follow`] or [`Mode::FollowAndStay`] and fly where the camera says.
    Follow {
        /// The mode to ask for.
        mode: Mode,
        /// When the step is done.
        until: Until,
    },
    /// Tell the filter that the drone is at this place, and turned by what the camera's last vector
    /// asked for; done at once. Nothing happens where no vector has come.
    Realign {
        /// Where the drone has homed to.
        place: WorldPoint,
    },
    /// Hover, and ask the camera for what the operator's buttons say
    /// ([`crate::app::FlightApp::press`]); fly where it leads. Not done until the operator lands.
    Buttons,
}

/// When following is done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Until {
    /// The camera has turned to the route's first snapshot (MAP), and then either a correction has
    /// been applied and a second has passed, or target and drone have rested for ten: the camera
    /// arrived without recognising the place.
    Home,
    /// The camera's target has been at this place, and the drone at the target, without a change
    /// for as long as the end of a pass asks (a target on the way is left behind at once).
    TargetAt(WorldPoint),
    /// This time has passed, ms.
    Elapsed(u64),
}

impl Until {
    /// How long the drone goes on following after it has realigned, ms: time to come to rest at the
    /// corrected place.
    pub(super) const SETTLE_MS: u64 = 1_000;
    /// How long target and drone must rest, ms: longer than the camera homes at any snapshot.
    pub(super) const REST_MS: u64 = 10_000;
}

/// Steps from after take-off to before landing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Script {
    /// The steps, in order.
    pub steps: Vec<Step>,
}

impl Script {
    /// Record a route and fly it back: go to its start, clear, record along the waypoints, follow.
    ///
    /// With snapshots, following ends at the first of them ([`Until::Home`]); without, when the
    /// camera's target stays at the route's start. `args` go with the recording command.
    pub fn record_and_return(route: &Route, record: Record, args: &[u8]) -> Self {
        let mut waypoints = route.waypoints.iter().map(|waypoint| Step::FlyTo {
            place: waypoint.place,
            arrival: waypoint.arrival,
        });
        let mut steps: Vec<_> = waypoints.next().into_iter().collect();
        steps.push(command(Mode::Clear, &[]));
        steps.push(command(Mode::Record(record), args));
        steps.extend(waypoints);
        steps.push(Step::Follow {
            mode: Mode::Follow,
            until: if record.snapshots {
                Until::Home
            } else {
                Until::TargetAt(route.start().unwrap_or_default())
            },
        });
        Self { steps }
    }

    /// Home to a single snapshot (the paper's Fig. 4): take it at the origin, fly to `start`, and
    /// home for 20 s.
    pub fn single_snapshot(start: WorldPoint) -> Self {
        let steps = vec![
            command(Mode::Clear, &[]),
            command(Mode::Record(Record::SINGLE_SNAPSHOT), &[]),
            command(Mode::Idle, &[]),
            Step::FlyTo {
                place: start,
                arrival: Arrival::WAYPOINT,
            },
            Step::Follow {
                mode: Mode::FollowAndStay,
                until: Until::Elapsed(SINGLE_SNAPSHOT_MS),
            },
        ];
        Self { steps }
    }

    /// Go on following a route that the camera still knows, home: for an operator who starts again
    /// after the autopilot has restarted on the way back. Says nothing but follow; a camera that
    /// follows already takes that for a retransmission and goes on where it was.
    pub fn resume() -> Self {
        let follow = Step::Follow {
            mode: Mode::Follow,
            until: Until::Home,
        };
        Self {
            steps: vec![follow],
        }
    }
}

/// A command and the wait for its echo.
pub(super) fn command(mode: Mode, args: &[u8]) -> Step {
    Step::Command {
        mode,
        args: args.to_vec(),
    }
}
