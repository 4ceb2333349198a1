//! The command line: verbs, their options, and exit codes that a CI can use.
//!
//! 0: what was asked for is true. 1: it is not (a flight that does not come home, a record that
//! does not hold). 2: it could not be done (wrong options, no compiler, a chip that stopped).

mod autopilot;
mod bench;
mod build;
mod calibrate;
mod calibrate_timing;
mod camera_faults;
mod campaign;
mod catchment;
mod conditions;
mod console;
mod desk;
mod drift;
mod ekf_replay;
mod emulate;
mod experiments;
mod exposure;
mod film;
mod flash;
mod fly;
mod homing_check;
mod homing_cycles;
mod homing_test;
mod import_cf;
mod info;
mod link_check;
mod live;
mod log;
mod look;
mod merge;
mod profile;
mod replay;
mod rig;
mod size;
mod steps;
mod summary;
mod sweep;
mod timing;
mod world;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use console::Console;

/// The rig of Cataglyphis: flies the firmware in closed loop and reports.
#[derive(Debug, Parser)]
#[command(
    name = "hil",
    bin_name = "hil",
    version,
    arg_required_else_help = true,
    after_help = "Examples:\n  \
        hil fly                               the paper's U on the emulated board\n  \
        hil campaign --compare                20 seeds, with homing and by odometry alone\n  \
        hil sweep tests/scenarios/u.toml      a scenario with what is expected of it\n  \
        hil experiments                       the paper's claims, one by one\n  \
        hil homing-check tests/golden/data/homing.jsonl\n\n\
        In a checkout, `cargo fly` builds and runs `hil fly`.\n\
        Exit code 0: what was asked for is true. 1: it is not. 2: it could not be done."
)]
struct Cli {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Flies a route out and back and writes a report
    Fly(fly::Arguments),
    /// Offers the emulated board to a real autopilot, in real time
    Emulate(emulate::Arguments),
    /// Offers the emulated autopilot to a real board, in real time
    Autopilot(autopilot::Arguments),
    /// Measures how fast the rig itself is on this machine
    Bench(bench::Arguments),
    /// Looks at the rig of a board on the desk
    Rig(rig::Arguments),
    /// Puts an image onto a rig's board
    Flash(flash::Arguments),
    /// Shows what a rig's board logs
    Log(log::Arguments),
    /// Says what is on a rig's board
    Info(info::Arguments),
    /// Flies many seeds and prints their statistics
    Campaign(campaign::Arguments),
    /// Flies many seeds of a scenario and holds them against what it expects
    Sweep(sweep::Arguments),
    /// Puts the shards of a sweep together
    Merge(merge::Arguments),
    /// Flies a flight that failed in a sweep again
    Replay(replay::Arguments),
    /// Prints every claim of the paper beside what is measured here
    Experiments(experiments::Arguments),
    /// Measures from where a snapshot of so many bytes brings a robot home
    Catchment(catchment::Arguments),
    /// Finds the lens in a unit's own pictures and writes its record
    Calibrate(calibrate::Arguments),
    /// Holds the emulated core's cycles against a board's, kernel by kernel
    CalibrateTiming(calibrate_timing::Arguments),
    /// Builds the firmware with whatever toolchain there is, and says which
    Build(build::Arguments),
    /// Holds the homing against a file of solved problems
    HomingCheck(homing_check::Arguments),
    /// Measures what each homing method costs on the emulated board
    HomingCycles(homing_cycles::Arguments),
    /// Flies home to one snapshot from nine starts, in closed loop
    HomingTest(homing_test::Arguments),
    /// Draws the report of a real flight from the logs of cfclient
    ImportCf(import_cf::Arguments),
    /// Holds the link's codec against records of another implementation's
    LinkCheck(link_check::Arguments),
    /// Says what the image takes of flash, RAM and stack
    Size(size::Arguments),
    /// Profiles a flight: cycles by stage, task and interrupt
    Profile(profile::Arguments),
    /// Draws what the camera sees from a place, and what of it is remembered
    Look(look::Arguments),
    /// Draws what it sees along a route
    Film(film::Arguments),
    /// Measures how far dead reckoning strays
    Drift(drift::Arguments),
    /// Injects faults at the camera's wires and looks what becomes of the frames
    CameraFaults(camera_faults::Arguments),
    /// Holds the filter against a recording of the firmware's own
    EkfReplay(ekf_replay::Arguments),
    /// Steps the set-point and looks at the answers
    Steps(steps::Arguments),
    /// Holds the autoexposure against every light, setting and latency
    Exposure(exposure::Arguments),
}

/// Why a verb could not be carried out.
type Failure = Box<dyn std::error::Error>;

/// Runs the command line of this process.
pub fn main() -> ExitCode {
    let console = Console::new();
    let result = match Cli::parse().verb {
        Verb::Fly(arguments) => fly::run(&arguments, &console),
        Verb::Emulate(arguments) => emulate::run(&arguments, &console),
        Verb::Autopilot(arguments) => autopilot::run(&arguments, &console),
        Verb::Bench(arguments) => bench::run(&arguments, &console),
        Verb::Rig(arguments) => rig::run(&arguments, &console),
        Verb::Flash(arguments) => flash::run(&arguments, &console),
        Verb::Log(arguments) => log::run(&arguments, &console),
        Verb::Info(arguments) => info::run(&arguments, &console),
        Verb::Campaign(arguments) => campaign::run(&arguments, &console),
        Verb::Sweep(arguments) => sweep::run(&arguments, &console),
        Verb::Merge(arguments) => merge::run(&arguments, &console),
        Verb::Replay(arguments) => replay::run(&arguments, &console),
        Verb::Experiments(arguments) => experiments::run(&arguments, &console),
        Verb::Catchment(arguments) => catchment::run(&arguments, &console),
        Verb::Calibrate(arguments) => calibrate::run(&arguments, &console),
        Verb::CalibrateTiming(arguments) => calibrate_timing::run(&arguments, &console),
        Verb::Build(arguments) => build::run(&arguments, &console),
        Verb::HomingCheck(arguments) => homing_check::run(&arguments, &console),
        Verb::HomingCycles(arguments) => homing_cycles::run(&arguments, &console),
        Verb::HomingTest(arguments) => homing_test::run(&arguments, &console),
        Verb::ImportCf(arguments) => import_cf::run(&arguments, &console),
        Verb::LinkCheck(arguments) => link_check::run(&arguments, &console),
        Verb::Size(arguments) => size::run(&arguments, &console),
        Verb::Profile(arguments) => profile::run(&arguments, &console),
        Verb::Look(arguments) => look::run(&arguments, &console),
        Verb::Film(arguments) => film::run(&arguments, &console),
        Verb::Drift(arguments) => drift::run(&arguments, &console),
        Verb::CameraFaults(arguments) => camera_faults::run(&arguments, &console),
        Verb::EkfReplay(arguments) => ekf_replay::run(&arguments, &console),
        Verb::Steps(arguments) => steps::run(&arguments, &console),
        Verb::Exposure(arguments) => exposure::run(&arguments, &console),
    };
    match result {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(failure) => {
            console.error(&failure.to_string());
            ExitCode::from(2)
        }
    }
}
