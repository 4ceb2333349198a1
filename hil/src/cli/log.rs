//! `hil log`: what a rig's board logs.

use std::path::PathBuf;
use std::thread;
use std::time::Duration;

use clap::Args;

use super::Failure;
use super::console::Console;
use super::fly::Image;
use super::rig::RigArgument;
use crate::board::FirmwareLog;
use crate::board::emulated::Firmware;
use crate::live::Stop;
use crate::rig::probe;

/// Between two looks.
const LOOK_EVERY: Duration = Duration::from_millis(20);

/// Options of `hil log`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil log --rig discovery                 the log of the board, until Ctrl-C\n  \
    hil log --rig discovery --seconds 5\n\n\
    The image must be the one that is on the board: it says what its records mean.\n\
    Exit code 0: it was listened to. 2: it could not be.")]
pub struct Arguments {
    #[command(flatten)]
    rig: RigArgument,
    /// The image that is on the board [default: this checkout's, built first]
    #[arg(long, value_name = "ELF")]
    firmware: Option<PathBuf>,
    /// Ends after so many seconds
    #[arg(long, value_name = "N")]
    seconds: Option<f64>,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let rig = arguments.rig.open()?;
    let mut probe = probe::of(&rig);
    console.status("Probe", &probe.find()?);
    let image = Image::for_rig(arguments.firmware.clone(), &rig, console)?;
    let firmware = Firmware::parse(&image.bytes)?;
    let mut log = probe.log(&image.on_board(&firmware))?;
    let stop = Stop::on_signals()?;
    let mut left = arguments.seconds.unwrap_or(f64::INFINITY);
    while !stop.requested() && left > 0.0 {
        let mut records = Vec::new();
        log.poll(&mut records)?;
        for record in &records {
            console.result(&in_words(record))?;
        }
        thread::sleep(LOOK_EVERY);
        left -= LOOK_EVERY.as_secs_f64();
    }
    Ok(true)
}

/// As probe-rs prints it: time stamp, level and message, and below it the place in the sources.
fn in_words(record: &FirmwareLog) -> String {
    let (level, text, origin) = match record {
        FirmwareLog::Frame(frame) => (
            "debug",
            format!(
                "frame: {} cycles, luma {:.1}, {} lines, gain {:.2}",
                frame.cycles.unwrap_or_default(),
                frame.luma,
                frame.lines,
                frame.gain
            ),
            &None,
        ),
        FirmwareLog::LinkDrop {
            message,
            why,
            origin,
        } => ("warn", format!("link dropped {message}: {why}"), origin),
        FirmwareLog::CaptureFault { name, origin } => {
            ("warn", format!("capture fault: {name}"), origin)
        }
        FirmwareLog::Line {
            level,
            text,
            origin,
        } => (*level, text.clone(), origin),
    };
    let stamp = origin.as_ref().map_or("", |origin| origin.stamp.as_str());
    let line = format!("{stamp:>12} {level:<5} {text}");
    match origin.as_ref().and_then(|origin| origin.place.as_ref()) {
        Some(place) => format!("{line}\n{:>13}└─ {place}", ""),
        None => line,
    }
}
