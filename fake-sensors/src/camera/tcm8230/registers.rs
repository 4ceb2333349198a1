//! The TCM8230MD's register file (data sheet v1.20, register table; application note v1.1).

use super::super::pattern::TestPattern;
use super::super::sensor::{Exposure, ImageTuning, MAX_EXPOSURE_LINES};

/// FPS (bit 7) and flicker detection; effective at vertical sync.
pub const CLOCK: u8 = 0x02;
/// DOUTSW (bit 7, output off), PICSIZ (bits 5..2).
pub const OUTPUT: u8 = 0x03;
/// ALCSW (bit 7, manual) and ESRSPD bits 12..8; effective at vertical sync.
pub const SHUTTER_HIGH: u8 = 0x05;
/// ESRSPD bits 7..0, in scan lines; effective at vertical sync.
pub const SHUTTER_LOW: u8 = 0x06;
/// AG, analogue gain code; effective at vertical sync.
pub const ANALOGUE_GAIN: u8 = 0x07;
/// GAMSW (bit 7): gamma 0.55 off.
pub const GAMMA: u8 = 0x0d;
/// CONT, 0x80 = x1.
pub const CONTRAST: u8 = 0x11;
/// BRIGHT, signed black level in luma counts.
pub const BRIGHTNESS: u8 = 0x12;
/// D_MASK (bits 7..6): frames output black after power-on and after a change of mode; TESPIC (bit 2) and
/// PICSEL (bits 1..0): test pictures; effective at vertical sync.
pub const SYNC: u8 = 0x1e;
/// SLEEPSW (bit 7), SRST (bit 6).
pub const RESET: u8 = 0x1f;
/// DG (bits 5..0), digital gain 1 + DG/64.
pub const DIGITAL_GAIN: u8 = 0x3b;
/// Bit 5: bad pixels are corrected.
pub const BLEMISH: u8 = 0x59;
/// ESROUT, AGOUT, DGOUT, ALCDATA: what the chip reports; not writable.
const READ_ONLY: std::ops::RangeInclusive<u8> = 0x32..=0x38;

/// Analogue gain code of gain 1; the gain is 192/AG.
const UNITY_GAIN_CODE: u8 = 0xc0;
/// Analogue gain code of the highest gain, x16 (+24 dB).
const MAX_GAIN_CODE: u8 = 0x0c;
/// PICSIZ of sub-QCIF with the full field of view: 128 x 96.
const PICSIZ_SUB_QCIF: u8 = 8;

/// Reset values of 0x00..=0x20.
const DEFAULTS_LOW: [u8; 0x21] = [
    0x70, 0x10, 0x40, 0x80, 0x0f, 0x02, 0x0d, 0xc0, 0x38, 0x40, 0x00, 0x40, 0x40, 0x00, 0x2f, 0x04,
    0x22, 0x9a, 0x0c, 0x0a, 0x08, 0x38, 0x38, 0x01, 0x27, 0x04, 0x20, 0x46, 0x9e, 0x83, 0x68, 0x00,
    0x00,
];
/// Reset values of the user registers above 0x20.
const DEFAULTS_HIGH: [(u8, u8); 8] = [
    (0x22, 0x26),
    (0x29, 0x08),
    (0x2a, 0x08),
    (0x3a, 0xcf),
    (0x3b, 0x80),
    (0x3d, 0x17),
    (0x3e, 0x85),
    (BLEMISH, 0x23),
];

/// Analogue gain of register code AG: 192/AG, within x1..x16.
#[must_use]
pub fn gain_of_code(code: u8) -> f32 {
    f32::from(UNITY_GAIN_CODE) / f32::from(code.clamp(MAX_GAIN_CODE, UNITY_GAIN_CODE))
}

/// Nearest register code of an analogue gain, within x1..x16; x1 for what is no number.
#[must_use]
pub fn code_of_gain(gain: f32) -> u8 {
    if gain > 1.0 {
        let code = f32::from(UNITY_GAIN_CODE) / gain + 0.5;
        (code as u8).max(MAX_GAIN_CODE)
    } else {
        UNITY_GAIN_CODE
    }
}

/// 256 bytes as the I2C bus sees them.
#[derive(Clone, Debug)]
pub(super) struct RegisterFile([u8; 256]);

impl Default for RegisterFile {
    fn default() -> Self {
        let mut bytes = [0; 256];
        bytes[..DEFAULTS_LOW.len()].copy_from_slice(&DEFAULTS_LOW);
        for (address, value) in DEFAULTS_HIGH {
            bytes[usize::from(address)] = value;
        }
        Self(bytes)
    }
}

impl RegisterFile {
    pub(super) fn read(&self, address: u8) -> u8 {
        self.0[usize::from(address)]
    }

    /// Writes one register. Read-only registers keep their value; in sleep all but [`RESET`] do.
    /// SRST restores the defaults and clears itself.
    pub(super) fn write(&mut self, address: u8, value: u8) {
        const SRST: u8 = 0x40;
        let locked = address < CLOCK || READ_ONLY.contains(&address);
        if locked || (self.asleep() && address != RESET) {
            return;
        }
        if address == RESET && value & SRST != 0 {
            *self = Self::default();
        } else {
            self.0[usize::from(address)] = value;
        }
    }

    /// ESROUT: the shutter in effect, for whoever reads 0x32 and 0x33.
    pub(super) fn report_shutter(&mut self, lines: u16) {
        let [high, low] = lines.to_be_bytes();
        self.0[0x32] = high;
        self.0[0x33] = low;
    }

    pub(super) fn asleep(&self) -> bool {
        self.read(RESET) & 0x80 != 0
    }

    pub(super) fn output_enabled(&self) -> bool {
        self.read(OUTPUT) & 0x80 == 0 && !self.asleep()
    }

    pub(super) fn masked_frames(&self) -> u8 {
        self.read(SYNC) >> 6
    }

    pub(super) fn latched(&self) -> Latched {
        let lines = u16::from_be_bytes([self.read(SHUTTER_HIGH) & 0x1f, self.read(SHUTTER_LOW)]);
        Latched {
            half_rate: self.read(CLOCK) & 0x80 != 0,
            sub_qcif: (self.read(OUTPUT) >> 2) & 0x0f == PICSIZ_SUB_QCIF,
            lines: lines.clamp(1, MAX_EXPOSURE_LINES),
            gain_code: self.read(ANALOGUE_GAIN),
        }
    }

    pub(super) fn tuning(&self) -> ImageTuning {
        ImageTuning {
            gamma: self.read(GAMMA) & 0x80 == 0,
            contrast: f32::from(self.read(CONTRAST)) / 128.0,
            black_level: f32::from(self.read(BRIGHTNESS).cast_signed()),
            digital_gain: 1.0 + f32::from(self.read(DIGITAL_GAIN) & 0x3f) / 64.0,
            blemish_correction: self.read(BLEMISH) & 0x20 != 0,
            test_pattern: self.test_pattern(),
        }
    }

    fn test_pattern(&self) -> Option<TestPattern> {
        const TESPIC: u8 = 0x04;
        let sync = self.read(SYNC);
        (sync & TESPIC != 0).then_some(match sync & 3 {
            0 => TestPattern::Bars,
            1 => TestPattern::Ramp,
            _ => TestPattern::RampBeforeGamma,
        })
    }
}

/// What the chip takes over from its registers at vertical sync.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Latched {
    /// FPS = 1: the pixel clock is halved.
    pub(super) half_rate: bool,
    /// PICSIZ selects the one size this model draws.
    pub(super) sub_qcif: bool,
    pub(super) lines: u16,
    pub(super) gain_code: u8,
}

impl Latched {
    pub(super) fn exposure(self) -> Exposure {
        Exposure {
            lines: self.lines,
            gain: gain_of_code(self.gain_code),
        }
    }

    /// Whether going from `self` to `next` makes the chip output black frames (D_MASK).
    pub(super) fn changes_mode(self, next: Self) -> bool {
        self.half_rate != next.half_rate || self.sub_qcif != next.sub_qcif
    }
}
