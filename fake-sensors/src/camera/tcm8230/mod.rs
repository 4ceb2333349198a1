//! The Toshiba TCM8230MD as the board sees it: a register file behind I2C, and a frame engine that
//! free-runs from the release of reset (data sheet v1.20, application note v1.1).
//!
//! The model owns no clock and no thread. Whoever holds it calls with the current time in
//! nanoseconds, never backwards, and takes each edge when it is due, before any later call.
//!
//! Not modelled: automatic exposure (ALCSW = 0 keeps the shutter and gain registers), long
//! exposure modes, image sizes other than 128 x 96, test patterns, embedded synchronisation codes.

mod registers;
mod timing;

pub use registers::{
    ANALOGUE_GAIN, BRIGHTNESS, CLOCK, CONTRAST, DIGITAL_GAIN, GAMMA, OUTPUT, RESET, SHUTTER_HIGH,
    SHUTTER_LOW, SYNC, code_of_gain, gain_of_code,
};
pub use timing::{
    exposure_line_ns, frame_active_ns, frame_period_ns, line_burst_ns, line_offset_ns, line_slot,
};

use super::HEIGHT;
use super::sensor::{Exposure, ImageTuning};
use registers::{Latched, RegisterFile};
use timing::{ACTIVE_CYCLES, FRAME_CYCLES, cycles_to_ns, line_end_cycles, ns_to_cycles};

/// The chip's 7-bit I2C address.
pub const I2C_ADDRESS: u8 = 0x3c;
/// EXTCLK cycles for which reset must be held low to take (data sheet, power-up sequence).
pub const RESET_CYCLES: u64 = 100;
/// EXTCLK cycles from the release of reset until the chip answers on I2C (data sheet).
pub const STARTUP_CYCLES: u64 = 2_000;
/// Slowest EXTCLK at which a chip has been seen to answer on I2C, in hertz. The data sheet asks
/// for 11.9 MHz.
pub const MIN_I2C_EXTCLK_HZ: u32 = 6_250_000;

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

/// The image sensor: registers, bus and frame engine.
#[derive(Clone, Debug)]
pub struct Tcm8230 {
    registers: RegisterFile,
    clock: Clock,
    power: Power,
    bus: Bus,
    engine: Engine,
}

/// EXTCLK as counted by the chip.
#[derive(Clone, Copy, Debug, Default)]
struct Clock {
    hz: Option<u32>,
    since_ns: u64,
    cycles_before: u64,
}

impl Clock {
    fn cycles(&self, now_ns: u64) -> u64 {
        let elapsed_ns = now_ns.saturating_sub(self.since_ns);
        self.cycles_before + self.hz.map_or(0, |hz| ns_to_cycles(elapsed_ns, hz))
    }

    fn time_ns(&self, cycles: u64) -> Option<u64> {
        let ahead = cycles.saturating_sub(self.cycles_before);
        self.hz.map(|hz| self.since_ns + cycles_to_ns(ahead, hz))
    }
}

/// The reset pin's history, in EXTCLK cycles.
#[derive(Clone, Copy, Debug)]
enum Power {
    /// Held in reset since.
    Held(u64),
    /// Released too early: the chip hangs until the next reset.
    Hung,
    /// Running since.
    Running(u64),
}

/// The I2C slave between start and stop.
#[derive(Clone, Copy, Debug, Default)]
struct Bus {
    selected: bool,
    /// The next byte written is a register address.
    awaits_pointer: bool,
    pointer: u8,
}

/// Where the frame engine stands.
#[derive(Clone, Debug)]
struct Engine {
    /// EXTCLK cycle at which the current frame started, or the next will (`Step::Start`).
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
    fn new(latched: Latched, latency: ExposureLatency) -> Self {
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
    fn restarted(&self, latched: Latched, frame_start: u64) -> Self {
        Self {
            frame_start,
            next_number: self.next_number,
            ..Self::new(latched, self.latency)
        }
    }

    /// FPS = 1 halves the pixel clock: everything takes twice as many EXTCLK cycles.
    fn scale(&self) -> u64 {
        1 + u64::from(self.latched.half_rate)
    }

    fn next_cycle(&self) -> u64 {
        let offset = match self.step {
            Step::Start => 0,
            Step::Line(line) => line_end_cycles(line),
            Step::End => ACTIVE_CYCLES,
        };
        self.frame_start + offset * self.scale()
    }

    fn skip_to_next_frame(&mut self) {
        self.frame_start += FRAME_CYCLES * self.scale();
        self.step = Step::Start;
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
}

impl Default for Tcm8230 {
    fn default() -> Self {
        Self::new(ExposureLatency::default())
    }
}

impl Tcm8230 {
    /// A powered chip in reset, without a clock.
    #[must_use]
    pub fn new(latency: ExposureLatency) -> Self {
        let registers = RegisterFile::default();
        let engine = Engine::new(registers.latched(), latency);
        Self {
            registers,
            clock: Clock::default(),
            power: Power::Held(0),
            bus: Bus::default(),
            engine,
        }
    }

    /// A chip that a driver has brought up: gamma off, manual exposure, the first 128 x 96 frame
    /// (a black one) about to start at `now_ns`. For backends that have no I2C bus.
    #[must_use]
    pub fn streaming(now_ns: u64, extclk_hz: u32, lines: u16, gain: f32) -> Self {
        let mut chip = Self::default();
        chip.set_clock(now_ns, Some(extclk_hz));
        for (address, value) in [(SYNC, 0x48), (GAMMA, 0x80), (OUTPUT, 0x20)] {
            chip.write_register(now_ns, address, value);
        }
        chip.write_exposure(now_ns, lines, gain);
        chip.engine.latched = chip.registers.latched();
        chip.engine.exposures = [chip.engine.latched.exposure(); 3];
        chip.power = Power::Running(0);
        chip
    }

    /// EXTCLK changes its frequency, or stops (`None`); the frame in progress stretches with it.
    pub fn set_clock(&mut self, now_ns: u64, hz: Option<u32>) {
        self.advance(now_ns);
        self.clock = Clock {
            cycles_before: self.clock.cycles(now_ns),
            since_ns: now_ns,
            hz: hz.filter(|&hz| hz > 0),
        };
    }

    /// The RESET pin changes its level (active low).
    pub fn set_reset(&mut self, now_ns: u64, high: bool) {
        self.advance(now_ns);
        let cycle = self.clock.cycles(now_ns);
        self.power = match (self.power, high) {
            (Power::Held(since), true) if cycle - since < RESET_CYCLES => Power::Hung,
            (Power::Held(_), true) => Power::Running(cycle),
            (Power::Hung | Power::Running(_), false) => Power::Held(cycle),
            (unchanged, _) => unchanged,
        };
        self.bus = Bus::default();
        if let Power::Held(_) | Power::Running(_) = self.power {
            self.registers = RegisterFile::default();
            self.engine = self.engine.restarted(self.registers.latched(), cycle);
        }
    }

    /// A start or repeated start with an address. True: acknowledged.
    pub fn i2c_start(&mut self, now_ns: u64, address: u8, read: bool) -> bool {
        self.bus.selected = address == I2C_ADDRESS && self.answers(now_ns);
        self.bus.awaits_pointer = !read;
        self.bus.selected
    }

    /// A byte from the master: a register address first, then values for that register and those
    /// after it. True: acknowledged.
    pub fn i2c_write(&mut self, now_ns: u64, byte: u8) -> bool {
        if !self.bus.selected || !self.answers(now_ns) {
            return false;
        }
        if self.bus.awaits_pointer {
            self.bus.pointer = byte;
            self.bus.awaits_pointer = false;
        } else {
            self.write_register(now_ns, self.bus.pointer, byte);
            self.bus.pointer = self.bus.pointer.wrapping_add(1);
        }
        true
    }

    /// A byte for the master: the register at the pointer, which moves on. 0xff if not selected.
    pub fn i2c_read(&mut self, now_ns: u64) -> u8 {
        if !self.bus.selected || !self.answers(now_ns) {
            return 0xff;
        }
        let value = self.registers.read(self.bus.pointer);
        self.bus.pointer = self.bus.pointer.wrapping_add(1);
        value
    }

    /// A stop condition.
    pub fn i2c_stop(&mut self, _now_ns: u64) {
        self.bus.selected = false;
    }

    /// Writes one register as a bus transfer that ends at `now_ns` would.
    pub fn write_register(&mut self, now_ns: u64, address: u8, value: u8) {
        self.advance(now_ns);
        self.registers.write(address, value);
        if !self.registers.output_enabled() {
            self.engine.streaming = false;
            if self.engine.step != Step::Start {
                self.engine.skip_to_next_frame();
            }
        }
    }

    /// Writes shutter and analogue gain as one burst to 0x05..=0x07 would, in manual mode:
    /// latched at the next frame start. `lines` is cut to 1..=525, `gain` to the steps of 192/AG.
    pub fn write_exposure(&mut self, now_ns: u64, lines: u16, gain: f32) {
        const MANUAL: u8 = 0x80;
        let [high, low] = lines
            .clamp(1, super::sensor::MAX_EXPOSURE_LINES)
            .to_be_bytes();
        self.write_register(now_ns, SHUTTER_HIGH, MANUAL | high);
        self.write_register(now_ns, SHUTTER_LOW, low);
        self.write_register(now_ns, ANALOGUE_GAIN, code_of_gain(gain));
    }

    /// When the video port has its next edge; `None` while it is silent. May change after any call
    /// that takes `now_ns`.
    #[must_use]
    pub fn next_edge(&self) -> Option<u64> {
        let running = matches!(self.power, Power::Running(_));
        if !running || (self.engine.step == Step::Start && !self.draws_next_frame()) {
            return None;
        }
        self.clock.time_ns(self.engine.next_cycle())
    }

    /// Performs the edge that is due at `now_ns` = [`next_edge`](Self::next_edge). `None` if none
    /// is due.
    pub fn take_edge(&mut self, now_ns: u64) -> Option<Edge> {
        self.next_edge().filter(|&due_ns| due_ns <= now_ns)?;
        let edge = match self.engine.step {
            Step::Start => {
                let edge = self.engine.start_frame(&self.registers);
                self.registers.report_shutter(self.exposure().lines);
                edge
            }
            Step::Line(line) => {
                self.engine.step = if line + 1 < HEIGHT {
                    Step::Line(line + 1)
                } else {
                    Step::End
                };
                Edge::Line(line)
            }
            Step::End => {
                self.engine.skip_to_next_frame();
                Edge::FrameEnd
            }
        };
        Some(edge)
    }

    /// The exposure of the current frame.
    #[must_use]
    pub fn exposure(&self) -> Exposure {
        self.engine.exposures[self.engine.latency as usize]
    }

    /// The image tuning registers, which take effect at once.
    #[must_use]
    pub fn tuning(&self) -> ImageTuning {
        self.registers.tuning()
    }

    /// Whether the current frame is put out black: the first after the output was switched on or
    /// the mode was changed (D_MASK).
    #[must_use]
    pub fn black(&self) -> bool {
        self.engine.black
    }

    /// Passes the frame starts up to `now_ns` that nobody sees.
    fn advance(&mut self, now_ns: u64) {
        if !matches!(self.power, Power::Running(_)) {
            return;
        }
        let now = self.clock.cycles(now_ns);
        while self.engine.step == Step::Start
            && !self.draws_next_frame()
            && self.engine.frame_start <= now
        {
            self.engine.latch(&self.registers);
            self.engine.streaming = false;
            self.engine.skip_to_next_frame();
        }
    }

    fn draws_next_frame(&self) -> bool {
        self.registers.output_enabled() && self.registers.latched().sub_qcif
    }

    fn answers(&self, now_ns: u64) -> bool {
        let clocked = self.clock.hz.is_some_and(|hz| hz >= MIN_I2C_EXTCLK_HZ);
        let started = |since| self.clock.cycles(now_ns) - since >= STARTUP_CYCLES;
        clocked && matches!(self.power, Power::Running(since) if started(since))
    }
}

#[cfg(test)]
mod tests;
