//! The frame engine: which edge of the video port comes next, and what each frame start latches.

use super::super::HEIGHT;
use super::super::sensor::Exposure;
use super::registers::{Latched, RegisterFile};
use super::timing::{ACTIVE_CYCLES, FRAME_CYCLES, line_end_cycles};

/// How many frame starts pass from a shutter or gain write until a frame is exposed with it.
///
/// The registers are taken over at vertical sync, but a rolling shutter integrates frame n+1 while
/// frame n is read out, so the full effect shows on the second frame. The data sheet is silent;
/// the other values serve tests of an exposure controller's robustness.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ExposureLatency {
    /// The frame that starts at the latching sync.
    One,
    /// The frame after that.
    #[default]
    Two,
    /// The third.
    Three,
}

/// A change on the video port.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// VD rises. Frames are numbered from 0 in the order they are put out, across resets.
    FrameStart {
        /// The number of the frame that starts.
        number: u32,
    },
    /// The last byte of image line 0..96 has been clocked out.
    Line(usize),
    /// VD falls.
    FrameEnd,
}

/// Where the frame engine stands. Times are EXTCLK cycles.
#[derive(Clone, Debug)]
pub(super) struct Engine {
    /// When the current frame started, or the next will (`Step::Start`).
    frame_start: u64,
    step: Step,
    latched: Latched,
    /// Exposures latched at the last frame starts, newest first.
    exposures: [Exposure; 3],
    latency: ExposureLatency,
    /// Frames have been coming out without a break.
    streaming: bool,
    next_number: u32,
    black_frames_left: u8,
    black: bool,
}

/// The engine's next edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Step {
    Start,
    Line(usize),
    End,
}

impl Engine {
    /// An engine whose first frame starts at cycle 0, with `latched` in effect since long ago.
    pub(super) fn new(latched: Latched, latency: ExposureLatency) -> Self {
        Self {
            frame_start: 0,
            step: Step::Start,
            latched,
            exposures: [latched.exposure(); 3],
            latency,
            streaming: false,
            next_number: 0,
            black_frames_left: 0,
            black: false,
        }
    }

    /// The engine after a reset: registers and phase are new, the count of frames goes on.
    pub(super) fn restarted(&self, latched: Latched, frame_start: u64) -> Self {
        Self {
            frame_start,
            next_number: self.next_number,
            ..Self::new(latched, self.latency)
        }
    }

    /// No frame has begun: the next edge is a frame start.
    pub(super) fn between_frames(&self) -> bool {
        self.step == Step::Start
    }

    /// When the next edge is due.
    pub(super) fn next_cycle(&self) -> u64 {
        let offset = match self.step {
            Step::Start => 0,
            Step::Line(line) => line_end_cycles(line),
            Step::End => ACTIVE_CYCLES,
        };
        self.frame_start + offset * self.scale()
    }

    /// Performs the next edge.
    pub(super) fn step(&mut self, registers: &RegisterFile) -> Edge {
        match self.step {
            Step::Start => self.start_frame(registers),
            Step::Line(line) => {
                let last = line + 1 == HEIGHT;
                self.step = if last {
                    Step::End
                } else {
                    Step::Line(line + 1)
                };
                Edge::Line(line)
            }
            Step::End => {
                self.go_to_next_frame();
                Edge::FrameEnd
            }
        }
    }

    /// Passes a frame with the output off.
    pub(super) fn skip_frame(&mut self, registers: &RegisterFile) {
        self.latch(registers);
        self.go_to_next_frame();
    }

    /// The output goes off: a frame in progress ends here.
    pub(super) fn break_off(&mut self) {
        self.streaming = false;
        if self.step != Step::Start {
            self.go_to_next_frame();
        }
    }

    /// The exposure of the current frame.
    pub(super) fn exposure(&self) -> Exposure {
        self.exposures[self.latency as usize]
    }

    /// Whether the current frame is masked.
    pub(super) fn black(&self) -> bool {
        self.black
    }

    fn start_frame(&mut self, registers: &RegisterFile) -> Edge {
        self.latch(registers);
        if !self.streaming {
            self.streaming = true;
            self.black_frames_left = registers.masked_frames();
        }
        self.black = self.black_frames_left > 0;
        self.black_frames_left = self.black_frames_left.saturating_sub(1);
        let number = self.next_number;
        self.next_number = number.wrapping_add(1);
        self.step = Step::Line(0);
        Edge::FrameStart { number }
    }

    /// Vertical sync: the registers take effect.
    fn latch(&mut self, registers: &RegisterFile) {
        let next = registers.latched();
        if self.latched.changes_mode(next) {
            self.black_frames_left = registers.masked_frames();
        }
        self.latched = next;
        self.exposures.rotate_right(1);
        self.exposures[0] = next.exposure();
    }

    fn go_to_next_frame(&mut self) {
        self.frame_start += FRAME_CYCLES * self.scale();
        self.step = Step::Start;
    }

    /// What EXTCLK is divided by before the timing of full rate holds.
    pub(super) fn clock_divider(&self) -> u32 {
        1 + u32::from(self.latched.half_rate)
    }

    /// FPS = 1 halves the pixel clock: everything takes twice as many EXTCLK cycles.
    fn scale(&self) -> u64 {
        u64::from(self.clock_divider())
    }
}
