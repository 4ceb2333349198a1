//! The log lines that the rig reads by machine, and the clock they are stamped with.
//!
//! Their formats are an interface: a change here is a change in the rig's log reader.

use core::sync::atomic::{AtomicBool, Ordering};

use embassy_time::{Duration, Instant};

use crate::board::pins;
use crate::capture::Fault;
use crate::counters::COUNTERS;
use crate::{clocks, identity};

defmt::timestamp!("{=u64:us}", timestamp_us());

/// Whether the timer behind `Instant` runs. The HAL logs before it has started it, and the
/// registers of a timer without a clock are not to be read.
static CLOCK_RUNS: AtomicBool = AtomicBool::new(false);

fn timestamp_us() -> u64 {
    if CLOCK_RUNS.load(Ordering::Relaxed) {
        Instant::now().as_micros()
    } else {
        0
    }
}

/// Once, as soon as the HAL is up: which firmware this is, what it may do, on which board, and how fast
/// its cycle counter runs.
pub fn boot() {
    CLOCK_RUNS.store(true, Ordering::Relaxed);
    defmt::info!(
        "cataglyphis {=str} boot, {=str} image for the {=str} board, clock {=u32} Hz",
        env!("CARGO_PKG_VERSION"),
        identity::KIND.name(),
        pins::NAME.name(),
        clocks::CORE_HZ
    );
}

/// Once after boot: whether the pilot goes on where the watchdog stopped it.
pub fn memory(kept: bool) {
    defmt::info!("memory kept {=bool}", kept);
}

/// Once per frame: its number since boot, what it cost in core cycles (interrupts included), the
/// mean luma of its horizon (0 to 255), and the exposure that was asked for last.
pub fn frame(number: u32, cycles: u32, luma: f32, exposure: pilot::Exposure) {
    defmt::debug!(
        "frame {=u32} cycles {=u32} luma {=f32} lines {=u16} gain {=f32}",
        number,
        cycles,
        luma,
        exposure.shutter_lines,
        exposure.gain
    );
}

/// Once per STATE message: what its decision and its answer cost in core cycles, interrupts of the
/// urgent tasks included (those of the link are at work at that time).
pub fn state(cycles: u32) {
    defmt::debug!("state cycles {=u32}", cycles);
}

/// A frame from the autopilot that was not acted on: the message its header states and the reason,
/// see `link::Refused`. Bounded by the caller; [`health`] counts all.
pub fn link_dropped(message: &str, why: &str) {
    defmt::warn!("link dropped {=str} {=str}", message, why);
}

/// What the navigator did: a snapshot taken, a leg begun, an arrival, a realignment.
pub fn event(event: &pilot::Event) {
    defmt::info!("{}", event);
}

/// The log of the capture's faults.
pub struct CaptureFaults {
    /// When each was told last.
    told: [Option<Instant>; Fault::ALL.len()],
}

impl CaptureFaults {
    /// Least time between two lines of one name: a broken cable makes 25 faults a second. [`health`]
    /// counts all.
    const PERIOD: Duration = Duration::from_secs(1);

    /// Nothing was told yet.
    pub const fn new() -> Self {
        Self {
            told: [None; Fault::ALL.len()],
        }
    }

    /// Once per fault, but no more often than once a second for each name.
    pub fn tell(&mut self, fault: Fault) {
        let told = &mut self.told[fault as usize];
        if told.is_none_or(|last| last.elapsed() >= Self::PERIOD) {
            *told = Some(Instant::now());
            defmt::warn!("capture fault {=str}", fault.name());
        }
    }
}

/// Once a second: the counts since boot.
pub fn health() {
    let c = &COUNTERS;
    defmt::info!(
        "health frames {=u32} missed {=u32} torn {=u32} link ok {=u32} bad {=u32} tx dropped {=u32}",
        c.frames.get(),
        c.frames_missed.get(),
        c.frames_torn.get(),
        c.link_ok.get(),
        c.link_bad.get(),
        c.tx_dropped.get()
    );
    defmt::info!(
        "faults sensor {=u32} uart {=u32} queue {=u32}",
        c.sensor_faults.get(),
        c.uart_errors.get(),
        c.queue_full.get()
    );
    for fault in Fault::ALL {
        let count = c.capture(fault).get();
        if count > 0 {
            defmt::info!("capture faults {=str} {=u32}", fault.name(), count);
        }
    }
}

/// Once a second while a host sends frames over serial: what became of them since boot.
#[cfg(feature = "rig")]
pub fn serial_frames(counts: frames::Counts) {
    defmt::info!(
        "serial frames whole {=u32} torn {=u32} late {=u32} repeated {=u32} busy {=u32} corrupt records {=u32}",
        counts.whole,
        counts.torn,
        counts.late,
        counts.repeated,
        counts.busy,
        counts.corrupt
    );
}

/// When a host takes the camera's place, or gives it back.
#[cfg(feature = "rig")]
pub fn source(source: frames::Source) {
    match source {
        frames::Source::Camera => defmt::info!("frames come from the camera"),
        frames::Source::Serial => defmt::info!("frames come over serial"),
    }
}
