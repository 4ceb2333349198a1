//! The chip's debug unit: breakpoints, watchpoints, single steps, and the memory as a probe sees it.
//!
//! It costs nothing as long as nobody uses it: only [`Machine::run_debugged`] looks at it, and with
//! neither points nor steps that is [`Machine::run_until`].

use super::{Fault, Machine};
use crate::core::{Access, Core, Width};
use crate::memory::{FLASH, FLASH_BYTES, Memory};
use crate::time::Nanos;
use crate::wiring::Wiring;

/// Which accesses a watchpoint is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Watched {
    /// Stores.
    Writes,
    /// Loads.
    Reads,
    /// Both.
    Accesses,
}

/// A piece of memory whose accesses by instructions pause the run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Watchpoint {
    /// Its first address.
    pub address: u32,
    /// Its bytes.
    pub bytes: u32,
    /// Which accesses.
    pub on: Watched,
}

impl Watchpoint {
    /// The first watched address that an access touches.
    fn touched_by(&self, access: Access) -> Option<u32> {
        let is_meant = match self.on {
            Watched::Writes => access.write,
            Watched::Reads => !access.write,
            Watched::Accesses => true,
        };
        let behind = self.address.wrapping_sub(access.address);
        let before = access.address.wrapping_sub(self.address);
        match is_meant {
            true if behind < access.bytes => Some(self.address),
            true if before < self.bytes => Some(access.address),
            _ => None,
        }
    }
}

/// Why a debugged run returned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pause {
    /// Virtual time has reached the instant asked for.
    Reached,
    /// One instruction was executed, or one exception entered.
    Stepped,
    /// The next instruction has a breakpoint; it has not been executed.
    Breakpoint,
    /// The next instruction is about to access watched memory; it has not been executed.
    Watchpoint {
        /// The watchpoint.
        watchpoint: Watchpoint,
        /// The first watched address that it touches.
        address: u32,
    },
}

/// Where the program was paused, lest it pause there again when it is to go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Passed {
    instructions: u64,
    pc: u32,
    by_watchpoint: bool,
}

/// Breakpoints and watchpoints, in any number. What is set twice is to be cleared twice.
#[derive(Debug, Default)]
pub struct DebugUnit {
    breakpoints: Vec<u32>,
    watchpoints: Vec<Watchpoint>,
    /// Executes one instruction at a time.
    pub steps: bool,
    passed: Option<Passed>,
}

/// Takes the first of equal elements away. False: there is none.
fn remove<T: PartialEq>(from: &mut Vec<T>, element: &T) -> bool {
    let found = from.iter().position(|known| known == element);
    found.is_some_and(|index| {
        from.swap_remove(index);
        true
    })
}

impl DebugUnit {
    /// Pauses the run before the instruction at `address`.
    pub fn set_breakpoint(&mut self, address: u32) {
        self.breakpoints.push(address & !1);
    }

    /// Undoes it. False: there is no such breakpoint.
    pub fn clear_breakpoint(&mut self, address: u32) -> bool {
        remove(&mut self.breakpoints, &(address & !1))
    }

    /// Pauses the run before the accesses of a watchpoint.
    pub fn set_watchpoint(&mut self, watchpoint: Watchpoint) {
        self.watchpoints.push(watchpoint);
    }

    /// Undoes it. False: there is no such watchpoint.
    pub fn clear_watchpoint(&mut self, watchpoint: Watchpoint) -> bool {
        remove(&mut self.watchpoints, &watchpoint)
    }

    fn is_idle(&self) -> bool {
        !self.steps && self.breakpoints.is_empty() && self.watchpoints.is_empty()
    }

    /// The program stands here, for the debugger to look around.
    fn pause(&mut self, core: &Core, pause: Pause) -> Pause {
        self.passed = Some(Passed {
            instructions: core.instructions(),
            pc: core.pc(),
            by_watchpoint: matches!(pause, Pause::Watchpoint { .. }),
        });
        pause
    }

    /// What speaks against executing the next instruction.
    fn objection(&self, core: &mut Core, memory: &Memory) -> Option<Pause> {
        let here =
            |passed: &Passed| passed.instructions == core.instructions() && passed.pc == core.pc();
        let passed = self.passed.filter(here);
        if passed.is_none() && self.breakpoints.contains(&core.pc()) {
            return Some(Pause::Breakpoint);
        }
        if self.watchpoints.is_empty() || passed.is_some_and(|passed| passed.by_watchpoint) {
            return None;
        }
        let access = core.next_access(memory)?;
        self.watchpoints.iter().find_map(|&watchpoint| {
            let address = watchpoint.touched_by(access)?;
            Some(Pause::Watchpoint {
                watchpoint,
                address,
            })
        })
    }
}

impl<W: Wiring> Machine<W> {
    /// The debug unit.
    pub fn debug_unit(&mut self) -> &mut DebugUnit {
        &mut self.debug
    }

    /// The core, for its registers.
    pub fn core(&mut self) -> &mut Core {
        &mut self.core
    }

    /// Like [`run_until`](Self::run_until), but pauses where the debug unit asks for it. Cycles are the
    /// same with it as without. Where the program was paused, it goes on without pausing again.
    ///
    /// # Errors
    /// As of `run_until`. The program stands before the instruction that it cannot execute.
    pub fn run_debugged(&mut self, until: Nanos) -> Result<Pause, Fault> {
        if self.debug.is_idle() {
            return self.run_until(until).map(|()| Pause::Reached);
        }
        loop {
            let exception = self.core.exception();
            self.synchronise();
            self.check_chip()?;
            if self.debug.steps && self.core.exception() != exception {
                return Ok(self.debug.pause(&self.core, Pause::Stepped));
            }
            let awake = self.core.try_wake();
            if awake && let Some(pause) = self.debug.objection(&mut self.core, &self.memory) {
                return Ok(self.debug.pause(&self.core, pause));
            }
            let end = self.soc.time().cycle_at(until);
            if self.core.cycles() >= end {
                return Ok(Pause::Reached);
            }
            let executed = self.core.instructions();
            self.run_to(if awake { self.core.cycles() + 1 } else { end })?;
            if self.debug.steps && self.core.instructions() > executed {
                return Ok(self.debug.pause(&self.core, Pause::Stepped));
            }
        }
    }

    /// Reads as a probe does: memory, and registers of peripherals with all that reading them does.
    /// The bytes that could be read, from the first on.
    pub fn probe_read(&mut self, address: u32, into: &mut [u8]) -> usize {
        if let Some(bytes) = self.memory.bytes(address, into.len()) {
            into.copy_from_slice(bytes);
            return into.len();
        }
        let width = widest(address, into.len());
        let mut read = 0;
        for chunk in into.chunks_exact_mut(width.bytes()) {
            let at = address.wrapping_add(read as u32);
            let Some(value) = self.probe_register(at, width, None) else {
                break;
            };
            chunk.copy_from_slice(&value.to_le_bytes()[..chunk.len()]);
            read += chunk.len();
        }
        read
    }

    /// Writes as a probe does: memory, the flash included, and registers of peripherals. False: not all
    /// of it could be written.
    pub fn probe_write(&mut self, address: u32, bytes: &[u8]) -> bool {
        if self.memory.place(address, bytes).is_some() {
            if address.wrapping_sub(FLASH) < FLASH_BYTES as u32 {
                self.core.forget_code();
            }
            return true;
        }
        let width = widest(address, bytes.len());
        let written = (address..).step_by(width.bytes());
        let mut chunks = bytes.chunks_exact(width.bytes()).zip(written);
        chunks.all(|(chunk, at)| {
            let mut word = [0; 4];
            word[..chunk.len()].copy_from_slice(chunk);
            self.probe_register(at, width, Some(u32::from_le_bytes(word)))
                .is_some()
        })
    }

    /// Reads a register, or writes it. What the chip refuses to a debugger does not stop the program.
    fn probe_register(&mut self, address: u32, width: Width, value: Option<u32>) -> Option<u32> {
        let (memory, soc) = (&mut self.memory, &mut self.soc);
        let stopped = soc.refusal().is_some();
        let done = match value {
            None => self.core.peek(memory, soc, address, width),
            Some(value) => {
                let done = self.core.poke(memory, soc, address, width, value);
                done.map(|()| value)
            }
        };
        if !stopped {
            self.soc.pardon();
        }
        done
    }
}

/// The widest accesses that a piece of memory can be read or written with.
fn widest(address: u32, bytes: usize) -> Width {
    match address as usize | bytes {
        any if any % 4 == 0 => Width::Word,
        any if any % 2 == 0 => Width::Half,
        _ => Width::Byte,
    }
}
