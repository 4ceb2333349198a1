//! Claims of RM0090 §27.3, on the registers of I2C2: standard mode, 100 kHz from PCLK1 42 MHz.

use super::*;
use crate::core::Cycle;
use crate::memory::{Memory, SRAM};
use crate::soc::dma::Dma;
use crate::soc::timeline::Timeline;
use crate::time::Nanos;

/// 2 · 210 bus clocks of four HCLK cycles: 10 µs.
const BIT: Cycle = 2 * 210 * 4;
const DEVICE: u8 = 0x3c;

/// A device with one address that records what happens to it, and reads as 0xa0, 0xa1, …
#[derive(Default)]
struct Device {
    log: Vec<String>,
    reads: u8,
    refuses_data: bool,
}

impl Wiring for Device {
    fn i2c_start(&mut self, _now: Nanos, bus: u8, address: u8, read: bool) -> bool {
        assert_eq!(bus, 2);
        let direction = if read { "read" } else { "write" };
        self.log.push(format!("{direction} {address:02x}"));
        address == DEVICE
    }

    fn i2c_write(&mut self, _now: Nanos, _bus: u8, byte: u8) -> bool {
        self.log.push(format!("{byte:02x}"));
        !self.refuses_data
    }

    fn i2c_read(&mut self, _now: Nanos, _bus: u8) -> u8 {
        self.reads += 1;
        0x9f + self.reads
    }

    fn i2c_stop(&mut self, _now: Nanos, _bus: u8) {
        self.log.push("stop".into());
    }
}

struct Bench {
    i2c: I2c,
    now: Cycle,
    time: Timeline,
    memory: Memory,
    dma: Dma,
    device: Device,
}

macro_rules! reach {
    ($bench:ident) => {
        &mut Reach {
            now: $bench.now,
            time: &$bench.time,
            memory: &mut $bench.memory,
            dma: &mut $bench.dma,
            wiring: &mut $bench.device,
        }
    };
}

impl Bench {
    fn new() -> Self {
        let mut bench = Self {
            i2c: I2c::new(2),
            now: 0,
            time: Timeline::new(168_000_000),
            memory: Memory::new(),
            dma: Dma::new(),
            device: Device::default(),
        };
        bench.i2c.set_clock(4);
        bench.write(CCR, 210);
        bench.write(CR1, ENABLE);
        bench
    }

    fn write(&mut self, offset: u32, value: u32) {
        self.i2c.write(offset, value, reach!(self)).unwrap();
        self.i2c.serve(reach!(self));
    }

    fn read(&mut self, offset: u32) -> u32 {
        let value = self.i2c.read(offset, self.now).unwrap();
        self.i2c.serve(reach!(self));
        value
    }

    /// Runs until a flag of SR1 is up; returns the bits that took.
    fn wait_for(&mut self, flags: u32) -> u64 {
        let from = self.now;
        while self.read(SR1) & flags == 0 {
            assert_ne!(self.i2c.next(), NEVER, "nothing will raise {flags:#x}");
            self.step();
        }
        (self.now - from) / BIT
    }

    fn step(&mut self) {
        self.now = self.i2c.next();
        self.i2c.advance(reach!(self));
    }

    fn settle(&mut self) {
        while self.i2c.next() != NEVER {
            self.step();
        }
    }

    fn address(&mut self, address: u8, read: bool) {
        self.write(CR1, ENABLE | START | ACKNOWLEDGE);
        assert_eq!(self.wait_for(START_SENT), 1);
        self.write(DR, u32::from(address) << 1 | u32::from(read));
        assert_eq!(self.wait_for(ADDRESSED | ACKNOWLEDGE_FAILURE), 9);
    }

    /// A stream of DMA1 on channel 7 for the device's data register.
    fn stream(&mut self, number: u32, count: u32, cr: u32) {
        let base = 0x10 + 0x18 * number;
        let cr = 7 << 25 | 1 << 10 | cr | 1;
        for (register, value) in [(4, count), (8, 0x4000_5810), (12, SRAM), (0, cr)] {
            self.dma.write(1, base + register, value).unwrap();
        }
    }
}

#[test]
fn a_write_is_start_address_bytes_stop() {
    let mut bench = Bench::new();
    bench.address(DEVICE, false);
    assert_eq!(bench.read(SR2), MASTER | BUSY | TRANSMITTER);
    for byte in [0x03, 0x20] {
        bench.wait_for(EMPTY);
        bench.write(DR, byte);
    }
    // The first byte shifts while the second waits: two bytes until both are gone.
    assert_eq!(bench.wait_for(TRANSFER_FINISHED), 18);
    bench.write(CR1, ENABLE | STOP);
    assert_eq!(bench.read(SR1) & (TRANSFER_FINISHED | EMPTY), 0);
    bench.settle();
    assert_eq!(bench.read(SR2), 0);
    assert_eq!(bench.read(CR1), ENABLE);
    assert_eq!(bench.device.log, ["write 3c", "03", "20", "stop"]);
}

#[test]
fn an_absent_device_is_an_acknowledge_failure_on_the_error_line() {
    let mut bench = Bench::new();
    bench.write(CR2, ERROR_INTERRUPT | EVENT_INTERRUPT);
    bench.address(0x55, false);
    assert_eq!(bench.read(SR1), ACKNOWLEDGE_FAILURE);
    let mut lines = Lines::default();
    bench.i2c.drive(&mut lines);
    assert!(lines.is_high(34) && !lines.is_high(33));
    bench.write(SR1, !ACKNOWLEDGE_FAILURE);
    assert_eq!(bench.read(SR1), 0);
    bench.write(CR1, ENABLE | STOP);
    bench.settle();
    assert_eq!(bench.device.log, ["write 55", "stop"]);
}

#[test]
fn a_refused_byte_is_an_acknowledge_failure_and_empties_nothing() {
    let mut bench = Bench::new();
    bench.device.refuses_data = true;
    bench.address(DEVICE, false);
    bench.read(SR2);
    bench.write(DR, 1);
    bench.settle();
    assert_eq!(bench.read(SR1), ACKNOWLEDGE_FAILURE);
}

#[test]
fn a_repeated_start_turns_a_write_into_a_read() {
    let mut bench = Bench::new();
    bench.address(DEVICE, false);
    bench.read(SR2);
    bench.write(DR, 0x0a);
    bench.wait_for(TRANSFER_FINISHED);
    bench.address(DEVICE, true);
    assert_eq!(bench.read(SR2), MASTER | BUSY);
    assert_eq!(bench.wait_for(RECEIVED), 9);
    bench.write(CR1, ENABLE | STOP);
    assert_eq!(bench.read(DR), 0xa0);
    assert_eq!(bench.wait_for(RECEIVED), 9);
    assert_eq!(bench.read(DR), 0xa1);
    bench.settle();
    assert_eq!(bench.device.log, ["write 3c", "0a", "read 3c", "stop"]);
}

#[test]
fn a_receiver_nobody_reads_holds_the_clock_with_two_bytes() {
    let mut bench = Bench::new();
    bench.address(DEVICE, true);
    bench.read(SR2);
    bench.wait_for(TRANSFER_FINISHED);
    assert_eq!(bench.i2c.next(), NEVER);
    assert_eq!(bench.device.reads, 2);
    assert_eq!(bench.read(DR), 0xa0);
    assert_eq!(bench.read(SR1) & (RECEIVED | TRANSFER_FINISHED), RECEIVED);
    assert_ne!(bench.i2c.next(), NEVER);
}

#[test]
fn addr_holds_the_bus_until_sr1_then_sr2_are_read() {
    let mut bench = Bench::new();
    bench.address(DEVICE, true);
    assert_eq!(bench.i2c.next(), NEVER);
    bench.read(SR2);
    assert_eq!(bench.i2c.next(), bench.now + 9 * BIT);
}

#[test]
fn dma_writes_until_its_stream_ends_then_btf_rises() {
    let mut bench = Bench::new();
    for (offset, byte) in (0..).zip([5, 6, 7]) {
        bench.memory.write8(SRAM + offset, byte).unwrap();
    }
    bench.write(CR2, DMA_ENABLE);
    bench.address(DEVICE, false);
    bench.stream(7, 3, 1 << 6);
    bench.read(SR2);
    assert_eq!(bench.wait_for(TRANSFER_FINISHED), 27);
    assert_eq!(bench.device.log, ["write 3c", "05", "06", "07"]);
}

#[test]
fn dma_with_last_does_not_acknowledge_its_last_byte() {
    let mut bench = Bench::new();
    bench.write(CR2, DMA_ENABLE | LAST);
    bench.address(DEVICE, true);
    bench.stream(2, 3, 0);
    bench.read(SR2);
    bench.settle();
    assert_eq!(bench.memory.bytes(SRAM, 3), Some(&[0xa0, 0xa1, 0xa2][..]));
    assert_eq!(bench.device.reads, 3);
    bench.write(CR1, ENABLE | STOP);
    bench.settle();
    assert_eq!(bench.device.log, ["read 3c", "stop"]);
}

#[test]
fn a_start_asked_for_during_a_stop_follows_it() {
    let mut bench = Bench::new();
    bench.address(0x55, false);
    bench.write(CR1, ENABLE | STOP);
    bench.write(CR1, ENABLE | STOP | START);
    assert_eq!(bench.wait_for(START_SENT), 2);
    assert_eq!(bench.device.log, ["write 55", "stop"]);
}

#[test]
fn fast_mode_is_three_or_twenty_five_ccr_per_bit() {
    let mut bench = Bench::new();
    bench.write(CCR, 1 << 15 | 35);
    assert_eq!(bench.i2c.bit_cycles(), 3 * 35 * 4);
    bench.write(CCR, 3 << 14 | 4);
    assert_eq!(bench.i2c.bit_cycles(), 25 * 4 * 4);
}

#[test]
fn switching_the_peripheral_off_lets_go_of_the_bus() {
    let mut bench = Bench::new();
    bench.address(DEVICE, false);
    bench.write(CR1, 0);
    assert_eq!(bench.read(SR1), 0);
    assert_eq!(bench.read(SR2), 0);
    assert_eq!(bench.device.log, ["write 3c", "stop"]);
}
