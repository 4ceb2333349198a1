//! `hil autopilot`: the emulated autopilot for a real board, or for somebody else's camera.

use std::path::PathBuf;

use clap::Args;

use super::Failure;
use super::console::Console;
use super::fly::ScenarioArguments;
use super::live::{LiveArguments, prepare, say};
use crate::live::{AutopilotSetup, Endpoint, Stop, TcpPort, beside, fly_aircraft};

/// Options of `hil autopilot`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil autopilot --link tcp:5760           with `hil emulate --link tcp:5760` in another terminal,\n  \
    \x20                                       in either order: the paper's U in real time\n  \
    hil autopilot --link tty:/dev/ttyUSB0   for a real board: a 3.3 V USB adapter's TX to the board's\n  \
    \x20                                       RX (PA3), RX to TX (PA2), ground to ground (921600 baud)\n  \
    hil autopilot --link tty:/dev/pts/4     for `hil emulate --link pty`, which prints the device\n  \
    hil autopilot --link tty:/dev/ttyUSB0 --pose tcp:6000\n  \
    \x20                                       and tells a renderer of yours where the camera is\n\n\
    The pose: 200 times a second a JSON object on a line, see `hil emulate --help`.\n\
    With tcp, whoever comes first listens and the other one connects; either may start again.\n\
    On tcp and pty the drone waits on the ground until somebody is there; on a tty it takes off at once.\n\n\
    Ends when the drone has landed, or with Ctrl-C; both write the folder.\n\
    Exit code 0: the drone came home. 1: it did not. 2: it could not be done.")]
pub struct Arguments {
    #[command(flatten)]
    live: LiveArguments,
    #[command(flatten)]
    scenario: ScenarioArguments,
    /// Where the true pose is told: tcp:PORT [default: nowhere; beside --link tcp:PORT the port after it]
    #[arg(long, value_name = "tcp:PORT")]
    pose: Option<TcpPort>,
    /// Seed of the sensors
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Folder for summary.json, flight.log, recording.json, report.html and map.svg [default: flights/live-autopilot-ROUTE-SEED]
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let scenario = arguments.scenario.scenario(arguments.seed);
    let live = &arguments.live;
    if *live.link() == Endpoint::Nowhere {
        return Err(
            "an autopilot needs a board: --link pty, --link tty:PATH or --link tcp:PORT".into(),
        );
    }
    let pose = arguments.pose.or_else(|| beside(live.link()));
    live.beside(pose)?;
    let name = format!("live-autopilot-{}-{}", scenario.route.name(), scenario.seed);
    let out = prepare(arguments.out.as_ref(), &name)?;
    let stop = Stop::on_signals()?;
    let setup = AutopilotSetup {
        common: live.common(&stop),
        scenario,
        pose,
    };
    let flown = fly_aircraft(&setup, &|notice| say(console, notice))?;
    live.end(&out, &flown, console)
}
