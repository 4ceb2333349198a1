//! The faults, and how each is injected.

use std::fmt;

use clap::ValueEnum;
use emulator::time::Nanos;
use fake_sensors::camera::{HEIGHT, LINE_BYTES};

use super::bench::{Bench, BenchError};
use crate::board::sabotage::Sabotage;

/// How far into a frame the phases of a fault are apart; the last begins with 14 lines to come.
const PHASE_STEP: Nanos = Nanos(4_400_000);
const FIRST_PHASE: Nanos = Nanos::from_millis(2);
/// Longer than any time-out of the firmware's.
const LONG: Nanos = Nanos::from_millis(500);
/// Shorter than all of them.
const BRIEF: Nanos = Nanos::from_millis(1);
/// The time of some twenty lines.
const SOME_LINES: Nanos = Nanos::from_millis(5);
/// The time of a frame.
const A_FRAME: Nanos = Nanos::from_millis(39);

/// The lines that are tampered with, by phase.
const FIRST_LINE: usize = 4;
const LINE_STEP: usize = 11;
/// The last line of a frame.
const LAST_LINE: usize = HEIGHT - 1;
/// From a line that loses bytes to the one that wins them.
const SLIP_LINES: usize = 10;
/// The bytes of one synchronisation code at each end of a line.
const CODES: usize = 8;

/// DMA2 stream 1 empties the camera interface.
const CAMERA_DMA: (u8, u8) = (2, 1);

/// A fault of the camera's wires, or of the way from the interface to memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum CameraFault {
    /// VSYNC stays low for one frame
    LostVsync,
    /// VSYNC stays low for half a second, and returns within a frame
    LostVsyncLong,
    /// VSYNC stays high through a blanking, so that two frames run together
    StuckVsync,
    /// VSYNC falls for a millisecond within a frame
    VsyncGlitch,
    /// HSYNC stays low for half a second
    LostHsync,
    /// A line ends two pixels early
    ShortLine,
    /// A line ends one byte early
    ShortByByte,
    /// The last line ends two pixels early
    ShortLastLine,
    /// A line is not framed at all
    MissingLine,
    /// A line brings eight bytes too many
    ExtraBytes,
    /// Every line brings synchronisation codes for half a second
    CodesOn,
    /// A line brings one byte too many
    ExtraByte,
    /// The last line brings one byte too many
    ExtraLastByte,
    /// A line loses two pixels and a later one of the same frame wins two
    ShiftedLines,
    /// The bus is taken from the DMA for a millisecond
    Overrun,
    /// The bus refuses the DMA a transfer
    DmaError,
    /// The same between two frames, when no data come
    DmaErrorBetween,
    /// The sensor's clock stops for five milliseconds within a frame
    StoppedClock,
    /// The sensor's clock stops for half a second within a frame
    StoppedClockLong,
    /// The camera is pulled out for half a second
    Unplugged,
    /// The camera's plug loses contact for a millisecond
    UnpluggedBriefly,
}

/// Where in a frame a fault strikes, and with that how the signal's return meets the firmware's
/// time-outs: one of [`Phase::ALL`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Phase(u8);

impl Phase {
    /// All of them, from the frame's first lines to its last.
    pub const ALL: [Self; 8] = {
        let mut all = [Self(0); 8];
        let mut index = 0;
        while index < all.len() {
            all[index] = Self(index as u8);
            index += 1;
        }
        all
    };
    /// In the middle of the frame.
    pub const MIDDLE: Self = Self(4);

    fn time(self) -> Nanos {
        FIRST_PHASE + Nanos(PHASE_STEP.0 * u64::from(self.0))
    }

    fn line(self) -> usize {
        FIRST_LINE + LINE_STEP * usize::from(self.0)
    }
}

impl CameraFault {
    /// Injects it into a healthy board. When it began, and when the signal was back.
    pub fn inject(self, bench: &mut Bench<'_>, phase: Phase) -> Result<(Nanos, Nanos), BenchError> {
        let line = phase.line();
        let long = LONG + phase.time();
        let mut in_frame = |sabotage, time| within_frame(bench, phase, sabotage, time);
        match self {
            Self::LostVsync => over_a_frame(bench, Sabotage::VsyncLow),
            Self::LostVsyncLong => in_frame(Sabotage::VsyncLow, long),
            Self::StuckVsync => in_frame(Sabotage::VsyncHigh, A_FRAME),
            Self::VsyncGlitch => in_frame(Sabotage::VsyncLow, BRIEF),
            Self::LostHsync => in_frame(Sabotage::HsyncLow, long),
            Self::ShortLine => over_a_frame(bench, one_line(line, LINE_BYTES - 4)),
            Self::ShortByByte => over_a_frame(bench, one_line(line, LINE_BYTES - 1)),
            Self::ShortLastLine => over_a_frame(bench, one_line(LAST_LINE, LINE_BYTES - 4)),
            Self::MissingLine => over_a_frame(bench, one_line(line, 0)),
            Self::ExtraBytes => over_a_frame(bench, one_line(line, LINE_BYTES + CODES)),
            Self::CodesOn => in_frame(every_line(LINE_BYTES + CODES), long),
            Self::ExtraByte => over_a_frame(bench, one_line(line, LINE_BYTES + 1)),
            Self::ExtraLastByte => over_a_frame(bench, one_line(LAST_LINE, LINE_BYTES + 1)),
            Self::ShiftedLines => over_a_frame(
                bench,
                Sabotage::Slip {
                    loses: line,
                    wins: line + SLIP_LINES,
                    bytes: 4,
                },
            ),
            Self::Overrun => starve(bench, phase),
            Self::DmaError => {
                bench.run_into_frame(phase.time())?;
                Ok(refuse(bench))
            }
            Self::DmaErrorBetween => {
                bench.run_into_blanking()?;
                Ok(refuse(bench))
            }
            Self::StoppedClock => in_frame(Sabotage::ClockStopped, SOME_LINES),
            Self::StoppedClockLong => in_frame(Sabotage::ClockStopped, long),
            Self::Unplugged => in_frame(Sabotage::Unplugged, long),
            Self::UnpluggedBriefly => in_frame(Sabotage::Unplugged, BRIEF),
        }
    }
}

/// Its name on the command line.
impl fmt::Display for CameraFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.to_possible_value() {
            Some(value) => f.write_str(value.get_name()),
            None => fmt::Debug::fmt(self, f),
        }
    }
}

fn one_line(line: usize, bytes: usize) -> Sabotage {
    Sabotage::LineBytes {
        first: line,
        last: line,
        bytes,
    }
}

fn every_line(bytes: usize) -> Sabotage {
    Sabotage::LineBytes {
        first: 0,
        last: usize::MAX,
        bytes,
    }
}

/// From one vertical blanking to the next. Where lines are tampered with, the signal is back after
/// the last of them.
fn over_a_frame(bench: &mut Bench<'_>, sabotage: Sabotage) -> Result<(Nanos, Nanos), BenchError> {
    bench.run_into_blanking()?;
    let from = bench.now();
    bench.tamper(|camera, now| camera.begin(now, sabotage));
    bench.run_into_blanking()?;
    bench.tamper(|camera, now| camera.end(now));
    let struck = bench.camera().line_struck().filter(|at| *at > from);
    Ok((from, struck.unwrap_or(bench.now())))
}

/// For some time from the phase of a frame on.
fn within_frame(
    bench: &mut Bench<'_>,
    phase: Phase,
    sabotage: Sabotage,
    time: Nanos,
) -> Result<(Nanos, Nanos), BenchError> {
    bench.run_into_frame(phase.time())?;
    let from = bench.now();
    bench.tamper(|camera, now| camera.begin(now, sabotage));
    bench.run_until(from + time)?;
    bench.tamper(|camera, now| camera.end(now));
    Ok((from, bench.now()))
}

fn starve(bench: &mut Bench<'_>, phase: Phase) -> Result<(Nanos, Nanos), BenchError> {
    bench.run_into_frame(phase.time())?;
    let from = bench.now();
    bench.meddle(|machine| machine.stall_dma(CAMERA_DMA.0, true));
    bench.run_until(from + BRIEF)?;
    bench.meddle(|machine| machine.stall_dma(CAMERA_DMA.0, false));
    Ok((from, bench.now()))
}

fn refuse(bench: &mut Bench<'_>) -> (Nanos, Nanos) {
    bench.meddle(|machine| machine.fail_dma(CAMERA_DMA.0, CAMERA_DMA.1));
    (bench.now(), bench.now())
}
