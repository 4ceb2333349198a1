//! Oscillators and PLLs: switched on, and ready some time later.

use crate::time::Nanos;

/// The internal oscillator (DS8626 table 33, typical).
pub const HSI_STARTUP: Nanos = Nanos(2_200);
/// The crystal (DS8626 table 31, typical).
pub const HSE_STARTUP: Nanos = Nanos(2_000_000);
/// A PLL's lock at a VCO of 192 MHz (DS8626 table 36, maximum).
pub const PLL_STARTUP: Nanos = Nanos(200_000);
/// The low-speed internal oscillator (DS8626 table 34, typical).
pub const LSI_STARTUP: Nanos = Nanos(15_000);
/// The low-speed crystal (DS8626 table 32, typical).
pub const LSE_STARTUP: Nanos = Nanos(2_000_000_000);

/// An oscillator or PLL: on, and when it is ready.
#[derive(Clone, Copy, Debug, Default)]
pub struct Source {
    /// Switched on.
    pub on: bool,
    /// From when on it can be used.
    pub ready_at: Nanos,
}

impl Source {
    /// Switches it; it is ready `startup` after it was switched on.
    pub fn switch(&mut self, on: bool, now: Nanos, startup: Nanos) {
        if on && !self.on {
            self.ready_at = now + startup;
        }
        self.on = on;
    }

    /// Whether it can be used.
    pub fn ready(&self, now: Nanos) -> bool {
        self.on && now >= self.ready_at
    }

    /// The ON bit, at `on_bit`, and the RDY bit above it.
    pub fn bits(&self, now: Nanos, on_bit: u32) -> u32 {
        (u32::from(self.on) | u32::from(self.ready(now)) << 1) << on_bit
    }
}
