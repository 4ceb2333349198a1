//! The machine instruction by instruction, for exact profiles.

use super::{Fault, Machine};
use crate::core::{Cycle, Exit};
use crate::soc::NEVER;
use crate::time::Nanos;
use crate::wiring::Wiring;

/// One instruction that was executed, and the context it ran in, as it was before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// Its address.
    pub pc: u32,
    /// The stack pointer.
    pub sp: u32,
    /// The link register.
    pub lr: u32,
    /// The exception that was being handled; 0 in thread mode.
    pub exception: u8,
    /// What it took, with the stacking of an exception right before it.
    pub cycles: Cycle,
}

impl<W: Wiring> Machine<W> {
    /// Does what [`run_until`](Self::run_until) does, cycle for cycle, and shows every instruction to
    /// `see`: slower by an order of magnitude.
    pub fn run_stepwise(&mut self, until: Nanos, mut see: impl FnMut(Step)) -> Result<(), Fault> {
        let mut seen = self.core.cycles();
        loop {
            self.synchronise();
            self.check_chip()?;
            let end = self.soc.time().cycle_at(until);
            if self.core.cycles() >= end {
                return Ok(());
            }
            if self.core.is_sleeping() && !self.core.try_wake() {
                self.run_to(end)?;
                seen = self.core.cycles();
                continue;
            }
            let systick = self.core.next_systick().unwrap_or(NEVER);
            let next = self.soc.next_event().min(systick).min(end);
            self.step_to(next, &mut seen, &mut see)?;
        }
    }

    /// Executes until `next` or for as long as nothing has to be brought up to date.
    fn step_to(
        &mut self,
        next: Cycle,
        seen: &mut Cycle,
        see: &mut impl FnMut(Step),
    ) -> Result<(), Fault> {
        loop {
            let register = |number| self.core.register(number);
            let step = Step {
                pc: register(15),
                sp: register(13),
                lr: register(14),
                exception: self.core.xpsr() as u8,
                cycles: 0,
            };
            let exit = self.core.run_one(&mut self.memory, &mut self.soc);
            see(Step {
                cycles: self.core.cycles() - *seen,
                ..step
            });
            *seen = self.core.cycles();
            match exit {
                Exit::Stopped(stop) => return Err(self.stopped(&stop)),
                Exit::Reached if self.core.cycles() < next => {}
                Exit::Reached | Exit::Asleep | Exit::Synchronise => return Ok(()),
            }
        }
    }
}
