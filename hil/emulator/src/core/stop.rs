//! Why the interpreter gave the control back.

/// Why [`run`](super::Core::run) returned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// The cycle counter reached the given cycle.
    Reached,
    /// WFE, WFI or sleep-on-exit: nothing more will happen before an event or an exception.
    Asleep,
    /// A peripheral was accessed, or an exception may be due: look at the lines and the schedule.
    Synchronise,
    /// The program cannot go on.
    Stopped(Stop),
}

/// Where and why a program cannot go on. The core takes no fault exceptions: what would be a fault
/// on the chip ends the run here, with the evidence still in place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{cause}, pc {pc:#010x}, lr {lr:#010x}")]
pub struct Stop {
    /// Address of the instruction that stopped.
    pub pc: u32,
    /// The link register at that moment.
    pub lr: u32,
    /// What happened.
    pub cause: Cause,
}

/// What stopped a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Cause {
    /// BKPT. The program counter stays on it.
    #[error("breakpoint {0}")]
    Breakpoint(u8),
    /// An encoding that has no meaning, UDF included. 16-bit opcodes have a zero upper half.
    #[error("undefined instruction {0:#x}")]
    UndefinedInstruction(u32),
    /// An encoding whose effect the architecture leaves open.
    #[error("unpredictable instruction {0:#x}")]
    Unpredictable(u32),
    /// MRS or MSR of a special register that does not exist, by its number.
    #[error("special register {0} does not exist")]
    SpecialRegister(u8),
    /// A load or store that nothing answers.
    #[error("bus fault: {} {address:#010x}", if *.write { "write to" } else { "read of" })]
    BusFault {
        /// The address that was accessed.
        address: u32,
        /// A store, not a load.
        write: bool,
    },
    /// A register, or a value of a register, of the core's own peripherals that is not modelled.
    #[error("core register not modelled: {} {address:#010x}", if *.write { "write to" } else { "read of" })]
    CoreRegister {
        /// The address that was accessed.
        address: u32,
        /// A store, not a load.
        write: bool,
    },
    /// An access that must be aligned and is not: LDM, LDRD, LDREX and their like.
    #[error("unaligned access to {0:#010x}")]
    Unaligned(u32),
    /// Instruction fetch from where there is no memory.
    #[error("fetch from {0:#010x}")]
    Fetch(u32),
    /// A branch to an address without the Thumb bit.
    #[error("branch to ARM state at {0:#010x}")]
    ArmState(u32),
    /// A floating-point instruction while CPACR keeps the FPU off.
    #[error("the FPU is off")]
    FpuOff,
    /// A floating-point mode (rounding, flush to zero, default NaN) that is not modelled.
    #[error("floating-point mode not modelled: FPSCR {0:#010x}")]
    FpuMode(u32),
    /// Division by zero while CCR.DIV_0_TRP asks for a trap.
    #[error("division by zero")]
    DivisionByZero,
    /// A return to a state that is not there to return to.
    #[error("invalid exception return {0:#010x}")]
    ExceptionReturn(u32),
    /// SVC where its exception cannot be taken; the chip would escalate to HardFault.
    #[error("SVC {0} at a priority that masks it")]
    MaskedSvc(u8),
    /// The software asked for a reset (AIRCR.SYSRESETREQ).
    #[error("system reset requested")]
    ResetRequested,
}
