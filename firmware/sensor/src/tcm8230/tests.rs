//! The driver against a register file with the sensor's I2C behaviour: auto-increment, one
//! identity, refusals on demand.

extern crate std;

use core::future::Future;
use std::{vec, vec::Vec};

use embedded_hal_async::i2c::{ErrorKind, ErrorType, NoAcknowledgeSource, Operation};
use pollster::block_on;

use super::*;

/// EXTCLK of the board: 168 MHz / 8.
const CLOCK_HZ: u32 = 21_000_000;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum MockError {
    Nack,
    ArbitrationLoss,
    Stuck,
}

impl i2c::Error for MockError {
    fn kind(&self) -> ErrorKind {
        match self {
            Self::Nack => ErrorKind::NoAcknowledge(NoAcknowledgeSource::Unknown),
            Self::ArbitrationLoss => ErrorKind::ArbitrationLoss,
            Self::Stuck => ErrorKind::Bus,
        }
    }
}

struct RegisterFile {
    registers: [u8; 256],
    pointer: u8,
    /// Transactions that wrote data: the first register and the values.
    writes: Vec<(u8, Vec<u8>)>,
    /// Errors of the next transactions, last first.
    failures: Vec<MockError>,
    /// Transactions that go through before the failures begin.
    good: usize,
    /// A transaction never ends: something holds the clock.
    hangs: bool,
}

impl RegisterFile {
    fn new() -> Self {
        let mut registers = [0; 256];
        registers[0x00] = 0x70;
        Self {
            registers,
            pointer: 0,
            writes: vec![],
            failures: vec![],
            good: 0,
            hangs: false,
        }
    }

    fn failing(failures: &[MockError]) -> Self {
        Self {
            failures: failures.to_vec(),
            ..Self::new()
        }
    }
}

impl ErrorType for &mut RegisterFile {
    type Error = MockError;
}

impl I2c for &mut RegisterFile {
    async fn transaction(
        &mut self,
        address: u8,
        operations: &mut [Operation<'_>],
    ) -> Result<(), MockError> {
        assert_eq!(address, 0x3c, "nobody else is on the bus");
        if self.hangs {
            core::future::pending::<()>().await;
        }
        if let Some(left) = self.good.checked_sub(1) {
            self.good = left;
        } else if let Some(error) = self.failures.pop() {
            return Err(error);
        }
        for operation in operations {
            match operation {
                Operation::Write([first, values @ ..]) => {
                    self.pointer = *first;
                    if !values.is_empty() {
                        self.writes.push((*first, values.to_vec()));
                    }
                    for &value in values {
                        self.registers[usize::from(self.pointer)] = value;
                        self.pointer = self.pointer.wrapping_add(1);
                    }
                }
                Operation::Write([]) => {}
                Operation::Read(values) => {
                    for value in values.iter_mut() {
                        *value = self.registers[usize::from(self.pointer)];
                        self.pointer = self.pointer.wrapping_add(1);
                    }
                }
            }
        }
        Ok(())
    }
}

fn initialised() -> RegisterFile {
    let mut file = RegisterFile::new();
    block_on(Tcm8230::new(&mut file, CLOCK_HZ).init(135, 1.0)).unwrap();
    file
}

#[test]
fn probe_accepts_the_identity_of_the_data_sheet() {
    let mut file = RegisterFile::new();
    assert_eq!(block_on(Tcm8230::new(&mut file, CLOCK_HZ).probe()), Ok(()));
}

#[test]
fn probe_names_the_stranger_at_the_address() {
    // An OV5640 answers at the same address; the high byte of its 16-bit identity is 0x56.
    let mut file = RegisterFile::new();
    file.registers[0] = 0x56;
    assert_eq!(
        block_on(Tcm8230::new(&mut file, CLOCK_HZ).probe()),
        Err(Error::NotFound { id: 0x56 })
    );
}

#[test]
fn init_leaves_the_documented_values_in_the_registers() {
    let file = initialised();
    for (register, value, meaning) in [
        (0x22, 0x28, "read-out phase, mandatory"),
        (0x1e, 0x48, "no codes, line signal while data are valid"),
        (0x02, 0x01, "full rate, 50 Hz by hand, rising edge"),
        (0x1c, 135, "10 ms in lines of 74.29 us"),
        (0x1d, 112, "8.33 ms in lines of 74.29 us"),
        (0x0d, 0x80, "gamma off"),
        (0x0a, 0x80, "manual white balance"),
        (0x05, 0x80, "manual exposure"),
        (0x06, 135, "shutter"),
        (0x07, 0xc0, "0 dB"),
        (0x3b, 0x80, "no digital gain"),
        (0x03, 0x20, "outputs on, 128 x 96, YUV"),
    ] {
        assert_eq!(
            file.registers[register], value,
            "{register:#04x}: {meaning}"
        );
    }
}

#[test]
fn outputs_come_on_with_the_last_write() {
    let file = initialised();
    assert_eq!(file.writes.last(), Some(&(0x03, vec![0x20])));
    assert_eq!(file.writes.iter().filter(|w| w.0 == 0x03).count(), 1);
}

#[test]
fn exposure_is_one_burst_over_three_registers() {
    let mut file = RegisterFile::new();
    block_on(Tcm8230::new(&mut file, CLOCK_HZ).set_exposure(0x100, 2.0)).unwrap();
    assert_eq!(file.writes, [(0x05, vec![0x81, 0x00, 0x60])]);
}

#[test]
fn shutter_is_clamped_to_the_lines_of_a_frame() {
    for (asked, set) in [(0, 1), (1, 1), (525, 525), (526, 525), (u16::MAX, 525)] {
        let mut file = RegisterFile::new();
        block_on(Tcm8230::new(&mut file, CLOCK_HZ).set_exposure(asked, 1.0)).unwrap();
        let lines = u16::from_be_bytes([file.registers[5] & 0x1f, file.registers[6]]);
        assert_eq!(lines, set, "asked for {asked}");
    }
}

#[test]
fn gain_codes_are_those_of_the_data_sheet_table() {
    // 0, +6, +12, +18, +24 dB in steps of a factor of two, then what lies outside.
    for (gain, code) in [
        (1.0, 0xc0),
        (2.0, 0x60),
        (4.0, 0x30),
        (8.0, 0x18),
        (16.0, 0x0c),
        (17.0, 0x0c),
        (f32::INFINITY, 0x0c),
        (0.5, 0xc0),
        (0.0, 0xc0),
        (-1.0, 0xc0),
        (f32::NAN, 0xc0),
    ] {
        assert_eq!(gain_code(gain), code, "gain {gain}");
    }
}

#[test]
fn two_refusals_are_survived_and_the_third_is_reported() {
    use MockError::Nack;
    let mut file = RegisterFile::failing(&[Nack, Nack]);
    assert_eq!(
        block_on(Tcm8230::new(&mut file, CLOCK_HZ).set_exposure(10, 1.0)),
        Ok(())
    );
    let mut file = RegisterFile::failing(&[Nack, Nack, Nack]);
    assert_eq!(
        block_on(Tcm8230::new(&mut file, CLOCK_HZ).set_exposure(10, 1.0)),
        Err(Error::Bus {
            register: 0x05,
            error: Nack
        })
    );
}

#[test]
fn a_stuck_bus_is_reported_at_once() {
    let mut file = RegisterFile::failing(&[MockError::Stuck]);
    assert_eq!(
        block_on(Tcm8230::new(&mut file, CLOCK_HZ).probe()),
        Err(Error::Bus {
            register: 0x00,
            error: MockError::Stuck
        })
    );
    assert!(file.failures.is_empty(), "one transaction, no retry");
}

#[test]
fn a_failed_init_leaves_the_outputs_off() {
    // The refusals hit whichever transaction comes first; the last one never runs.
    let mut file = RegisterFile::failing(&[MockError::Nack; 3]);
    assert!(block_on(Tcm8230::new(&mut file, CLOCK_HZ).init(1, 1.0)).is_err());
    assert!(file.writes.iter().all(|write| write.0 != 0x03));
}

#[test]
fn a_line_takes_1560_clocks() {
    let mut file = RegisterFile::new();
    let sensor = Tcm8230::new(&mut file, CLOCK_HZ);
    assert_eq!(sensor.line_time().as_nanos(), 74_285);
}

#[test]
fn a_frame_is_24576_bytes_of_uyvy() {
    assert_eq!(GEOMETRY.line_bytes(), 256);
    assert_eq!(GEOMETRY.frame_bytes(), 24_576);
    assert_eq!(GEOMETRY.luma_offset, 1);
}

#[test]
fn lost_arbitration_is_tried_again_like_a_refusal() {
    use MockError::{ArbitrationLoss, Nack};
    let mut file = RegisterFile::failing(&[ArbitrationLoss, Nack]);
    assert_eq!(block_on(Tcm8230::new(&mut file, CLOCK_HZ).probe()), Ok(()));
    let mut file = RegisterFile::failing(&[ArbitrationLoss; 3]);
    assert_eq!(
        block_on(Tcm8230::new(&mut file, CLOCK_HZ).probe()),
        Err(Error::Bus {
            register: 0x00,
            error: ArbitrationLoss
        })
    );
}

#[test]
fn a_failed_init_names_the_register_it_came_to() {
    // The order of the set-up: read-out phase, sync, timing, lines, gamma.
    for (good, register) in [(0, 0x22), (1, 0x1e), (2, 0x02), (3, 0x1c), (5, 0x0d)] {
        let mut file = RegisterFile::failing(&[MockError::Nack; 3]);
        file.good = good;
        let error = block_on(Tcm8230::new(&mut file, CLOCK_HZ).init(1, 1.0));
        let named = Error::Bus {
            register,
            error: MockError::Nack,
        };
        assert_eq!(error, Err(named));
    }
}

/// The board ends a transfer that hangs by dropping it.
#[test]
fn a_dropped_transfer_leaves_the_driver_usable_and_the_sensor_as_it_was() {
    let mut file = initialised();
    let before = file.registers;
    file.hangs = true;
    {
        let mut sensor = Tcm8230::new(&mut file, CLOCK_HZ);
        let mut transfer = core::pin::pin!(sensor.set_exposure(200, 2.0));
        let mut context = core::task::Context::from_waker(core::task::Waker::noop());
        assert!(transfer.as_mut().poll(&mut context).is_pending());
    }
    assert_eq!(file.registers, before);
    file.hangs = false;
    assert_eq!(
        block_on(Tcm8230::new(&mut file, CLOCK_HZ).set_exposure(200, 2.0)),
        Ok(())
    );
    assert_eq!(file.registers[5..8], [0x80, 200, 0x60]);
}

#[test]
fn test_patterns_come_and_go_by_register_1e_and_leave_the_syncs_alone() {
    let mut file = initialised();
    for (pattern, value) in [
        (Some(TestPattern::Bars), 0x4c),
        (Some(TestPattern::RampAfterGamma), 0x4d),
        (Some(TestPattern::RampBeforeGamma), 0x4e),
        (None, 0x48),
    ] {
        let mut sensor = Tcm8230::new(&mut file, CLOCK_HZ);
        assert_eq!(block_on(sensor.set_test_pattern(pattern)), Ok(()));
        assert_eq!(file.registers[0x1e], value, "{pattern:?}");
    }
}
