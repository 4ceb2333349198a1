//! `hil steps`: step responses and the hover, beside what the gains predict.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use autopilot::vehicle::VehicleParameters;
use clap::Args;
use fake_sensors::motion::SensorModel;
use fake_sensors::wind::WindModel;
use serde::Serialize;

use super::Failure;
use super::console::Console;
use crate::folder;
use crate::parallel;
use crate::steps::{self, Figures, Hover, Response, STEPS};

/// How long each hover is looked at, seconds.
const HOVER_S: f64 = 20.0;

/// Options of `hil steps`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil steps                             five steps and the hover of ten seeds\n  \
    hil steps --json\n  \
    hil steps --out steps                 with a picture, steps/steps.svg\n\n\
    The drone flies on its own estimates: steps with ideal sensors, the hover with the nominal ones. In brackets stands\n\
    what the gains predict, from mechanics that share no code with the controller.\n\
    Exit code 0: every response is as predicted, within the tolerances that `steps` states. 1: one is not.")]
pub struct Arguments {
    /// How many seeds hover
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u64).range(1..=10_000))]
    seeds: u64,
    /// Ends with one JSON object: steps, hover, within
    #[arg(long)]
    json: bool,
    /// Folder for steps.svg and steps.json
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
}

/// What `--json` prints.
#[derive(Debug, Serialize)]
struct Outcome {
    steps: Vec<Response>,
    /// Root mean squares over the seeds; of the extremes the greatest.
    hover: Hover,
    /// Whether every response is as predicted.
    within: bool,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let unwritable = |folder: &Path, error| format!("{}: {error}", folder.display());
    if let Some(out) = &arguments.out {
        folder::prepare(out).map_err(|error| unwritable(out, error))?;
    }
    let mut progress = console.progress("Stepping", STEPS.len() as u64);
    let responses = parallel::map(
        &STEPS,
        |step| steps::fly(*step),
        |done| progress.set(done as u64, || format!("{done} of {} steps", STEPS.len())),
    );
    progress.finish();
    let outcome = Outcome {
        hover: hover(arguments.seeds, console),
        within: responses.iter().all(Response::is_as_predicted),
        steps: responses,
    };
    if let Some(out) = &arguments.out {
        write(out, &outcome).map_err(|error| unwritable(out, error))?;
        let picture = out.join("steps.svg");
        console.status("Picture", &picture.display().to_string());
    }
    if arguments.json {
        console.result(&serde_json::to_string(&outcome)?)?;
    } else {
        console.result(&in_words(&outcome))?;
    }
    Ok(outcome.within)
}

fn hover(seeds: u64, console: &Console) -> Hover {
    let seeds: Vec<u64> = (1..=seeds).collect();
    let mut progress = console.progress("Hovering", seeds.len() as u64);
    let hovers = parallel::map(
        &seeds,
        |seed| {
            steps::hover(
                VehicleParameters::default(),
                &SensorModel::default(),
                &WindModel::calm(),
                *seed,
                HOVER_S,
            )
        },
        |done| progress.set(done as u64, || format!("{done} of {} seeds", seeds.len())),
    );
    progress.finish();
    Hover::over(&hovers)
}

/// Leaves figures and picture in a folder that is prepared.
fn write(folder: &Path, outcome: &Outcome) -> io::Result<()> {
    let json = serde_json::to_string_pretty(outcome)? + "\n";
    fs::write(folder.join("steps.json"), json)?;
    fs::write(folder.join("steps.svg"), steps::picture(&outcome.steps))
}

/// The table for people, without a newline at the end.
fn in_words(outcome: &Outcome) -> String {
    let mut lines = vec![
        "flown with ideal sensors; in brackets what the gains predict".to_owned(),
        "step           10-90 % s       overshoot %     within 5 % s    fastest /s      apart %  tilt deg"
            .to_owned(),
    ];
    for response in &outcome.steps {
        let pair = |scale: f64, decimals: usize, of: fn(&Figures) -> f64| {
            let text = |figures: &Option<Figures>| {
                figures.as_ref().map_or("-".to_owned(), |figures| {
                    format!("{:.decimals$}", scale * of(figures))
                })
            };
            format!(
                "{:>6} {:<9}",
                text(&response.flown),
                format!("({})", text(&response.predicted))
            )
        };
        let step = response.step;
        lines.push(format!(
            "{:<4}{:>5} {:<4}{}{}{}{}{:>7.1}{:>10.1}",
            step.axis.name(),
            step.size,
            step.axis.unit(),
            pair(1.0, 2, |figures| figures.rise_s),
            pair(100.0, 1, |figures| figures.overshoot),
            pair(1.0, 2, |figures| figures.settling_s),
            pair(1.0, 2, |figures| figures.fastest),
            100.0 * response.distance,
            response.tilt_deg
        ));
    }
    let hover = &outcome.hover;
    lines.push(format!(
        "hover of {HOVER_S} s, nominal sensors, RMS: {:.1} cm by its own estimate, {:.1} cm in truth, height {:.1} cm, \
         {:.1} cm/s, tilt {:.2} deg",
        100.0 * hover.estimate_rms_m,
        100.0 * hover.position_rms_m,
        100.0 * hover.height_rms_m,
        100.0 * hover.speed_rms_m_s,
        hover.tilt_rms_deg
    ));
    lines.join("\n")
}
