//! `hil bench`: how fast the rig is on this machine.

use std::path::PathBuf;

use clap::Args;

use super::Failure;
use super::console::Console;
use super::fly::Image;
use crate::bench::{EXAMPLE, Figures, busy_mips, realtime_factor};
use crate::image;

/// Options of `hil bench`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil bench\n  \
    hil bench --runs 10 --json\n\n\
    Each figure is the best of its runs, on one core: what else runs here makes it smaller. Timings\n\
    are this machine's, and nothing is held against them.\n\
    Exit code 0: measured. 2: not.")]
pub struct Arguments {
    /// Runs of each
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u8).range(1..))]
    runs: u8,
    /// One JSON object on stdout: busy_mips, emulated_realtime_factor, native_realtime_factor
    #[arg(long)]
    json: bool,
    /// An image that is already built [default: this checkout's, built first]
    #[arg(long, value_name = "ELF")]
    firmware: Option<PathBuf>,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let image = Image::get(arguments.firmware.clone(), console)?;
    let busy = image::build_example(EXAMPLE, &|line| console.status("Firmware", line))?;
    let busy = std::fs::read(&busy).map_err(|error| format!("{}: {error}", busy.display()))?;
    let runs = arguments.runs;
    let figures = Figures {
        busy_mips: best(console, "busy core", runs, || Ok(busy_mips(&busy)?))?,
        emulated_realtime_factor: best(console, "emulated flight", runs, || {
            Ok(realtime_factor(Some(&image.bytes))?)
        })?,
        native_realtime_factor: best(console, "native flight", runs, || {
            Ok(realtime_factor(None)?)
        })?,
    };
    console.result(&if arguments.json {
        serde_json::to_string(&figures)?
    } else {
        in_words(&figures)
    })?;
    Ok(true)
}

/// The greatest of several measurements: whatever disturbs one makes it smaller.
fn best(
    console: &Console,
    what: &str,
    runs: u8,
    measure: impl Fn() -> Result<f64, Failure>,
) -> Result<f64, Failure> {
    let mut best = 0.0_f64;
    for run in 1..=runs {
        console.status("Measuring", &format!("{what}, {run} of {runs}"));
        best = best.max(measure()?);
    }
    Ok(best)
}

fn in_words(figures: &Figures) -> String {
    format!(
        "busy core        {:6.0} million instructions a second\n\
         default flight   {:6.0}x real time on the emulated board\n\
         \x20                {:6.0}x natively",
        figures.busy_mips, figures.emulated_realtime_factor, figures.native_realtime_factor
    )
}
