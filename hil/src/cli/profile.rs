//! `hil profile`: where the cycles of a flight go.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;

use super::Failure;
use super::console::Console;
use super::fly::{Image, ScenarioArguments};
use super::timing::TimingArguments;
use crate::board::timing::TimingModel;
use crate::profile::{
    self, Profile, Profiled, Quantiles, Stage, Window, chrome, flame, histograms, timing_diagram,
};
use crate::report::number::grouped;
use crate::scenario::Scenario;

/// Functions that are told in words.
const FUNCTIONS_TOLD: usize = 25;

/// Misses that are told in words.
const MISSES_TOLD: usize = 10;

/// Options of `hil profile`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil profile                                    the default flight\n  \
    hil profile --route corner --json              a short one, for scripts\n  \
    hil profile --trace flight.json                two seconds of it, to be opened in ui.perfetto.dev\n  \
    hil profile --trace all.json --window 0,600    all of it\n  \
    hil profile --timeline period.svg              one frame period as a picture\n  \
    hil profile --histograms stages.svg            every stage's cycles, frame by frame\n  \
    hil profile --wait-states 0                    as if the flash kept up with the core\n  \
    hil profile --functions flame.svg              exact cycles by function, as a flame graph\n\n\
    Cycles are the emulated core's, read at the functions of the image: nothing is added to the firmware. Interrupts are\n\
    charged to themselves, a stage within another to itself. They are modelled: silicon may differ by 10 to 15 % on code\n\
    that computes and by 25 % on drivers (see `hil calibrate-timing`).\n\
    Exit code 0: no frame missed its deadline. 1: one did. 2: the flight could not be flown.")]
pub struct Arguments {
    #[command(flatten)]
    scenario: ScenarioArguments,
    /// Seed of world, sensors and camera noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Writes tasks, interrupts, DMA, link and frames as one time line, in Chrome's trace format
    #[arg(long, value_name = "FILE")]
    trace: Option<PathBuf>,
    /// The time line's piece of the flight: from a second on and, after a comma, for how many
    #[arg(long, value_name = "SECOND[,SECONDS]", default_value = "60,2", value_parser = parse_window)]
    window: Window,
    /// Draws one frame period of that piece, the first in which most stages run
    #[arg(long, value_name = "SVG")]
    timeline: Option<PathBuf>,
    /// Draws how often a frame took how many cycles, stage by stage
    #[arg(long, value_name = "SVG")]
    histograms: Option<PathBuf>,
    /// Draws cycles by function, inlined ones included, as a flame graph (.svg), or lists them in folded stacks; looks at
    /// every instruction, which takes ten times as long
    #[arg(long, value_name = "FILE", conflicts_with_all = ["trace", "timeline", "histograms", "json"])]
    functions: Option<PathBuf>,
    /// Ends with one JSON object: frames, stages, vision, pixel_to_vector_s, load, missed and more
    #[arg(long)]
    json: bool,
    /// An image that is already built [default: this checkout's, built first]
    #[arg(long, value_name = "ELF")]
    firmware: Option<PathBuf>,
    #[command(flatten)]
    timing: TimingArguments,
}

fn parse_window(text: &str) -> Result<Window, String> {
    let (from, length) = text.split_once(',').unwrap_or((text, "2"));
    let number = |text: &str| {
        text.parse()
            .ok()
            .filter(|s: &f64| s.is_finite() && *s >= 0.0)
    };
    match (number(from), number(length)) {
        (Some(from_s), Some(for_s)) => Ok(Window { from_s, for_s }),
        _ => Err("seconds of the flight, as in 60 or 60,2".to_owned()),
    }
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let image = Image::get(arguments.firmware.clone(), console)?;
    let scenario = arguments.scenario.scenario(arguments.seed);
    let timing = arguments.timing.model();
    if let Some(path) = &arguments.functions {
        return by_function(&scenario, &image, timing, path, console);
    }
    let wanted = arguments.trace.is_some() || arguments.timeline.is_some();
    let window = wanted.then_some(arguments.window);
    let mut bar = console.progress("Profiling", 1000);
    let profiled = profile::fly(&scenario, &image.bytes, timing, window, &mut |progress| {
        bar.set((1000.0 * progress.fraction) as u64, || progress.to_string());
    });
    bar.finish();
    let profiled = profiled.map_err(|error| image.failure(error))?;
    write_pictures(arguments, &profiled, console)?;
    if arguments.json {
        console.result(&serde_json::to_string(&profiled.profile)?)?;
    } else {
        console.result(&in_words(&profiled))?;
    }
    Ok(profiled.profile.missed == 0)
}

/// Those that were asked for.
fn write_pictures(
    arguments: &Arguments,
    profiled: &Profiled,
    console: &Console,
) -> Result<(), Failure> {
    let write = |what: &str, path: &Path, text: String| {
        fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))?;
        console.status(what, &path.display().to_string());
        Ok::<(), Failure>(())
    };
    if let Some(timeline) = &profiled.timeline {
        if let Some(path) = &arguments.trace {
            write("Trace", path, chrome::to_json(timeline)?)?;
        }
        if let Some(path) = &arguments.timeline {
            write("Timeline", path, timing_diagram::picture(timeline))?;
        }
    }
    if let Some(path) = &arguments.histograms {
        write("Histograms", path, histograms::picture(&profiled.frames))?;
    }
    Ok(())
}

fn by_function(
    scenario: &Scenario,
    image: &Image,
    timing: TimingModel,
    path: &Path,
    console: &Console,
) -> Result<bool, Failure> {
    let mut bar = console.progress("Profiling", 1000);
    let flown = profile::fly_by_function(scenario, &image.bytes, timing, &mut |progress| {
        bar.set((1000.0 * progress.fraction) as u64, || progress.to_string());
    });
    bar.finish();
    let (flown, stacks) = flown.map_err(|error| image.failure(error))?;
    let text = if path.extension().is_some_and(|extension| extension == "svg") {
        flame::picture(&stacks)
    } else {
        stacks.folded()
    };
    fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))?;
    console.status("Functions", &path.display().to_string());
    let all = stacks.total().max(1) as f64;
    let functions = stacks.by_function();
    for (name, cycles) in functions.iter().take(FUNCTIONS_TOLD) {
        let share = 100.0 * *cycles as f64 / all;
        console.result(&format!("{share:>7.2} %{:>14}  {name}", grouped(*cycles)))?;
    }
    Ok(flown.summary.completed)
}

fn in_words(profiled: &Profiled) -> String {
    let profile = &profiled.profile;
    let mut lines = vec![format!(
        "{:<16}{:>8}{:>10}{:>10}{:>10}{:>10}{:>11}",
        "stage, cycles", "frames", "p50", "p90", "p99", "max", "p50, us"
    )];
    let stages = Stage::ALL.map(|stage| (stage.name(), profile.stages[stage.name()]));
    let rows = stages
        .into_iter()
        .chain([("vision in all", profile.vision)]);
    lines.extend(rows.map(|(name, quantiles)| row(name, &quantiles, profile.core_hz)));
    let milliseconds = |q: &Quantiles<f64>| {
        let [p50, p99, max] = [q.p50, q.p99, q.max].map(|seconds| 1.0e3 * seconds);
        format!("p50 {p50:.3} ms, p99 {p99:.3} ms, max {max:.3} ms")
    };
    lines.push(format!(
        "pixel to vector   {}  (without the view's wait for a STATE)",
        milliseconds(&profile.pixel_to_vector_s)
    ));
    lines.push(format!(
        "STATE to vector   {}",
        milliseconds(&profile.answer_s)
    ));
    lines.extend(loads(profile));
    lines.push(format!(
        "deadlines         {} of {} frames missed; least margin {:.3} ms",
        profile.missed,
        profile.frames,
        1.0e3 * profile.least_margin_s
    ));
    for miss in profile.misses.iter().take(MISSES_TOLD) {
        lines.push(format!("  at {:.3} s: {}", miss.at_s, miss.running));
    }
    let model = &profile.model;
    lines.push(format!("{} (error: {})", model.source, model.error));
    lines.push(format!("assumed: {}", model.assumptions));
    lines.join("\n")
}

fn row(name: &str, quantiles: &Quantiles<u64>, core_hz: u32) -> String {
    let microseconds = quantiles.p50 as f64 * 1.0e6 / f64::from(core_hz);
    format!(
        "  {name:<14}{:>8}{:>10}{:>10}{:>10}{:>10}{microseconds:>11.1}",
        grouped(quantiles.count as u64),
        grouped(quantiles.p50),
        grouped(quantiles.p90),
        grouped(quantiles.p99),
        grouped(quantiles.max),
    )
}

fn loads(profile: &Profile) -> Vec<String> {
    let mut lines = vec![format!(
        "load              {:.2} %, woken {:.0} times a second",
        100.0 * profile.load,
        profile.wakeups_per_s
    )];
    for (kind, loads) in [("task", &profile.tasks), ("interrupt", &profile.interrupts)] {
        for (name, load) in loads {
            lines.push(format!(
                "  {kind:<10}{name:<22}{:>8.3} %{:>9.1} a second",
                100.0 * load.share,
                load.per_s
            ));
        }
    }
    lines.push(format!(
        "  {:<32}{:>8.3} %",
        "executor, outside tasks",
        100.0 * profile.executor
    ));
    lines
}
