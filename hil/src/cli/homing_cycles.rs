//! `hil homing-cycles`: what each homing method costs on the board.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::Failure;
use super::console::Console;
use crate::catchment::settings::parse_bytes;
use crate::homing_cycles::{self, Cost};
use crate::image;

/// What the default may cost a frame: 10 ms at 168 MHz, a tenth of the time between two vectors.
const BUDGET_CYCLES: u64 = 1_700_000;

/// Options of `hil homing-cycles`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil homing-cycles\n  \
    hil homing-cycles --bytes 4,8,32 --json\n\n\
    Builds the example image `homing_methods` and has it home by each method on the emulated chip, from one\n\
    place in the office to three others.\n\
    Exit code 0: every vector is this machine's, bit for bit, and the default takes at most 10 ms (1.7 million\n\
    cycles). 1: not so. 2: it could not be tried.")]
pub struct Arguments {
    /// Bytes of a snapshot, with commas between them
    #[arg(long, default_value = "6,16,32", value_delimiter = ',', value_parser = parse_bytes)]
    bytes: Vec<u8>,
    /// An image of the example, instead of building one
    #[arg(long, value_name = "ELF")]
    firmware: Option<PathBuf>,
    /// Ends with one JSON object: costs
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Serialize)]
struct Outcome {
    costs: Vec<Cost>,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let say = |line: &str| console.status("Firmware", line);
    let file = match &arguments.firmware {
        Some(file) => file.clone(),
        None => image::build_example("homing_methods", &say)?,
    };
    let costs = homing_cycles::measure(&file, &arguments.bytes)?;
    let holds = costs.iter().all(|cost| {
        cost.equal && (cost.method != homing_cycles::DEFAULT || cost.cycles <= BUDGET_CYCLES)
    });
    if arguments.json {
        console.result(&serde_json::to_string(&Outcome { costs })?)?;
    } else {
        console.result(&in_words(&costs))?;
    }
    Ok(holds)
}

/// The table for people, without a newline at the end.
fn in_words(costs: &[Cost]) -> String {
    let mut lines = vec!["method       bytes      cycles       ms  as on this machine".to_owned()];
    for cost in costs {
        lines.push(format!(
            "{:<12} {:>5} {:>11} {:>8.2}  {}",
            cost.method,
            cost.bytes,
            cost.cycles,
            cost.cycles as f64 / 168e3,
            if cost.equal { "to the bit" } else { "no" }
        ));
    }
    lines.join("\n")
}
