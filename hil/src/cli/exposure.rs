//! `hil exposure`: the autoexposure over the whole grid of conditions.

use std::fs;
use std::path::PathBuf;

use clap::Args;

use super::Failure;
use super::console::Console;
use crate::exposure::{self, DEADLINE, Grid, Outcome, Scene, Verdict};
use crate::parallel;

/// How many of the worst conditions are named and drawn.
const WORST: usize = 6;

/// Options of `hil exposure`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil exposure                          the whole grid, and the worst conditions\n  \
    hil exposure --json\n  \
    hil exposure --plot exposure.svg      with a picture of the worst\n\n\
    Light over 1 : 1000, shutter and gain from one end to the other, latency of 1 to 3 frames, gamma on and off, in six\n\
    scenes, among them lamps outside the horizon band and the sun inside it. Frame 1 is the first that the controller\n\
    sees.\n\
    Exit code 0: in every condition the mean luma of the horizon band is 80 +- 3 on frame 10 and on all after it, up to\n\
    frame 30. 1: not in all. 2: could not be done.")]
pub struct Arguments {
    /// Ends with one JSON object: conditions, settled_within_10, unreachable, worst_frames, worst_error
    #[arg(long)]
    json: bool,
    /// Draws the luma of the worst conditions
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let scenes = Scene::all()?;
    let conditions = Grid::whole().conditions(&scenes);
    let pairs: Vec<_> = conditions
        .iter()
        .filter_map(|condition| {
            let scene = scenes.iter().find(|scene| scene.name == condition.scene)?;
            Some((condition, scene))
        })
        .collect();
    let mut progress = console.progress("Exposing", pairs.len() as u64);
    let outcomes: Vec<Outcome> = parallel::map(
        &pairs,
        |(condition, scene)| exposure::expose(condition, scene),
        |done| {
            progress.set(done as u64, || {
                format!("{done} of {} conditions", pairs.len())
            })
        },
    )
    .into_iter()
    .collect::<Result<_, _>>()?;
    progress.finish();

    let verdict = Verdict::of(&outcomes);
    let worst = exposure::worst(&outcomes, WORST);
    if let Some(file) = &arguments.plot {
        fs::write(file, exposure::picture(&worst))
            .map_err(|error| format!("{}: {error}", file.display()))?;
        console.status("Picture", &file.display().to_string());
    }
    if arguments.json {
        console.result(&serde_json::to_string(&verdict)?)?;
    } else {
        console.result(&in_words(&verdict, &worst))?;
    }
    Ok(verdict.holds())
}

/// The summary for people, without a newline at the end.
fn in_words(verdict: &Verdict, worst: &[&Outcome]) -> String {
    let mut lines = vec![
        format!(
            "{} of {} conditions hold 80 +- 3 from frame {DEADLINE} on, the slowest from frame {}; at most {:.2} off",
            verdict.settled_within_10,
            verdict.conditions,
            verdict.worst_frames,
            verdict.worst_error
        ),
        format!(
            "{} conditions had no setting that could",
            verdict.unreachable
        ),
        "the worst:".to_owned(),
    ];
    for outcome in worst {
        lines.push(format!(
            "  from frame {:>2}, {:.2} off: {}",
            outcome.frames(),
            outcome.error(),
            outcome.condition.in_words()
        ));
    }
    lines.join("\n")
}
