//! The Toshiba TCM8230MD as the board sees it: a register file behind I2C, and a frame engine that
//! free-runs from the release of reset (data sheet v1.20, application note v1.1).
//!
//! The model owns no clock and no thread. Whoever holds it calls with the current time in
//! nanoseconds, never backwards, and takes each edge when it is due, before any later call.
//!
//! Not modelled: automatic exposure (ALCSW = 0 keeps the shutter and gain registers), long
//! exposure modes, image sizes other than 128 x 96, embedded synchronisation codes.

mod engine;
mod registers;
mod timing;

pub use engine::{Edge, ExposureLatency};
pub use registers::{
    ANALOGUE_GAIN, BLEMISH, BRIGHTNESS, CLOCK, CONTRAST, DIGITAL_GAIN, GAMMA, OUTPUT, RESET,
    SHUTTER_HIGH, SHUTTER_LOW, SYNC, code_of_gain, gain_of_code,
};
pub use timing::{
    exposure_line_ns, frame_active_ns, frame_period_ns, line_burst_ns, line_offset_ns, line_slot,
};

use super::sensor::{Exposure, ImageTuning, MAX_EXPOSURE_LINES};
use engine::Engine;
use registers::RegisterFile;
use timing::{cycles_to_ns, ns_to_cycles};

/// The chip's 7-bit I2C address.
pub const I2C_ADDRESS: u8 = 0x3c;
/// EXTCLK cycles for which reset must be held low to take (data sheet, power-up sequence).
pub const RESET_CYCLES: u64 = 100;
/// EXTCLK cycles from the release of reset until the chip answers on I2C (data sheet).
pub const STARTUP_CYCLES: u64 = 2_000;
/// Slowest EXTCLK at which a chip has been seen to answer on I2C, in hertz. The data sheet asks
/// for 11.9 MHz.
pub const MIN_I2C_EXTCLK_HZ: u32 = 6_250_000;

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
    /// Held in reset.
    Held { since: u64 },
    /// Released too early: the chip hangs until the next reset.
    Hung,
    /// Out of reset.
    Running { since: u64 },
}

/// The I2C slave between start and stop.
#[derive(Clone, Copy, Debug, Default)]
struct Bus {
    selected: bool,
    /// The next byte written is a register address.
    awaits_pointer: bool,
    pointer: u8,
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
            power: Power::Held { since: 0 },
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
        chip.engine = Engine::new(chip.registers.latched(), ExposureLatency::default());
        chip.power = Power::Running { since: 0 };
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
            (Power::Held { since }, true) if cycle.saturating_sub(since) < RESET_CYCLES => {
                Power::Hung
            }
            (Power::Held { .. }, true) => Power::Running { since: cycle },
            (Power::Hung | Power::Running { .. }, false) => Power::Held { since: cycle },
            (Power::Held { .. }, false) | (Power::Hung | Power::Running { .. }, true) => return,
        };
        self.bus = Bus::default();
        self.registers = RegisterFile::default();
        self.engine = self.engine.restarted(self.registers.latched(), cycle);
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
            self.engine.break_off();
        }
    }

    /// Writes shutter and analogue gain as one burst to 0x05..=0x07 would, in manual mode:
    /// latched at the next frame start. `lines` is cut to 1..=525, `gain` to the steps of 192/AG.
    pub fn write_exposure(&mut self, now_ns: u64, lines: u16, gain: f32) {
        const MANUAL: u8 = 0x80;
        let [high, low] = lines.clamp(1, MAX_EXPOSURE_LINES).to_be_bytes();
        self.write_register(now_ns, SHUTTER_HIGH, MANUAL | high);
        self.write_register(now_ns, SHUTTER_LOW, low);
        self.write_register(now_ns, ANALOGUE_GAIN, code_of_gain(gain));
    }

    /// When the video port has its next edge; `None` while it is silent. May change after any call
    /// that takes `now_ns`.
    #[must_use]
    pub fn next_edge(&self) -> Option<u64> {
        let running = matches!(self.power, Power::Running { .. });
        if !running || (self.engine.between_frames() && !self.draws_next_frame()) {
            return None;
        }
        self.clock.time_ns(self.engine.next_cycle())
    }

    /// Performs the edge that is due at `now_ns` = [`next_edge`](Self::next_edge). `None` if none
    /// is due.
    pub fn take_edge(&mut self, now_ns: u64) -> Option<Edge> {
        self.next_edge().filter(|&due_ns| due_ns <= now_ns)?;
        let edge = self.engine.step(&self.registers);
        if let Edge::FrameStart { .. } = edge {
            self.registers.report_shutter(self.exposure().lines);
        }
        Some(edge)
    }

    /// The exposure of the current frame.
    #[must_use]
    pub fn exposure(&self) -> Exposure {
        self.engine.exposure()
    }

    /// From the start of the current frame to the middle of the exposure of image line `line` (below
    /// [`HEIGHT`](super::HEIGHT)), nanoseconds: a line is exposed until it is read out. Negative where
    /// that was before the frame began.
    #[must_use]
    pub fn mid_exposure_ns(&self, line: usize) -> i64 {
        let hz = self.clock.hz.unwrap_or(MIN_I2C_EXTCLK_HZ) / self.engine.clock_divider();
        let readout_ns = line_offset_ns(line, hz) as i64;
        let exposure_ns = u64::from(self.exposure().lines) * exposure_line_ns(hz);
        readout_ns - exposure_ns as i64 / 2
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
        self.engine.black()
    }

    /// Passes the frame starts up to `now_ns` that nobody sees.
    fn advance(&mut self, now_ns: u64) {
        if !matches!(self.power, Power::Running { .. }) {
            return;
        }
        let now = self.clock.cycles(now_ns);
        while self.engine.between_frames()
            && !self.draws_next_frame()
            && self.engine.next_cycle() <= now
        {
            self.engine.skip_frame(&self.registers);
        }
    }

    fn draws_next_frame(&self) -> bool {
        self.registers.output_enabled() && self.registers.latched().sub_qcif
    }

    fn answers(&self, now_ns: u64) -> bool {
        let clocked = self.clock.hz.is_some_and(|hz| hz >= MIN_I2C_EXTCLK_HZ);
        let started = |since| self.clock.cycles(now_ns).saturating_sub(since) >= STARTUP_CYCLES;
        clocked && matches!(self.power, Power::Running { since } if started(since))
    }
}

#[cfg(test)]
mod tests;
