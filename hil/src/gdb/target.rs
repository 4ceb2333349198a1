//! The emulated board as GDB's target.

use core::convert::Infallible;

use emulator::core::Cause;
use emulator::machine::{Fault, Pause, Reason, Watched, Watchpoint};
use gdbstub::common::Signal;
use gdbstub::stub::SingleThreadStopReason;
use gdbstub::target::ext::base::BaseOps;
use gdbstub::target::ext::base::singlethread::{
    SingleThreadBase, SingleThreadResume, SingleThreadResumeOps, SingleThreadSingleStep,
    SingleThreadSingleStepOps,
};
use gdbstub::target::ext::breakpoints::{
    Breakpoints, BreakpointsOps, HwBreakpoint, HwBreakpointOps, HwWatchpoint, HwWatchpointOps,
    SwBreakpoint, SwBreakpointOps, WatchKind,
};
use gdbstub::target::ext::monitor_cmd::{ConsoleOutput, MonitorCmd, MonitorCmdOps, outputln};
use gdbstub::target::{Target, TargetError, TargetResult};

use super::registers::{CortexM4F, Registers};
use crate::board::emulated::Emulated;

/// What `monitor` answers to anything that it does not know.
const COMMANDS: &str = "monitor reset: the chip as after a reset, halted before its first instruction\n\
                        monitor info: virtual time, cycles and instructions since power-on";

impl Target for Emulated<'_> {
    type Arch = CortexM4F;
    type Error = Infallible;

    fn base_ops(&mut self) -> BaseOps<'_, CortexM4F, Infallible> {
        BaseOps::SingleThread(self)
    }

    fn support_breakpoints(&mut self) -> Option<BreakpointsOps<'_, Self>> {
        Some(self)
    }

    fn support_monitor_cmd(&mut self) -> Option<MonitorCmdOps<'_, Self>> {
        Some(self)
    }
}

impl SingleThreadBase for Emulated<'_> {
    fn read_registers(&mut self, registers: &mut Registers) -> TargetResult<(), Self> {
        *registers = Registers::of(self.machine().core());
        Ok(())
    }

    fn write_registers(&mut self, registers: &Registers) -> TargetResult<(), Self> {
        registers.write_to(self.machine().core());
        Ok(())
    }

    fn read_addrs(&mut self, address: u32, into: &mut [u8]) -> TargetResult<usize, Self> {
        match self.machine().probe_read(address, into) {
            0 => Err(TargetError::NonFatal),
            read => Ok(read),
        }
    }

    fn write_addrs(&mut self, address: u32, bytes: &[u8]) -> TargetResult<(), Self> {
        if self.machine().probe_write(address, bytes) {
            Ok(())
        } else {
            Err(TargetError::NonFatal)
        }
    }

    fn support_resume(&mut self) -> Option<SingleThreadResumeOps<'_, Self>> {
        Some(self)
    }
}

impl SingleThreadResume for Emulated<'_> {
    fn resume(&mut self, _: Option<Signal>) -> Result<(), Infallible> {
        self.machine().debug_unit().steps = false;
        Ok(())
    }

    fn support_single_step(&mut self) -> Option<SingleThreadSingleStepOps<'_, Self>> {
        Some(self)
    }
}

impl SingleThreadSingleStep for Emulated<'_> {
    fn step(&mut self, _: Option<Signal>) -> Result<(), Infallible> {
        self.machine().debug_unit().steps = true;
        Ok(())
    }
}

impl Breakpoints for Emulated<'_> {
    fn support_sw_breakpoint(&mut self) -> Option<SwBreakpointOps<'_, Self>> {
        Some(self)
    }

    fn support_hw_breakpoint(&mut self) -> Option<HwBreakpointOps<'_, Self>> {
        Some(self)
    }

    fn support_hw_watchpoint(&mut self) -> Option<HwWatchpointOps<'_, Self>> {
        Some(self)
    }
}

/// There are as many comparators as anybody asks for: no breakpoint need be written into memory.
impl SwBreakpoint for Emulated<'_> {
    fn add_sw_breakpoint(&mut self, address: u32, _: usize) -> TargetResult<bool, Self> {
        self.machine().debug_unit().set_breakpoint(address);
        Ok(true)
    }

    fn remove_sw_breakpoint(&mut self, address: u32, _: usize) -> TargetResult<bool, Self> {
        Ok(self.machine().debug_unit().clear_breakpoint(address))
    }
}

impl HwBreakpoint for Emulated<'_> {
    fn add_hw_breakpoint(&mut self, address: u32, kind: usize) -> TargetResult<bool, Self> {
        self.add_sw_breakpoint(address, kind)
    }

    fn remove_hw_breakpoint(&mut self, address: u32, kind: usize) -> TargetResult<bool, Self> {
        self.remove_sw_breakpoint(address, kind)
    }
}

impl HwWatchpoint for Emulated<'_> {
    fn add_hw_watchpoint(
        &mut self,
        address: u32,
        bytes: u32,
        kind: WatchKind,
    ) -> TargetResult<bool, Self> {
        let watchpoint = watchpoint(address, bytes, kind);
        self.machine().debug_unit().set_watchpoint(watchpoint);
        Ok(true)
    }

    fn remove_hw_watchpoint(
        &mut self,
        address: u32,
        bytes: u32,
        kind: WatchKind,
    ) -> TargetResult<bool, Self> {
        let watchpoint = watchpoint(address, bytes, kind);
        Ok(self.machine().debug_unit().clear_watchpoint(watchpoint))
    }
}

fn watchpoint(address: u32, bytes: u32, kind: WatchKind) -> Watchpoint {
    let on = match kind {
        WatchKind::Write => Watched::Writes,
        WatchKind::Read => Watched::Reads,
        WatchKind::ReadWrite => Watched::Accesses,
    };
    Watchpoint { address, bytes, on }
}

impl MonitorCmd for Emulated<'_> {
    fn handle_monitor_cmd(
        &mut self,
        command: &[u8],
        mut out: ConsoleOutput<'_>,
    ) -> Result<(), Infallible> {
        match command {
            b"reset" | b"reset halt" => {
                self.reset();
                outputln!(
                    out,
                    "reset; `maintenance flush register-cache` shows it, `continue` starts the firmware"
                );
            }
            b"info" => {
                let machine = self.machine();
                let (now, cycles) = (machine.now().0, machine.cycles());
                let instructions = machine.instructions();
                outputln!(
                    out,
                    "virtual time {now} ns, {cycles} cycles, {instructions} instructions"
                );
            }
            _ => outputln!(out, "{COMMANDS}"),
        }
        Ok(())
    }
}

/// What GDB is told of a pause; `None` where there is none.
pub fn stop_reason(pause: Pause) -> Option<SingleThreadStopReason<u32>> {
    Some(match pause {
        Pause::Reached => return None,
        Pause::Stepped => SingleThreadStopReason::DoneStep,
        Pause::Breakpoint => SingleThreadStopReason::Signal(Signal::SIGTRAP),
        Pause::Watchpoint {
            watchpoint,
            address,
        } => SingleThreadStopReason::Watch {
            tid: (),
            kind: match watchpoint.on {
                Watched::Writes => WatchKind::Write,
                Watched::Reads => WatchKind::Read,
                Watched::Accesses => WatchKind::ReadWrite,
            },
            addr: address,
        },
    })
}

/// The same of a fault.
pub fn fault_reason(fault: &Fault) -> SingleThreadStopReason<u32> {
    SingleThreadStopReason::Signal(match &fault.reason {
        Reason::Core(Cause::Breakpoint(_)) => Signal::SIGTRAP,
        Reason::Core(Cause::UndefinedInstruction(_) | Cause::Unpredictable(_)) => Signal::SIGILL,
        Reason::Core(_) | Reason::Chip(_) => Signal::SIGBUS,
    })
}
