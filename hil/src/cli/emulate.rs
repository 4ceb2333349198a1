//! `hil emulate`: the emulated board for a real autopilot.

use std::path::PathBuf;

use clap::Args;

use super::Failure;
use super::console::Console;
use super::desk::DeskArguments;
use super::fly::Image;
use super::live::{LiveArguments, prepare, say};
use super::world;
use crate::live::{EmulateSetup, PoseSource, Stop, emulate};

/// Options of `hil emulate`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil emulate --link tcp:5760             with `hil autopilot --link tcp:5760` in another terminal,\n  \
    \x20                                       in either order: the paper's U in real time\n  \
    hil emulate --link pty                  prints a device, for whatever opens a serial port\n  \
    hil emulate --link tty:/dev/ttyUSB0     for a real Crazyflie: a 3.3 V USB adapter's RX to its TX2,\n  \
    \x20                                       TX to RX2, ground to ground (921600 baud)\n  \
    hil emulate --gdb 3333                  for gdb-multiarch ELF -ex 'target remote :3333': break and watch\n  \
    \x20                                       points, registers, memory; virtual time stands still while halted\n  \
    hil emulate --link pty --pose tcp:6000  for a simulator of yours (SITL) that knows the true pose\n  \
    hil emulate --link pty --frames pty --probe tcp:5770 --write-rig emulated.toml\n  \
    \x20                                       a board on the desk, for `hil fly --backend board --rig emulated.toml`\n\n\
    The link: pprzlink 2.0 with the messages of the visual-homing app, as on the UART of the board.\n\
    With tcp, whoever comes first listens and the other one connects; either may start again.\n\n\
    The pose: one JSON object a line,\n  \
    {\"t\":1.5,\"x\":0,\"y\":0,\"z\":0.5,\"roll\":0,\"pitch\":0,\"yaw\":0}\n\
    in seconds, metres and radians; x north, y west, z up from the ground to the drone's feet; yaw, then\n\
    pitch, then roll (ZYX), right-handed: pitch is positive nose down. A pose is held until the next.\n\
    `state` takes it from the STATE messages, at 0.5 m; the drone is on the ground where none came for\n\
    a second. Errors are then not seen: the camera is where the drone believes to be.\n\n\
    Ctrl-C ends it and writes the folder, which describes the newest route (CLEAR begins one).\n\
    Exit code 0: the firmware followed the route to its end. 1: it did not. 2: it could not be done.")]
pub struct Arguments {
    #[command(flatten)]
    live: LiveArguments,
    /// Where the camera is: state, or tcp:PORT [default: state; beside --link tcp:PORT whoever sends
    /// poses to the port after it, else state]
    #[arg(long, value_name = "SOURCE")]
    pose: Option<PoseSource>,
    /// Serves GDB on a port of this machine; 0 takes any that is free, and says which
    #[arg(long, value_name = "PORT")]
    gdb: Option<u16>,
    /// The world: a name that `hil look` lists, or a file
    #[arg(long, default_value = "arena-panels", value_parser = world::parse)]
    world: String,
    /// Seed of world and camera noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Folder for summary.json, flight.log, recording.json, report.html and map.svg [default: flights/live-emulator-SEED]
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// An image that is already built [default: this checkout's, built first]
    #[arg(long, value_name = "ELF")]
    firmware: Option<PathBuf>,
    #[command(flatten)]
    desk: DeskArguments,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let live = &arguments.live;
    if let Some(frames) = &arguments.desk.frames {
        return arguments
            .desk
            .run(live, frames, arguments.firmware.clone(), console);
    }
    let pose = arguments
        .pose
        .unwrap_or_else(|| PoseSource::beside(live.link()));
    live.beside(pose.port())?;
    let image = Image::get(arguments.firmware.clone(), console)?;
    let name = format!("live-emulator-{}", arguments.seed);
    let out = prepare(arguments.out.as_ref(), &name)?;
    let stop = Stop::on_signals()?;
    let setup = EmulateSetup {
        common: live.common(&stop),
        elf: &image.bytes,
        world: arguments.world.clone(),
        seed: arguments.seed,
        pose,
        gdb: arguments.gdb,
    };
    let flown = emulate(&setup, &|notice| say(console, notice))?;
    live.end(&out, &flown, console)
}
