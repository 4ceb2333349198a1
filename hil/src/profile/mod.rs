//! Where the cycles of a flight go: from outside, by the emulated core's counter at the functions of
//! the image. Nothing is added to the firmware, and its flight is the same to the byte.

pub mod chrome;
mod figures;
pub mod flame;
mod frames;
mod functions;
pub mod histograms;
mod inlined;
mod ledger;
mod profiler;
mod stacks;
mod stage;
mod symbols;
mod timeline;
pub mod timing_diagram;
mod wires;

use crate::board::emulated::Firmware;
use crate::board::timing::TimingModel;
use crate::flight::{self, FlightError, Flown, Progress};
use crate::scenario::Scenario;

pub use figures::{Load, Model, Profile, Quantiles};
pub use frames::{FrameProfile, Miss};
pub use functions::FunctionProfiler;
pub use profiler::Profiler;
pub use stacks::Stacks;
pub use stage::Stage;
pub use symbols::{Function, Symbols};
pub use timeline::{Timeline, Window};

/// A flight with its profile.
#[derive(Clone, Debug)]
pub struct Profiled {
    /// The flight.
    pub flown: Flown,
    /// Over all frames.
    pub profile: Profile,
    /// Frame by frame.
    pub frames: Vec<FrameProfile>,
    /// The time line of the window that was asked for.
    pub timeline: Option<Timeline>,
}

/// Flies a scenario on the emulated board and profiles it; draws up the time line of a window.
pub fn fly(
    scenario: &Scenario,
    elf: &[u8],
    timing: TimingModel,
    window: Option<Window>,
    progress: &mut dyn FnMut(Progress),
) -> Result<Profiled, FlightError> {
    let firmware = firmware(scenario, elf, timing)?;
    let mut profiler = Profiler::new(timing, window);
    let flown = flight::fly_watched(scenario, &firmware, &mut profiler, progress)?;
    let (profile, frames, timeline) = profiler.finish();
    Ok(Profiled {
        flown,
        profile,
        frames,
        timeline,
    })
}

/// Flies a scenario instruction by instruction: cycles by function and by who called it.
pub fn fly_by_function(
    scenario: &Scenario,
    elf: &[u8],
    timing: TimingModel,
    progress: &mut dyn FnMut(Progress),
) -> Result<(Flown, Stacks), FlightError> {
    let firmware = firmware(scenario, elf, timing)?;
    let mut profiler = FunctionProfiler::default();
    let flown = flight::fly_watched(scenario, &firmware, &mut profiler, progress)?;
    Ok((flown, profiler.finish(elf)?))
}

fn firmware(scenario: &Scenario, elf: &[u8], timing: TimingModel) -> Result<Firmware, FlightError> {
    let firmware = Firmware::parse(elf)?.with_lens(scenario.conditions.lens);
    Ok(firmware.with_timing(timing))
}
