//! Claims about the core, each as a few instructions and what the architecture says they do.

mod access;
mod arithmetic;
mod calls;
mod control;
mod dsp;
mod exceptions;
mod float;
mod memory;
mod robustness;
mod system;

use super::*;
use crate::memory::{FLASH, SRAM};

/// Where programs begin.
const CODE: u32 = FLASH + 0x400;
/// The initial stack pointer.
const STACK: u32 = SRAM + 0x1_0000;
/// A spare piece of SRAM.
const DATA: u32 = SRAM + 0x100;
/// Where every program ends.
const BKPT: u16 = 0xbe00;
/// An address on the bus where reads return `SPY_VALUE` and writes are kept.
const SPY: u32 = 0x4000_0000;
const SPY_VALUE: u32 = 0xa5a5_a5a5;

/// Where the bus answers.
const SPY_RANGE: std::ops::Range<u32> = SPY..SPY + 0x100;

/// A peripheral that remembers.
#[derive(Default)]
struct Spy {
    accesses: Vec<(Cycle, u32, Width, Option<u32>)>,
    /// How long each access keeps the core.
    delay: Cycle,
}

impl Bus for Spy {
    fn read(
        &mut self,
        _: &mut Memory,
        now: Cycle,
        address: u32,
        width: Width,
    ) -> Result<u32, BusFault> {
        self.accesses.push((now, address, width, None));
        if SPY_RANGE.contains(&address) {
            Ok(SPY_VALUE)
        } else {
            Err(BusFault)
        }
    }

    fn write(
        &mut self,
        _: &mut Memory,
        now: Cycle,
        address: u32,
        width: Width,
        value: u32,
    ) -> Result<(), BusFault> {
        self.accesses.push((now, address, width, Some(value)));
        if SPY_RANGE.contains(&address) {
            Ok(())
        } else {
            Err(BusFault)
        }
    }

    fn delay(&mut self, _: Cycle, _: u32, _: bool) -> Cycle {
        self.delay
    }
}

/// A core, its memories and one program.
struct Bench {
    core: Core,
    memory: Memory,
    bus: Spy,
}

impl Bench {
    /// A program at `CODE` with a breakpoint behind it, the FPU on.
    fn new(program: &[u16]) -> Self {
        let mut memory = Memory::new();
        place(&mut memory, FLASH, &[STACK as u16, (STACK >> 16) as u16]);
        place(
            &mut memory,
            FLASH + 4,
            &[CODE as u16 | 1, (CODE >> 16) as u16],
        );
        place(&mut memory, CODE, program);
        place(&mut memory, CODE + 2 * program.len() as u32, &[BKPT]);
        let mut core = Core::new();
        core.reset(&memory);
        core.write_cpacr(0xf << 20);
        Self {
            core,
            memory,
            bus: Spy::default(),
        }
    }

    /// The same with registers set, R0 first.
    fn with(registers: &[u32], program: &[u16]) -> Self {
        let mut bench = Self::new(program);
        for (number, value) in registers.iter().enumerate() {
            bench.core.set_register(number as u8, *value);
        }
        bench
    }

    /// A handler for an exception, with a breakpoint behind it.
    fn handler(mut self, exception: u8, program: &[u16]) -> Self {
        let address = FLASH + 0x1000 + 0x100 * u32::from(exception);
        let vector = FLASH + 4 * u32::from(exception);
        place(
            &mut self.memory,
            vector,
            &[address as u16 | 1, (address >> 16) as u16],
        );
        place(&mut self.memory, address, program);
        place(
            &mut self.memory,
            address + 2 * program.len() as u32,
            &[BKPT],
        );
        self
    }

    /// Runs as a machine would, until the program stops. Returns the cycles it took.
    fn run(&mut self) -> Cycle {
        let stop = self.stop();
        assert_eq!(stop.cause, Cause::Breakpoint(0), "{stop}");
        self.core.cycles() - 1
    }

    /// Runs until the program stops, and tells why.
    fn stop(&mut self) -> Stop {
        for _ in 0..10_000 {
            self.core.take_pending_exceptions(&mut self.memory);
            let next = self.core.next_systick().unwrap_or(Cycle::MAX);
            if self.core.is_sleeping() && !self.core.try_wake() {
                assert_ne!(next, Cycle::MAX, "asleep for ever");
                self.core.advance_to(next);
                continue;
            }
            if let Exit::Stopped(stop) = self.core.run(&mut self.memory, &mut self.bus, next) {
                return stop;
            }
        }
        panic!("the program does not end");
    }

    fn r(&self, number: u8) -> u32 {
        self.core.register(number)
    }

    fn s(&self, number: u8) -> f32 {
        f32::from_bits(self.core.float_register(number))
    }

    /// NZCV as a string of the flags that are set.
    fn flags(&self) -> String {
        let apsr = self.core.xpsr();
        let names = ["N", "Z", "C", "V", "Q"].iter().enumerate();
        names
            .filter(|(at, _)| apsr >> (31 - at) & 1 != 0)
            .map(|(_, name)| *name)
            .collect()
    }
}

/// Puts halfwords into memory.
fn place(memory: &mut Memory, address: u32, halfwords: &[u16]) {
    let bytes: Vec<u8> = halfwords
        .iter()
        .flat_map(|half| half.to_le_bytes())
        .collect();
    memory.place(address, &bytes).expect("within flash or RAM");
}

/// The registers that a program leaves, from R0 on.
fn result<const N: usize>(registers: &[u32], program: &[u16]) -> [u32; N] {
    let mut bench = Bench::with(registers, program);
    bench.run();
    std::array::from_fn(|number| bench.r(number as u8))
}

/// The flags that a program leaves.
fn flags_after(registers: &[u32], program: &[u16]) -> String {
    let mut bench = Bench::with(registers, program);
    bench.run();
    bench.flags()
}
