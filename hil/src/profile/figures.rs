//! The figures of a profile. Field names are a promise to scripts.

use std::collections::BTreeMap;

use emulator::core::Cycle;
use serde::Serialize;

use super::frames::{FrameProfile, Frames, Miss};
use super::ledger::{Books, Spent};
use super::stage::Stage;
use super::symbols::Symbols;
use crate::board::timing::TimingModel;
use crate::metrics::quantile;

/// Quantiles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Quantiles<T> {
    /// Median.
    pub p50: T,
    /// Nine in ten are at most this.
    pub p90: T,
    /// 99 in a hundred are.
    pub p99: T,
    /// The largest.
    pub max: T,
    /// Of how many.
    pub count: usize,
}

impl Quantiles<Cycle> {
    /// Of values in any order; zeros where there are none.
    pub fn of(mut values: Vec<Cycle>) -> Self {
        values.sort_unstable();
        let [p50, p90, p99, max] = [0.5, 0.9, 0.99, 1.0].map(|share| quantile(&values, share));
        Self {
            p50,
            p90,
            p99,
            max,
            count: values.len(),
        }
    }

    /// The same in seconds.
    pub fn in_seconds(self, core_hz: u32) -> Quantiles<f64> {
        let seconds = |cycles: Cycle| cycles as f64 / f64::from(core_hz);
        Quantiles {
            p50: seconds(self.p50),
            p90: seconds(self.p90),
            p99: seconds(self.p99),
            max: seconds(self.max),
            count: self.count,
        }
    }
}

/// What one task or interrupt takes of the core.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Load {
    /// Share of all cycles, 0..=1, interruptions not counted.
    pub share: f64,
    /// Polls or entries in a second.
    pub per_s: f64,
}

/// What must be known of modelled figures.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Model {
    /// Where the cycles come from.
    pub source: &'static str,
    /// What is assumed.
    pub assumptions: String,
    /// How far silicon may be from it.
    pub error: &'static str,
}

impl Model {
    /// The emulator's, under these assumptions.
    pub fn emulated(timing: TimingModel) -> Self {
        Self {
            source: "modelled by the emulator, not measured on silicon",
            assumptions: timing.to_string(),
            error: "10 to 15 % on code that computes, 25 % on drivers",
        }
    }
}

/// A flight's profile.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Profile {
    /// Frames that the firmware looked at.
    pub frames: usize,
    /// The core's clock, hertz.
    pub core_hz: u32,
    /// Cycles of each stage over the frames that needed it.
    pub stages: BTreeMap<&'static str, Quantiles<Cycle>>,
    /// Cycles of a frame from horizon to homing vector: the sum of the stages of vision.
    pub vision: Quantiles<Cycle>,
    /// Seconds from a frame's last pixel until its view is there, and from a STATE's last byte to its
    /// answer's first: the wait of the view for the STATE, which comes ten times a second, is left out.
    pub pixel_to_vector_s: Quantiles<f64>,
    /// The second part of these, seconds.
    pub answer_s: Quantiles<f64>,
    /// Seconds left when a frame was done with until the next was complete: the least.
    pub least_margin_s: f64,
    /// Share of cycles in which the core was awake, 0..=1.
    pub load: f64,
    /// By task.
    pub tasks: BTreeMap<String, Load>,
    /// By interrupt, without the tasks that run in it.
    pub interrupts: BTreeMap<String, Load>,
    /// Share of the thread's executor outside tasks.
    pub executor: f64,
    /// How often in a second the core woke.
    pub wakeups_per_s: f64,
    /// Frames that were complete and not looked at before the next was.
    pub missed: usize,
    /// When, and what was running.
    pub misses: Vec<Miss>,
    /// What the figures are worth.
    pub model: Model,
}

impl Profile {
    /// From what was seen.
    pub fn new(
        frames: &Frames,
        misses: Vec<Miss>,
        books: &Books,
        symbols: &Symbols,
        core_hz: u32,
        timing: TimingModel,
    ) -> Self {
        let all = books.all.max(1) as f64;
        let share = |cycles: Cycle| cycles as f64 / all;
        let per_s = |times: u64| times as f64 / all * f64::from(core_hz);
        let load = |spent: &Spent| Load {
            share: share(spent.cycles),
            per_s: per_s(spent.times),
        };
        let seconds = |cycles: &[Cycle]| Quantiles::of(cycles.to_vec()).in_seconds(core_hz);
        let margins = frames.seen.iter().filter_map(|frame| frame.margin);
        let tasks = books.tasks.iter();
        let interrupts = books.exceptions.iter();
        Self {
            frames: frames.seen.len(),
            core_hz,
            stages: Stage::ALL
                .map(|stage| (stage.name(), of_stage(&frames.seen, stage)))
                .into(),
            vision: Quantiles::of(frames.seen.iter().map(FrameProfile::vision).collect()),
            pixel_to_vector_s: seconds(&frames.pixel_to_vector),
            answer_s: seconds(&frames.answer),
            least_margin_s: margins.min().unwrap_or(0) as f64 / f64::from(core_hz),
            load: 1.0 - share(books.idle),
            tasks: tasks
                .map(|(task, spent)| (symbols.tasks()[*task].clone(), load(spent)))
                .collect(),
            interrupts: interrupts
                .map(|(number, spent)| (symbols.exception(*number).to_owned(), load(spent)))
                .collect(),
            executor: share(books.thread),
            wakeups_per_s: per_s(books.wakeups),
            missed: misses.len(),
            misses,
            model: Model::emulated(timing),
        }
    }
}

/// Over the frames that needed the stage.
fn of_stage(frames: &[FrameProfile], stage: Stage) -> Quantiles<Cycle> {
    let cycles = frames
        .iter()
        .filter_map(|frame| frame.stages[stage as usize]);
    Quantiles::of(cycles.collect())
}
