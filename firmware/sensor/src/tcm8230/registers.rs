//! The TCM8230MD's registers, as far as the driver writes or reads them.
//!
//! Source: Toshiba TCM8230MD(A) data sheet v1.20 (2004), register table, and application note v1.1
//! (2004) where named. `[V]`: takes effect at vertical sync. `[N]`: takes effect at once.

/// The sensor's 7-bit address (0x78 and 0x79 with the direction bit).
pub const ADDRESS: u8 = 0x3c;

/// Address of a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Register {
    /// Reads [`IDENTITY`] always.
    Identity = 0x00,
    /// Frame rate, mains frequency, pixel clock polarity [V].
    Timing = 0x02,
    /// Output switch [N], picture size [V], picture format [N].
    Output = 0x03,
    /// The first of three: 05 holds the switch from automatic to manual exposure and shutter bits
    /// 12..8, 06 shutter bits 7..0 (in lines), 07 the analogue gain (the factor is 192 / value);
    /// all [V].
    Exposure = 0x05,
    /// Switch from automatic to manual white balance [V].
    WhiteBalance = 0x0a,
    /// Gamma switch [N].
    Gamma = 0x0d,
    /// Lines in 1/100 s, for the automatic exposure under 50 Hz mains.
    Lines100 = 0x1c,
    /// Lines in 1/120 s, for the automatic exposure under 60 Hz mains.
    Lines120 = 0x1d,
    /// Synchronisation codes, shape of the line signal, test patterns [V].
    Sync = 0x1e,
    /// Start phase of the vertical read-out.
    ReadoutPhase = 0x22,
    /// Digital gain in its lower six bits [N].
    DigitalGain = 0x3b,
}

/// What [`Register::Identity`] reads.
pub const IDENTITY: u8 = 0x70;

/// [`Register::Timing`]: 30 frames per second at the nominal clock (bit 7 = 0), mains frequency
/// set by hand (bit 0 = 1) to 50 Hz (bit 6 = 0), data valid at the rising clock edge (bit 1 = 0).
pub const TIMING_FULL_RATE: u8 = 0x01;

/// [`Register::Output`]: outputs on (bit 7 = 0), sub-QCIF of the full field of view, 128 x 96
/// (bits 5..2 = 8), YUV 4:2:2 (bit 1 = 0).
pub const OUTPUT_SUBQCIF_YUV: u8 = 0x20;

/// First byte of [`Register::Exposure`], bit 7: manual exposure.
pub const EXPOSURE_MANUAL: u8 = 0x80;

/// Third byte of [`Register::Exposure`] at a factor of one: gain = 192 / value.
pub const GAIN_UNITY: u8 = 192;

/// Third byte of [`Register::Exposure`] at +24 dB, the highest of the table.
pub const GAIN_HIGHEST: u8 = 12;

/// [`Register::WhiteBalance`]: manual.
pub const WHITE_BALANCE_MANUAL: u8 = 0x80;

/// [`Register::Gamma`]: off.
pub const GAMMA_OFF: u8 = 0x80;

/// [`Register::Sync`]: no codes in the data (bit 5 = 0), the line signal is high exactly while data
/// are valid (bit 3 = 1), the first frame after a change of format is masked (bits 7..6 = 1, the
/// reset value).
pub const SYNC_BY_PINS: u8 = 0x48;

/// [`Register::Sync`], bit 2: a test pattern, by its number in bits 1..0, in place of the picture.
pub const TEST_PATTERN: u8 = 0x04;

/// [`Register::ReadoutPhase`]: the value the application note calls mandatory (reset: 0x26).
pub const READOUT_PHASE_MANDATORY: u8 = 0x28;

/// [`Register::DigitalGain`]: factor one (bits 5..0 = 0), the upper bits as after reset.
pub const DIGITAL_GAIN_UNITY: u8 = 0x80;
