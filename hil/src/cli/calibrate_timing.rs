//! `hil calibrate-timing`: the cycle model against a board, kernel by kernel.

use std::path::PathBuf;

use clap::Args;

use super::Failure;
use super::console::Console;
use super::timing::TimingArguments;
use crate::calibrate_timing::{self, Comparison, EXAMPLE, NOTHING, Pair, Published};
use crate::image;
use crate::report::number::grouped;

/// Options of `hil calibrate-timing`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil calibrate-timing                    cycles of each kernel on the emulated core\n  \
    hil calibrate-timing --board run.log    the ratio to a board's, kernel by kernel\n  \
    hil calibrate-timing --wait-states 0    as if the flash kept up with the core\n  \
    hil calibrate-timing --json\n\n\
    The board's log: cargo run --profile flight --package firmware --target thumbv7em-none-eabihf --example kernels > run.log\n\
    Each kernel runs twice, with interrupts off; the second time counts. Rounds: accelerated, as in flight; cached, without\n\
    prefetch; bare, without prefetch and caches. All with the five wait states of 168 MHz. Cycles per item are those beyond\n    the kernel that does nothing.\n\
    Exit code 0: every ratio is within 15 % (or there is no board). 1: one is not. 2: it could not be done.")]
pub struct Arguments {
    /// The log of the same kernels on a board, as probe-rs prints it
    #[arg(long, value_name = "LOG")]
    board: Option<PathBuf>,
    /// An image of the kernels that is already built [default: this checkout's, built first]
    #[arg(long, value_name = "ELF")]
    firmware: Option<PathBuf>,
    #[command(flatten)]
    timing: TimingArguments,
    /// Ends with one JSON object: kernels, worst_ratio, within
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let elf = match &arguments.firmware {
        Some(elf) => elf.clone(),
        None => image::build_example(EXAMPLE, &|line| console.status("Firmware", line))?,
    };
    let read = |path: &PathBuf| {
        std::fs::read(path).map_err(|error| format!("{}: {error}", path.display()))
    };
    let model = arguments.timing.model();
    let timings = calibrate_timing::emulate(&read(&elf)?, model)
        .map_err(|error| format!("{}: {error}", elf.display()))?;
    let comparison = match &arguments.board {
        None => Comparison::modelled(timings),
        Some(path) => calibrate_timing::read(&String::from_utf8_lossy(&read(path)?))
            .and_then(|board| Comparison::with_board(timings, &board))
            .map_err(|error| format!("{}: {error}", path.display()))?,
    };
    if arguments.json {
        console.result(&serde_json::to_string(&comparison)?)?;
    } else {
        console.result(&in_words(&comparison))?;
        console.result(&format!("assumed: {model}"))?;
    }
    Ok(comparison.within)
}

/// A table, a round after the other.
fn in_words(comparison: &Comparison) -> String {
    let mut lines = Vec::new();
    for round in comparison
        .kernels
        .chunk_by(|a, b| a.modelled.round == b.modelled.round)
    {
        let title = round.first().map_or("", |pair| &pair.modelled.round);
        lines.push(format!(
            "{title:<56}{:>7}{:>9}{:>9}{:>10}{:>10}{:>8}",
            "items", "first", "then", "per item", "board", "ratio"
        ));
        let nothing = round.iter().find(|pair| pair.modelled.kernel == NOTHING);
        let nothing = nothing.map_or(0, |pair| pair.modelled.then);
        lines.extend(round.iter().map(|pair| row(pair, nothing)));
    }
    for known in Published::ALL {
        lines.push(format!(
            "published: {} {} cycles on {}",
            known.kernel,
            grouped(known.cycles.into()),
            known.source
        ));
    }
    match comparison.worst_ratio {
        Some(ratio) => lines.push(format!("the ratio farthest from 1 is {ratio:.3}")),
        None => lines.push("modelled, not measured: no board's log was given".to_owned()),
    }
    lines.join("\n")
}

fn row(pair: &Pair, nothing: u32) -> String {
    let timing = &pair.modelled;
    let per_item = pair.per_item(nothing);
    let board = pair
        .board
        .map_or("-".to_owned(), |cycles| grouped(cycles.into()));
    let ratio = pair
        .ratio
        .map_or("-".to_owned(), |ratio| format!("{ratio:.3}"));
    format!(
        "  {:<54}{:>7}{:>9}{:>9}{per_item:>10.2}{board:>10}{ratio:>8}",
        timing.kernel,
        timing.items,
        grouped(timing.first.into()),
        grouped(timing.then.into()),
    )
}
