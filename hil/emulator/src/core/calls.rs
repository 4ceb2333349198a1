//! Records when chosen functions were entered and left.

use super::code_cache::CodeCache;
use super::{Core, Cycle};
use crate::trace::{Recorder, What};

/// One call of a traced function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Call {
    /// The function's first instruction.
    pub address: u32,
    /// Before that instruction.
    pub entered: Cycle,
    /// Before the first instruction after the call.
    pub returned: Cycle,
}

/// A call that has not returned: it does when the core is at `return_to` with the same stack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Open {
    address: u32,
    return_to: u32,
    sp: u32,
    entered: Cycle,
}

/// The traced functions and their calls.
#[derive(Debug, Default)]
pub(super) struct CallTrace {
    functions: Vec<u32>,
    open: Vec<Open>,
    finished: Vec<Call>,
}

impl CallTrace {
    /// Forgets the calls that have not returned.
    pub fn abandon(&mut self) {
        self.open.clear();
    }

    /// The core is about to execute a marked instruction at `pc`.
    fn reach(
        &mut self,
        code: &mut CodeCache,
        trace: &mut Recorder,
        [sp, lr, pc]: [u32; 3],
        now: Cycle,
    ) {
        while let Some(call) = self
            .open
            .pop_if(|call| call.return_to == pc && call.sp == sp)
        {
            trace.note(now, What::Returned(call.address));
            self.finished.push(Call {
                address: call.address,
                entered: call.entered,
                returned: now,
            });
        }
        if !self.functions.contains(&pc) {
            return;
        }
        let call = Open {
            address: pc,
            return_to: lr & !1,
            sp,
            entered: now,
        };
        // A loop back to the first instruction is not another call.
        let is_loop = |open: &Open| {
            Open {
                entered: now,
                ..*open
            } == call
        };
        if !self.open.last().is_some_and(is_loop) {
            trace.note(now, What::Entered(pc));
            self.open.push(call);
            code.trace(call.return_to);
        }
    }
}

impl Core {
    /// From now on records every call of the function in flash at `address`. It costs nothing but
    /// where such a function begins and where it returns to.
    pub fn trace_calls(&mut self, address: u32) {
        let address = address & !1;
        if !self.calls.functions.contains(&address) {
            self.calls.functions.push(address);
            self.code.trace(address);
        }
    }

    /// The calls that returned since the last time, in the order of their returns.
    pub fn take_calls(&mut self) -> Vec<Call> {
        std::mem::take(&mut self.calls.finished)
    }

    #[cold]
    #[inline(never)]
    pub(super) fn reach_traced(&mut self, pc: u32) {
        let [.., sp, lr, _] = self.registers.r;
        self.calls
            .reach(&mut self.code, &mut self.trace, [sp, lr, pc], self.cycles);
    }
}
