//! Catchment areas of methods, and the settings at which they are largest.

use core::fmt::Write as _;

use nav::methods::{Fourier, Homeward, HomingMethod, Mfdid, Search, WarpSearch};
use serde::Serialize;

use super::condition::Condition;
use super::field::{self, Field};
use super::judge;
use super::search_vectors;
use super::settings::{Method, Settings};
use super::survey::{Current, Survey};
use crate::parallel;

/// While tuning, every so manieth start along both axes is tried.
const TUNING_STRIDE: usize = 2;

/// A line of the table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// The place.
    pub world: String,
    /// The method.
    pub method: Method,
    /// Bytes of a snapshot.
    pub bytes: u8,
    /// What differs between memory and view.
    pub condition: Condition,
    /// From where a run ends within 0.5 m, mean over the snapshots.
    pub area_m2: f64,
    /// Within 0.25 m.
    pub area25_m2: f64,
    /// `area_m2` by `bytes`.
    pub area_per_byte: f64,
    /// Standard error of `area_m2` over the snapshots.
    pub stderr_m2: f64,
    /// How far from the snapshot a run ends that starts 0.3 m from it, mean, metres.
    pub end_error_m: f64,
    /// Standard error of `end_error_m` over the snapshots.
    pub end_stderr_m: f64,
    /// How well the quality of a vector tells whether it points to within 90 degrees: the area under
    /// the curve of hits over false alarms, 0.5 by chance. None where all do, or none does.
    pub roc: Option<f64>,
    /// How many there are.
    pub snapshots: usize,
    /// The places on which the settings were chosen, with spaces between; `shipped` where they are
    /// fixed.
    pub tuned_on: String,
    /// All free positions of the place, m².
    pub free_m2: f64,
    /// The settings.
    pub settings: String,
}

/// A method at a size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Task {
    /// The method.
    pub method: Method,
    /// Bytes of a snapshot.
    pub bytes: u8,
    /// How far the heading may be off, degrees.
    pub heading_deg: f32,
}

/// What a survey comes to with some settings: areas by snapshot, m², within 0.5 and 0.25 m.
pub type Area = [f64; 2];

/// Areas of every snapshot of a survey.
pub fn areas(survey: &Survey, settings: &Settings, stride: usize) -> Vec<Area> {
    let found = vectors_with(survey, settings);
    let goals = survey.goals.iter().zip(&found);
    goals
        .map(|(goal, vectors)| {
            let goal_m = survey.grid.position_m(goal.index);
            field::areas_m2(&survey.grid, &vectors.directions(), goal_m, stride)
        })
        .collect()
}

/// The homing vectors to one snapshot.
#[derive(Clone, Debug, PartialEq)]
pub struct Vectors {
    /// By position of the grid, in units of the surroundings' distance: where a robot goes that
    /// follows them by its own north, which may be wrong.
    pub moves: Field,
    /// How far each can be trusted, as the method says.
    pub qualities: Vec<f32>,
}

impl Vectors {
    /// Not one, at so many positions.
    pub(super) fn none(positions: usize) -> Self {
        Self {
            moves: vec![None; positions],
            qualities: vec![0.0; positions],
        }
    }

    /// Unit vectors.
    pub fn directions(&self) -> Field {
        let unit = |[x, y]: [f32; 2]| {
            let length = libm::hypotf(x, y);
            (length > 0.0).then(|| [x / length, y / length])
        };
        self.moves.iter().map(|vector| unit((*vector)?)).collect()
    }
}

/// The homing vectors to each snapshot by a method with these settings.
pub fn vectors_with(survey: &Survey, settings: &Settings) -> Vec<Vectors> {
    match settings {
        Settings::Fourier(parameters) => vectors(survey, &Fourier::new(*parameters)),
        Settings::Search(parameters) => search_vectors::vectors(survey, &Search::new(*parameters)),
        Settings::Mfdid(parameters) => vectors(survey, &Mfdid::new(*parameters)),
        Settings::Warp(parameters) => vectors(survey, &WarpSearch::new(*parameters)),
    }
}

/// The homing vectors to each snapshot.
pub fn vectors<M: HomingMethod>(survey: &Survey, method: &M) -> Vec<Vectors> {
    let memories: Vec<_> = survey
        .goals
        .iter()
        .map(|goal| method.remember(&goal.view))
        .collect();
    let mut found = vec![Vectors::none(survey.currents.len()); memories.len()];
    for (index, current) in survey.currents.iter().enumerate() {
        let Some(current) = current else {
            continue;
        };
        let seen = method.see(&current.view);
        for (found, memory) in found.iter_mut().zip(&memories) {
            if let Ok(way) = method.home(&seen, memory) {
                found.moves[index] = Some(by_its_north(current, &way));
                found.qualities[index] = way.quality;
            }
        }
    }
    found
}

/// A vector in the frame of the place.
pub(super) fn by_its_north(current: &Current, way: &Homeward) -> [f32; 2] {
    let [x, y] = [way.displacement.x, way.displacement.y];
    let (sin, cos) = (libm::sinf(current.turn_rad), libm::cosf(current.turn_rad));
    [cos * x - sin * y, sin * x + cos * y]
}

/// The best settings of each task on the surveys, by the mean area within 0.5 m. `done` hears how many
/// settings were tried.
pub fn tune(surveys: &[&Survey], tasks: &[Task], done: impl FnMut(usize)) -> Vec<Settings> {
    let candidates = |task: &Task| task.method.candidates(task.bytes, task.heading_deg);
    let choices: Vec<Vec<Settings>> = tasks.iter().map(candidates).collect();
    tune_among(surveys, &choices, done)
}

/// The best settings of each choice, as [`tune`] finds them; of a choice without any there are none.
pub fn tune_among(
    surveys: &[&Survey],
    choices: &[Vec<Settings>],
    done: impl FnMut(usize),
) -> Vec<Settings> {
    let tries: Vec<(usize, Settings)> = choices
        .iter()
        .enumerate()
        .flat_map(|(index, settings)| settings.iter().map(move |settings| (index, *settings)))
        .collect();
    let areas = parallel::map(
        &tries,
        |(choice, settings)| {
            // Where there is nothing to choose, as of what ships.
            if choices[*choice].len() == 1 {
                return 0.0;
            }
            let means = surveys.iter().map(|survey| {
                let areas = areas(survey, settings, TUNING_STRIDE);
                mean(areas.iter().map(|area| area[0]))
            });
            mean(means)
        },
        done,
    );
    let mut best: Vec<Option<(f64, Settings)>> = vec![None; choices.len()];
    for ((choice, settings), area) in tries.iter().zip(areas) {
        let best = &mut best[*choice];
        if best.is_none_or(|(largest, _)| area > largest) {
            *best = Some((area, *settings));
        }
    }
    best.into_iter()
        .flatten()
        .map(|(_, settings)| settings)
        .collect()
}

/// How many settings [`tune`] tries.
pub fn tries(tasks: &[Task]) -> usize {
    let count = |task: &Task| task.method.candidates(task.bytes, task.heading_deg).len();
    tasks.iter().map(count).sum()
}

/// The table's lines of one survey.
pub fn evaluate(
    survey: &Survey,
    tasks: &[Task],
    settings: &[Settings],
    tuned_on: &str,
    done: impl FnMut(usize),
) -> Vec<Row> {
    let pairs: Vec<(&Task, &Settings)> = tasks.iter().zip(settings).collect();
    parallel::map(
        &pairs,
        |(task, settings)| row(survey, task, settings, tuned_on),
        done,
    )
}

fn row(survey: &Survey, task: &Task, settings: &Settings, tuned_on: &str) -> Row {
    let found = vectors_with(survey, settings);
    let goals = survey
        .goals
        .iter()
        .map(|goal| survey.grid.position_m(goal.index));
    let goals: Vec<_> = goals.zip(&found).collect();
    let areas: Vec<Area> = goals
        .iter()
        .map(|(goal_m, vectors)| field::areas_m2(&survey.grid, &vectors.directions(), *goal_m, 1))
        .collect();
    let end_errors_m = goals
        .iter()
        .map(|(goal_m, vectors)| judge::end_error_m(&survey.grid, &vectors.moves, *goal_m));
    let end_errors_m: Vec<f64> = end_errors_m.collect();
    let area_m2 = mean(areas.iter().map(|area| area[0]));
    let snapshots = areas.len();
    let free = survey.grid.free_positions().count();
    Row {
        world: survey.place.clone(),
        method: task.method,
        bytes: task.bytes,
        condition: survey.condition,
        area_m2,
        area25_m2: mean(areas.iter().map(|area| area[1])),
        area_per_byte: area_m2 / f64::from(task.bytes),
        stderr_m2: standard_error(areas.iter().map(|area| area[0])),
        end_error_m: mean(end_errors_m.iter().copied()),
        end_stderr_m: standard_error(end_errors_m.iter().copied()),
        roc: judge::roc(&survey.grid, &goals),
        snapshots,
        tuned_on: match task.method {
            Method::Default => "shipped".to_owned(),
            _ => tuned_on.to_owned(),
        },
        free_m2: free as f64 * survey.grid.cell_m2(),
        settings: in_words(settings),
    }
}

/// Settings in few words.
fn in_words(settings: &Settings) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = match settings {
        Settings::Fourier(p) => write!(
            text,
            "{} x {} bits, k^-{}, {} iterations, {}{:?}, {:?}",
            p.code.frequencies,
            p.code.bits,
            p.power,
            p.iterations,
            if p.next_term { "next term, " } else { "" },
            p.unknowns,
            p.alignment
        ),
        Settings::Search(p) => write!(
            text,
            "to {}, {} frequencies, {} rotations",
            p.farthest, p.low_pass, p.rotations
        ),
        Settings::Mfdid(p) => write!(text, "{} frequencies, {:?}", p.low_pass, p.slope),
        Settings::Warp(p) => write!(
            text,
            "{} x {} bits, range {}, k^-{}, to {}, {} rotations{}",
            p.code.frequencies,
            p.code.bits,
            p.code.range,
            p.power,
            p.farthest,
            p.rotations,
            if p.polish { ", polish" } else { "" }
        ),
    };
    text
}

/// Standard error of the mean.
fn standard_error(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let middle = mean(values.clone());
    let (mut squares, mut count) = (0.0, 0_u32);
    for value in values {
        squares += (value - middle) * (value - middle);
        count += 1;
    }
    let variance = squares / f64::from(count.max(2) - 1);
    (variance / f64::from(count.max(1))).sqrt()
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0_u32);
    for value in values {
        sum += value;
        count += 1;
    }
    sum / f64::from(count.max(1))
}

/// A line with a mean area and its standard error, for tests of what is made of lines.
#[cfg(test)]
pub(crate) fn row_of(
    world: &str,
    method: Method,
    bytes: u8,
    [area_m2, stderr_m2]: [f64; 2],
) -> Row {
    Row {
        world: world.to_owned(),
        method,
        bytes,
        condition: Condition::None,
        area_m2,
        area25_m2: area_m2,
        area_per_byte: area_m2 / f64::from(bytes),
        stderr_m2,
        end_error_m: 0.0,
        end_stderr_m: 0.0,
        roc: None,
        snapshots: 9,
        tuned_on: world.to_owned(),
        free_m2: 46.0,
        settings: String::new(),
    }
}
