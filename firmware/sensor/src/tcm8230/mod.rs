//! Toshiba TCM8230MD: 1/6 inch, rolling shutter, 128 x 96 in sub-QCIF.
//!
//! Facts from Toshiba's data sheet v1.20 and application note v1.1 (both 2004).

mod registers;
#[cfg(test)]
mod tests;

use core::time::Duration;

use embedded_hal_async::i2c::{self, ErrorKind, I2c};

use crate::{Error, Geometry, ImageSensor};
use registers::{ADDRESS, Register};

/// The frames it sends: YUV 4:2:2 in the byte order U Y V Y, so luma stands at the odd offsets.
pub const GEOMETRY: Geometry = Geometry {
    width: 128,
    height: 96,
    bytes_per_pixel: 2,
    luma_offset: 1,
};

/// Cycles of EXTCLK in one line: 780 internal pixel clocks, each two cycles at full rate.
const CLOCKS_PER_LINE: u32 = 780 * 2;

/// Lines of one frame, and with that the longest shutter of the normal mode. What a longer value
/// does there is not documented.
const MAX_LINES: u16 = 525;

/// A rolling shutter begins to expose frame n+1 before frame n is read out, so a value latched at
/// the start of n shows in full on the second frame after the write. The data sheet is silent.
const LATENCY_FRAMES: u8 = 2;

/// The first frame after the output came on is masked black (D_MASK = 1), and latches at its start
/// the exposure that was written before it. By [`latency_frames`](ImageSensor::latency_frames)
/// the second shows that exposure in full; it is given up as well, for the data sheet does not say.
pub const SETTLING_FRAMES: u8 = LATENCY_FRAMES;

/// Tries of one transfer before its error counts. A sensor that is between two states may refuse
/// one; a sensor that is absent refuses all, soon.
const TRIES: u8 = 3;

/// What the sensor shows instead of a picture (register 1E: TESPIC, PICSEL).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum TestPattern {
    /// Colour bars.
    Bars = 0,
    /// A ramp that gamma does not bend.
    RampAfterGamma = 1,
    /// A ramp that gamma bends.
    RampBeforeGamma = 2,
}

/// The driver. It owns the bus or a share of it (`embassy-embedded-hal` has shares).
#[derive(Debug)]
pub struct Tcm8230<B> {
    bus: B,
    clock_hz: u32,
}

impl<B: I2c> Tcm8230<B> {
    /// A driver for the sensor on `bus` that is clocked with `clock_hz` (EXTCLK, 11.9 to 25 MHz).
    ///
    /// Before [`probe`](ImageSensor::probe) is called the board sees to the order of the data sheet's
    /// power-on sequence:
    ///
    /// 1. supplies: 1.5 V, then 2.8 V for the pixels, then 2.8 V for the pins, at most 100 ms apart;
    /// 2. EXTCLK, with a duty of 45 to 55 %, while RESET is low, for at least 100 clocks;
    /// 3. RESET high, and at least 2000 clocks before the first transfer, which is refused until then.
    ///
    /// A sensor that was cut off within a transfer may hold the data line: nine clocks free the bus.
    /// After a failed [`init`](ImageSensor::init) begin again with 2.
    pub const fn new(bus: B, clock_hz: u32) -> Self {
        Self { bus, clock_hz }
    }

    async fn write(&mut self, register: Register, value: u8) -> Result<(), Error<B::Error>> {
        self.write_bytes(&[register as u8, value]).await
    }

    /// One transaction: the first register's address, then its value and those of its successors.
    async fn write_bytes(&mut self, bytes: &[u8]) -> Result<(), Error<B::Error>> {
        let mut tries = 1;
        loop {
            match self.bus.write(ADDRESS, bytes).await {
                Ok(()) => return Ok(()),
                Err(error) if tries == TRIES || !is_passing(&error) => {
                    return Err(Error::Bus {
                        register: bytes.first().copied().unwrap_or_default().into(),
                        error,
                    });
                }
                Err(_) => tries += 1,
            }
        }
    }

    async fn read(&mut self, register: Register) -> Result<u8, Error<B::Error>> {
        let mut value = [0];
        let mut tries = 1;
        loop {
            let address = [register as u8];
            match self.bus.write_read(ADDRESS, &address, &mut value).await {
                Ok(()) => return Ok(value[0]),
                Err(error) if tries == TRIES || !is_passing(&error) => {
                    return Err(Error::Bus {
                        register: register as u16,
                        error,
                    });
                }
                Err(_) => tries += 1,
            }
        }
    }

    /// Replaces the picture by a pattern of the sensor's own, or brings it back, from the next vertical
    /// sync on: known bytes, to try wires and capture with.
    ///
    /// # Errors
    /// [`Error::Bus`]: the sensor shows what it showed before, or what was asked for.
    pub async fn set_test_pattern(
        &mut self,
        pattern: Option<TestPattern>,
    ) -> Result<(), Error<B::Error>> {
        let bits = pattern.map_or(0, |pattern| registers::TEST_PATTERN | pattern as u8);
        self.write(Register::Sync, registers::SYNC_BY_PINS | bits)
            .await
    }

    /// Lines in the given fraction of a second, as registers 1C and 1D want them.
    fn lines_in(&self, fraction_of_second: u32) -> u8 {
        let clocks = CLOCKS_PER_LINE * fraction_of_second;
        u8::try_from((self.clock_hz + clocks / 2) / clocks).unwrap_or(u8::MAX)
    }
}

impl<B: I2c> ImageSensor for Tcm8230<B> {
    type BusError = B::Error;

    async fn probe(&mut self) -> Result<(), Error<B::Error>> {
        match self.read(Register::Identity).await? {
            registers::IDENTITY => Ok(()),
            id => Err(Error::NotFound { id }),
        }
    }

    /// Gamma is switched off: horizon brightness is then proportional to light and to shutter,
    /// which the exposure control inverts, instead of their 0.55th power. White balance is manual,
    /// for its drift would show in luma. The outputs come on last: the first frame is already the
    /// one that was asked for.
    async fn init(&mut self, lines: u16, gain: f32) -> Result<(), Error<B::Error>> {
        use Register::*;
        self.write(ReadoutPhase, registers::READOUT_PHASE_MANDATORY)
            .await?;
        self.write(Sync, registers::SYNC_BY_PINS).await?;
        self.write(Timing, registers::TIMING_FULL_RATE).await?;
        self.write(Lines100, self.lines_in(100)).await?;
        self.write(Lines120, self.lines_in(120)).await?;
        self.write(Gamma, registers::GAMMA_OFF).await?;
        self.write(WhiteBalance, registers::WHITE_BALANCE_MANUAL)
            .await?;
        self.set_exposure(lines, gain).await?;
        self.write(DigitalGain, registers::DIGITAL_GAIN_UNITY)
            .await?;
        self.write(Output, registers::OUTPUT_SUBQCIF_YUV).await
    }

    /// One burst over registers 05, 06 and 07: they latch together at vertical sync. In two
    /// transactions the sync could fall between the halves of the shutter (0x0FF to 0x100 would
    /// pass through 0x1FF or 0x000).
    async fn set_exposure(&mut self, lines: u16, gain: f32) -> Result<(), Error<B::Error>> {
        let [high, low] = lines.clamp(1, MAX_LINES).to_be_bytes();
        self.write_bytes(&[
            Register::Exposure as u8,
            registers::EXPOSURE_MANUAL | high,
            low,
            gain_code(gain),
        ])
        .await
    }

    fn geometry(&self) -> Geometry {
        GEOMETRY
    }

    fn line_time(&self) -> Duration {
        Duration::from_nanos(
            u64::from(CLOCKS_PER_LINE) * 1_000_000_000 / u64::from(self.clock_hz.max(1)),
        )
    }

    fn max_lines(&self) -> u16 {
        MAX_LINES
    }

    fn latency_frames(&self) -> u8 {
        LATENCY_FRAMES
    }

    fn settling_frames(&self) -> u8 {
        SETTLING_FRAMES
    }
}

/// The gain code next to a factor, which is 1 to 16 on this sensor; nonsense gives 1.
fn gain_code(gain: f32) -> u8 {
    if gain > 1.0 {
        let code = f32::from(registers::GAIN_UNITY) / gain + 0.5;
        (code as u8).max(registers::GAIN_HIGHEST)
    } else {
        registers::GAIN_UNITY
    }
}

/// Whether the same transfer may succeed when it is tried again at once.
fn is_passing(error: &impl i2c::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::NoAcknowledge(_) | ErrorKind::ArbitrationLoss
    )
}
