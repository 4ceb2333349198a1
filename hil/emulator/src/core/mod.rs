//! An ARM Cortex-M4F: ARMv7E-M with the single-precision FPU (ARM DDI0403E, DDI0439).

mod bus;
mod calls;
mod stop;

pub use bus::{Bus, BusFault, Cycle, Width};
pub use calls::Call;
pub use stop::{Cause, Exit, Stop};

use crate::memory::Memory;

/// The core with its private peripherals: NVIC, SCB, SysTick, DWT and FPU.
///
/// The owner drives it like this, for as long as it likes:
///
/// 1. bring the peripherals to [`cycles`](Self::cycles), and set the interrupt lines that changed;
/// 2. [`take_pending_exceptions`](Self::take_pending_exceptions);
/// 3. if [`is_sleeping`](Self::is_sleeping) and not [`try_wake`](Self::try_wake):
///    [`advance_to`](Self::advance_to) the next event, else [`run`](Self::run) until then. The next
///    event is the earliest of the peripherals' and [`next_systick`](Self::next_systick).
pub struct Core {
    cycles: Cycle,
}

impl Default for Core {
    fn default() -> Self {
        Self::new()
    }
}

#[allow(unused_variables)]
impl Core {
    /// A core at cycle 0, not reset yet.
    pub fn new() -> Self {
        Self { cycles: 0 }
    }

    /// Reset: everything but the cycle and instruction counts. Forgets the decoded instructions, so
    /// call it after an image was loaded.
    pub fn reset(&mut self, memory: &Memory) {}

    /// Cycles since power-on, sleep included.
    pub fn cycles(&self) -> Cycle {
        self.cycles
    }

    /// Instructions executed, those that failed their condition included.
    pub fn instructions(&self) -> u64 {
        0
    }

    /// Lets time pass while asleep. Never goes back.
    pub fn advance_to(&mut self, cycle: Cycle) {
        self.cycles = self.cycles.max(cycle);
    }

    /// Drives one of the 82 interrupt inputs. A rising level makes it pending; a level that is still
    /// high when the handler returns makes it pending again. Cheap when nothing changed.
    pub fn set_interrupt_line(&mut self, irq: u8, level: bool) {}

    /// Advances SysTick to now, then enters the highest pending exception that may preempt.
    /// A stacking fault is reported by the next [`run`](Self::run).
    pub fn take_pending_exceptions(&mut self, memory: &mut Memory) {}

    /// Asleep in WFE or WFI.
    pub fn is_sleeping(&self) -> bool {
        false
    }

    /// Wakes if there is a reason to: the event register (WFE), or a pending interrupt that only
    /// PRIMASK holds back (WFI). True: awake.
    pub fn try_wake(&mut self) -> bool {
        true
    }

    /// When SysTick makes its exception pending next.
    pub fn next_systick(&self) -> Option<Cycle> {
        None
    }

    /// Executes until the cycle counter reaches `until`, or for one of the reasons of [`Exit`].
    pub fn run(&mut self, memory: &mut Memory, bus: &mut dyn Bus, until: Cycle) -> Exit {
        Exit::Reached
    }

    /// What the firmware wrote to FLASH_ACR (RM0090 §3.9.1).
    pub fn set_flash_timing(
        &mut self,
        wait_states: u32,
        prefetch: bool,
        icache: bool,
        dcache: bool,
    ) {
    }

    /// From now on records every call of the function in flash at `address`.
    pub fn trace_calls(&mut self, address: u32) {}

    /// The calls that returned since the last time, in the order of their returns.
    pub fn take_calls(&mut self) -> Vec<Call> {
        Vec::new()
    }

    /// A general register: 0 to 12, 13 the stack pointer in use, 14 the link register, 15 the address
    /// of the next instruction. Others read as 0.
    pub fn register(&self, number: u8) -> u32 {
        0
    }

    /// Sets a general register, numbered as in [`register`](Self::register).
    pub fn set_register(&mut self, number: u8, value: u32) {}
}
