//! `hil homing-test`: nine starts round one snapshot, flown home in closed loop.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use super::Failure;
use super::console::Console;
use super::world;
use crate::folder;
use crate::homing_test::{self, NEAR_M, STARTS, Verdict};

/// Options of `hil homing-test`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil homing-test                       nine starts on 20 seeds in the arena\n  \
    hil homing-test --world hdri --seeds 1 --out fig4\n  \
    hil homing-test --json\n\n\
    Each run takes a snapshot in the middle of the world's free space, flies 1, 1.5 or 2 m away and follows\n\
    the camera for 20 s (paper, Fig. 4), on the native backend.\n\
    Exit code 0: at least 8 of the 9 starts of every seed end within 0.5 m. 1: not so. 2: no flight.")]
pub struct Arguments {
    /// A name of the library's worlds, or a TOML file
    #[arg(long, default_value = "arena", value_parser = world::parse)]
    world: String,
    /// How many seeds
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=10_000))]
    seeds: u64,
    /// The first seed
    #[arg(long, default_value_t = 1)]
    first: u64,
    /// Ends with one JSON object: runs, verdict
    #[arg(long)]
    json: bool,
    /// Folder for homing-test.svg and homing-test.json
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
}

/// What `--json` prints.
#[derive(Debug, Serialize)]
struct Outcome {
    world: String,
    runs: Vec<Line>,
    verdict: Verdict,
}

#[derive(Debug, Serialize)]
struct Line {
    seed: u64,
    start_m: [f64; 2],
    end_error_m: f64,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let unwritable = |folder: &Path, error| format!("{}: {error}", folder.display());
    if let Some(out) = &arguments.out {
        folder::prepare(out).map_err(|error| unwritable(out, error))?;
    }
    let seeds = (0..arguments.seeds).map(|index| arguments.first.wrapping_add(index));
    let flights = arguments.seeds * STARTS as u64;
    let mut progress = console.progress("Homing", flights);
    let runs = homing_test::fly_all(&arguments.world, seeds, |done| {
        progress.set(done as u64, || format!("{done} of {flights} runs"));
    })?;
    progress.finish();
    let starts = homing_test::starts_m().into_iter().cycle();
    let lines = runs.iter().zip(starts).map(|(run, start_m)| Line {
        seed: run.seed,
        start_m,
        end_error_m: run.end_error_m(),
    });
    let outcome = Outcome {
        world: arguments.world.clone(),
        runs: lines.collect(),
        verdict: Verdict::on(&runs),
    };
    if let Some(out) = &arguments.out {
        let json = serde_json::to_string_pretty(&runs)? + "\n";
        let picture = homing_test::picture(&arguments.world, &runs);
        fs::write(out.join("homing-test.json"), json)
            .and_then(|()| fs::write(out.join("homing-test.svg"), picture))
            .map_err(|error| unwritable(out, error))?;
        console.status(
            "Picture",
            &out.join("homing-test.svg").display().to_string(),
        );
    }
    if arguments.json {
        console.result(&serde_json::to_string(&outcome)?)?;
    } else {
        console.result(&in_words(&outcome))?;
    }
    Ok(outcome.verdict.holds)
}

/// The table for people, without a newline at the end.
fn in_words(outcome: &Outcome) -> String {
    let mut lines = vec![
        "where each start (1, 1.5, 2 m away in turn, every 40 degrees) ends, metres".to_owned(),
    ];
    for of_seed in outcome.runs.chunk_by(|a, b| a.seed == b.seed) {
        let errors: Vec<String> = of_seed
            .iter()
            .map(|line| format!("{:.2}", line.end_error_m))
            .collect();
        let near = of_seed
            .iter()
            .filter(|line| line.end_error_m < NEAR_M)
            .count();
        lines.push(format!(
            "seed {:<4} {}   {near} of {} within {NEAR_M} m",
            of_seed[0].seed,
            errors.join(" "),
            of_seed.len()
        ));
    }
    let verdict = &outcome.verdict;
    lines.push(format!(
        "{}: {} of {} home, at least {} of each seed; median {:.2} m, 95 % within {:.2} m",
        outcome.world, verdict.home, verdict.runs, verdict.fewest, verdict.p50_m, verdict.p95_m
    ));
    lines.join("\n")
}
