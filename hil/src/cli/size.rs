//! `hil size`: what the image takes of the chip's memories.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use super::Failure;
use super::console::Console;
use super::fly::{Image, ScenarioArguments};
use crate::board::emulated::Firmware;
use crate::flight;
use crate::report::number::grouped;
use crate::size::{Difference, Size};

/// Options of `hil size`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil size                             flash, RAM and, from a flight, the stack\n  \
    hil size --route corner --top 40     the same from a short flight, and the 40 largest symbols\n  \
    hil size --save before.json          to be compared with, later\n  \
    hil size --baseline before.json      what grew and what shrank\n\n\
    The deepest stack is that of one flight, interrupts included, read off painted memory: other flights may go deeper.\n\
    There is no static bound: tasks are polled and drivers called through pointers, which no call graph follows.\n\
    Exit code 0: the sizes are known and the stack keeps to its memory. 1: it left it. 2: it could not be done.")]
pub struct Arguments {
    #[command(flatten)]
    scenario: ScenarioArguments,
    /// Seed of world, sensors and camera noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Symbols that are told, the largest first
    #[arg(long, value_name = "COUNT", default_value_t = 20)]
    top: usize,
    /// Compares with sizes that were saved
    #[arg(long, value_name = "FILE")]
    baseline: Option<PathBuf>,
    /// Saves the sizes as a baseline
    #[arg(long, value_name = "FILE")]
    save: Option<PathBuf>,
    /// Ends with one JSON object: flash_bytes, ram_bytes, stack_peak_bytes, stack_free_bytes and more
    #[arg(long)]
    json: bool,
    /// An image that is already built [default: this checkout's, built first]
    #[arg(long, value_name = "ELF")]
    firmware: Option<PathBuf>,
}

/// What `--json` prints.
#[derive(Serialize)]
struct Outcome<'s> {
    #[serde(flatten)]
    size: &'s Size,
    #[serde(skip_serializing_if = "Option::is_none")]
    difference: Option<Difference>,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let baseline = arguments.baseline.as_deref().map(read).transpose()?;
    let image = Image::get(arguments.firmware.clone(), console)?;
    let firmware = Firmware::parse(&image.bytes).map_err(|error| image.failure(error.into()))?;
    let scenario = arguments.scenario.scenario(arguments.seed);
    let mut bar = console.progress("Flying", 1000);
    let flown = flight::fly_emulated(&scenario, &image.bytes, &mut |progress| {
        bar.set((1000.0 * progress.fraction) as u64, || progress.to_string());
    });
    bar.finish();
    let flown = flown.map_err(|error| image.failure(error))?;
    let figures = flown.summary.firmware.as_ref();
    let size = Size::of(
        firmware.image(),
        figures.and_then(|firmware| firmware.stack_peak_bytes),
    );
    if let Some(path) = &arguments.save {
        fs::write(path, serde_json::to_string_pretty(&size)? + "\n")
            .map_err(|error| format!("{}: {error}", path.display()))?;
    }
    let outcome = Outcome {
        difference: baseline.map(|before| Difference::between(&before, &size)),
        size: &size,
    };
    if arguments.json {
        console.result(&serde_json::to_string(&outcome)?)?;
    } else {
        console.result(&in_words(&outcome, arguments.top))?;
    }
    Ok(size.stack_peak_bytes.is_some())
}

fn read(path: &Path) -> Result<Size, Failure> {
    let text = fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let size = serde_json::from_str(&text);
    Ok(size.map_err(|error| format!("{}: no saved sizes: {error}", path.display()))?)
}

fn in_words(outcome: &Outcome, top: usize) -> String {
    let size = outcome.size;
    let stack = match (size.stack_peak_bytes, size.stack_free_bytes) {
        (Some(peak), Some(free)) => format!(
            "{} B of {} at the deepest, {} free ({:.0} %)",
            grouped(peak.into()),
            grouped(size.stack_bytes.into()),
            grouped(free.into()),
            100.0 * f64::from(free) / f64::from(size.stack_bytes.max(1))
        ),
        _ => "left its memory".to_owned(),
    };
    let mut lines = vec![
        format!("flash  {} B", grouped(size.flash_bytes.into())),
        format!("RAM    {} B, static", grouped(size.ram_bytes.into())),
        format!("stack  {stack}"),
        format!("{:<60}{:>10}{:>10}", "by crate", "flash", "RAM"),
    ];
    let row = |name: &str, flash: u32, ram: u32| {
        let [flash, ram] = [flash, ram].map(|bytes| grouped(bytes.into()));
        format!("  {name:<58}{flash:>10}{ram:>10}")
    };
    let mut crates: Vec<_> = size.crates.iter().collect();
    crates.sort_by_key(|(_, bytes)| std::cmp::Reverse(bytes.flash + bytes.ram));
    lines.extend(
        crates
            .iter()
            .map(|(name, bytes)| row(name, bytes.flash, bytes.ram)),
    );
    lines.push(format!("the largest {top} symbols"));
    let mut symbols: Vec<_> = size.symbols.iter().collect();
    symbols.sort_by_key(|(_, bytes)| std::cmp::Reverse(bytes.flash + bytes.ram));
    let symbols = symbols.iter().take(top);
    lines.extend(symbols.map(|(name, bytes)| row(name, bytes.flash, bytes.ram)));
    lines.extend(outcome.difference.iter().flat_map(changed));
    lines.join("\n")
}

fn changed(difference: &Difference) -> Vec<String> {
    let all = difference.all;
    let mut lines = vec![format!(
        "{:<60}{:>+10}{:>+10}",
        "since the baseline", all.flash, all.ram
    )];
    if let Some(stack) = difference.stack_peak {
        lines.push(format!("  {:<58}{stack:>+10}", "the deepest stack"));
    }
    for (name, change) in difference.crates.iter().chain(&difference.symbols) {
        lines.push(format!(
            "  {name:<58}{:>+10}{:>+10}",
            change.flash, change.ram
        ));
    }
    lines
}
