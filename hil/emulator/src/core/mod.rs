//! An ARM Cortex-M4F: ARMv7E-M with the single-precision FPU (ARM DDI0403E, DDI0439).
//!
//! Everything the firmware of an STM32F4 can do to its core is here: all of Thumb-2 with the DSP and
//! floating-point extensions, nested exceptions with lazy stacking, SysTick, the cycle counter, and
//! the flash accelerator that decides how fast code runs. Faults are not taken as exceptions; they
//! end the run with a [`Stop`]. Left out: the MPU, privilege, floating-point modes and cumulative
//! exception flags, and interrupting LDM and division half-way.

mod access;
mod bus;
mod calls;
mod code_cache;
mod cycle_model;
mod cycles;
mod debug;
mod decode;
mod dwt;
mod exceptions;
mod execute;
mod flags;
mod flash_accelerator;
mod fpu;
mod hazards;
mod instruction;
mod nvic;
mod private_bus;
mod registers;
mod stop;
mod system_control;
mod systick;

pub use access::Access;
pub use bus::{Bus, BusFault, Cycle, Width};
pub use calls::Call;
pub use cycle_model::CycleModel;
pub use debug::Special;
pub use stop::{Cause, Exit, Stop};

use crate::memory::Memory;
use crate::trace::{Event, Recorder, What};
use calls::CallTrace;
use code_cache::CodeCache;
use dwt::Dwt;
use exceptions::Sleep;
use flash_accelerator::FlashAccelerator;
use fpu::FpuControl;
use instruction::LR;
use nvic::Nvic;
use registers::Registers;
use system_control::SystemControl;
use systick::SysTick;

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
    registers: Registers,
    /// The event register of WFE.
    event: bool,
    sleep: Sleep,
    /// The local monitor of LDREX and STREX.
    exclusive: bool,

    nvic: Nvic,
    scb: SystemControl,
    systick: SysTick,
    dwt: Dwt,
    fpu: FpuControl,
    /// Floating-point instructions may execute right away.
    fpu_ready: bool,

    cycles: Cycle,
    instructions: u64,
    /// Where the current run ends at the latest. Zero: behind the current instruction.
    horizon: Cycle,
    /// Why it cannot go on.
    fault: Option<Cause>,

    code: CodeCache,
    accelerator: FlashAccelerator,
    calls: CallTrace,
    trace: Recorder,
}

impl Default for Core {
    fn default() -> Self {
        Self::new()
    }
}

impl Core {
    /// A core at cycle 0, not reset yet.
    pub fn new() -> Self {
        Self {
            registers: Registers::at_reset(0, 0),
            event: false,
            sleep: Sleep::Awake,
            exclusive: false,
            nvic: Nvic::new(),
            scb: SystemControl::new(),
            systick: SysTick::default(),
            dwt: Dwt::default(),
            fpu: FpuControl::new(),
            fpu_ready: false,
            cycles: 0,
            instructions: 0,
            horizon: 0,
            fault: None,
            code: CodeCache::new(),
            accelerator: FlashAccelerator::new(),
            calls: CallTrace::default(),
            trace: Recorder::default(),
        }
    }

    /// Reset: everything but the cycle and instruction counts and what is traced. Stack pointer and
    /// entry point come from the vector table at address 0. Forgets the decoded instructions, so call
    /// it after an image was loaded.
    pub fn reset(&mut self, memory: &Memory) {
        let vector = |address| memory.read32(address).unwrap_or(0);
        let entry = vector(4);
        self.registers = Registers::at_reset(vector(0), entry);
        self.event = false;
        self.sleep = Sleep::Awake;
        self.exclusive = false;
        self.nvic = Nvic::new();
        self.scb = SystemControl::new();
        self.systick = SysTick::default();
        self.dwt = Dwt::default();
        self.fpu = FpuControl::new();
        self.fpu_ready = false;
        self.fault = (entry & 1 == 0).then_some(Cause::ArmState(entry));
        self.code.clear();
        self.accelerator = FlashAccelerator::new();
        self.calls.abandon();
        self.trace.note(self.cycles, What::Reset);
    }

    /// Cycles since power-on, sleep included.
    pub fn cycles(&self) -> Cycle {
        self.cycles
    }

    /// Instructions executed, those that failed their condition included.
    pub fn instructions(&self) -> u64 {
        self.instructions
    }

    /// What the firmware wrote to FLASH_ACR (RM0090 §3.9.1).
    pub fn set_flash_timing(
        &mut self,
        wait_states: u32,
        prefetch: bool,
        icache: bool,
        dcache: bool,
    ) {
        self.accelerator
            .set_timing(wait_states, prefetch, icache, dcache);
    }

    /// What the manuals leave open of an instruction's time; code in RAM keeps the default.
    pub fn set_cycle_model(&mut self, model: CycleModel) {
        self.code.set_refill(model.branch_refill());
    }

    /// A general register: 0 to 12, 13 the stack pointer in use, 14 the link register, 15 the address
    /// of the next instruction. Others read as 0.
    pub fn register(&self, number: u8) -> u32 {
        match number {
            instruction::PC => self.registers.pc,
            _ => self
                .registers
                .r
                .get(usize::from(number))
                .copied()
                .unwrap_or(0),
        }
    }

    /// Sets a general register, numbered as in [`register`](Self::register).
    pub fn set_register(&mut self, number: u8, value: u32) {
        match number {
            instruction::PC => self.registers.pc = value & !1,
            0..=LR => self.registers.r[usize::from(number)] = value,
            _ => {}
        }
    }

    /// An S register's bits, 0 to 31. Others read as 0.
    pub fn float_register(&self, number: u8) -> u32 {
        self.registers
            .s
            .get(usize::from(number))
            .copied()
            .unwrap_or(0)
    }

    /// APSR, IPSR and EPSR together.
    pub fn xpsr(&self) -> u32 {
        self.registers.xpsr()
    }

    /// From now on records calls of traced functions, exceptions and sleep.
    pub fn start_trace(&mut self) {
        self.trace.start();
    }

    /// Appends what was recorded since the last time, in its order.
    pub fn take_trace(&mut self, into: &mut Vec<Event>) {
        self.trace.take(into);
    }

    /// Ends the run at the current instruction.
    #[cold]
    #[inline(never)]
    fn fail(&mut self, cause: Cause) {
        self.fault.get_or_insert(cause);
        self.horizon = 0;
    }
}

#[cfg(test)]
mod tests;
