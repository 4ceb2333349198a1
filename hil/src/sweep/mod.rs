//! Many flights of one scenario: flown on every processor, summed up, shared out over machines and put together
//! again.
//!
//! ```text
//! scenario file + seeds -> figures of each flight -> statistics -> verdicts
//!                              |         ^
//!                              +- shard -+        a flight that failed -> folder -> replay
//! ```

mod figures;
mod outcome;
mod replay;
mod shard;

use crate::flight::{self, FlightError, Flown, Progress};
use crate::parallel;
use crate::scenario::Scenario;

pub use figures::{FlightFigures, HOME_RADIUS_M, Quantiles, Statistics, csv};
pub use outcome::Outcome;
pub use replay::{Replay, ReplayError, write_failed};
pub use shard::{Flights, MergeError, Part, ShardError, VERSION, merge};

/// What a flight is flown on.
#[derive(Clone, Copy, Debug)]
pub enum Vessel<'i> {
    /// The firmware's logic compiled for this machine.
    Native,
    /// This image, an ELF file, on an emulated board.
    Emulator(&'i [u8]),
}

impl Vessel<'_> {
    /// Flies a scenario.
    ///
    /// # Errors
    /// [`FlightError`] where it cannot be flown.
    pub fn fly(
        &self,
        scenario: &Scenario,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<Flown, FlightError> {
        match self {
            Self::Native => flight::fly_native(scenario, progress),
            Self::Emulator(elf) => flight::fly_emulated(scenario, elf, progress),
        }
    }
}

/// Flies every seed, one flight a processor at a time, and gives the figures in the order of the seeds: they do not
/// depend on how the flights are shared out. `look` sees each flight when it has ended, on any thread; `done` hears how
/// many have.
///
/// # Errors
/// What `scenario`, the first flight that could not be flown, or `look` says.
pub fn fly_each<Failure: From<FlightError> + Send>(
    seeds: &[u64],
    vessel: Vessel,
    scenario: impl Fn(u64) -> Result<Scenario, FlightError> + Sync,
    look: impl Fn(&Flown, &FlightFigures) -> Result<(), Failure> + Sync,
    done: impl FnMut(usize),
) -> Result<Vec<FlightFigures>, Failure> {
    let one = |seed: &u64| {
        let flown = vessel.fly(&scenario(*seed)?, &mut |_| ())?;
        let figures = FlightFigures::of(&flown.summary);
        look(&flown, &figures)?;
        Ok(figures)
    };
    parallel::map(seeds, one, done).into_iter().collect()
}
