//! Catchment areas of methods, and the settings at which they are largest.

use core::fmt::Write as _;

use nav::methods::{Fourier, Homeward, HomingMethod, Mfdid, Search, WarpSearch};
use serde::Serialize;

use super::condition::Condition;
use super::field::{self, Field};
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
    match settings {
        Settings::Fourier(parameters) => by(survey, &Fourier::new(*parameters), stride),
        Settings::Search(parameters) => by(survey, &Search::new(*parameters), stride),
        Settings::Mfdid(parameters) => by(survey, &Mfdid::new(*parameters), stride),
        Settings::Warp(parameters) => by(survey, &WarpSearch::new(*parameters), stride),
    }
}

fn by<M: HomingMethod>(survey: &Survey, method: &M, stride: usize) -> Vec<Area> {
    let fields = fields(survey, method);
    survey
        .goals
        .iter()
        .zip(&fields)
        .map(|(goal, field)| {
            let goal_m = survey.grid.position_m(goal.index);
            field::areas_m2(&survey.grid, field, goal_m, stride)
        })
        .collect()
}

/// The homing vectors to each snapshot.
pub fn fields<M: HomingMethod>(survey: &Survey, method: &M) -> Vec<Field> {
    let memories: Vec<_> = survey
        .goals
        .iter()
        .map(|goal| method.remember(&goal.view))
        .collect();
    let mut fields = vec![vec![None; survey.currents.len()]; memories.len()];
    for (index, current) in survey.currents.iter().enumerate() {
        let Some(current) = current else {
            continue;
        };
        let seen = method.see(&current.view);
        for (field, memory) in fields.iter_mut().zip(&memories) {
            let way = method.home(&seen, memory);
            field[index] = way.ok().and_then(|way| direction(current, &way));
        }
    }
    fields
}

/// Where a robot goes that follows a vector: by its own north, which may be wrong.
fn direction(current: &Current, way: &Homeward) -> Option<[f32; 2]> {
    let [x, y] = [way.displacement.x, way.displacement.y];
    let length = libm::hypotf(x, y);
    if length <= 0.0 {
        return None;
    }
    let (sin, cos) = (libm::sinf(current.turn_rad), libm::cosf(current.turn_rad));
    Some([(cos * x - sin * y) / length, (sin * x + cos * y) / length])
}

/// The best settings of each task on the surveys, by the mean area within 0.5 m. `done` hears how many
/// settings were tried.
pub fn tune(surveys: &[&Survey], tasks: &[Task], done: impl FnMut(usize)) -> Vec<Settings> {
    let tries: Vec<(usize, Settings)> = tasks
        .iter()
        .enumerate()
        .flat_map(|(index, task)| {
            let candidates = task.method.candidates(task.bytes, task.heading_deg);
            candidates
                .into_iter()
                .map(move |settings| (index, settings))
        })
        .collect();
    let areas = parallel::map(
        &tries,
        |(task, settings)| {
            // What ships is not chosen here.
            if tasks[*task].method == Method::Default {
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
    let mut best: Vec<Option<(f64, Settings)>> = vec![None; tasks.len()];
    for ((task, settings), area) in tries.iter().zip(areas) {
        let best = &mut best[*task];
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
    let areas = areas(survey, settings, 1);
    let area_m2 = mean(areas.iter().map(|area| area[0]));
    let squares = areas
        .iter()
        .map(|area| (area[0] - area_m2) * (area[0] - area_m2));
    let snapshots = areas.len();
    let variance = squares.sum::<f64>() / (snapshots.max(2) - 1) as f64;
    let free = survey.grid.free_positions().count();
    Row {
        world: survey.place.clone(),
        method: task.method,
        bytes: task.bytes,
        condition: survey.condition,
        area_m2,
        area25_m2: mean(areas.iter().map(|area| area[1])),
        area_per_byte: area_m2 / f64::from(task.bytes),
        stderr_m2: (variance / snapshots.max(1) as f64).sqrt(),
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

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0_u32);
    for value in values {
        sum += value;
        count += 1;
    }
    sum / f64::from(count.max(1))
}
