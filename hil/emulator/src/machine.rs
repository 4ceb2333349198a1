//! The whole machine: core, memories, chip and wiring, driven through virtual time.

mod debug;
mod fault;
mod stack;
mod stepping;

pub use debug::{DebugUnit, Pause, Watched, Watchpoint};
pub use fault::{Fault, Reason};
pub use stepping::Step;

use crate::core::{Call, Core, Cycle, CycleModel, Exit, Stop};
use crate::image::{Image, ImageError};
use crate::memory::Memory;
use crate::soc::{
    DcmiCounters, FlashAssumption, FlashTiming, Lines, NEVER, ResetCause, Soc, UsartCounters,
};
use crate::time::Nanos;
use crate::trace::Event;
use crate::wiring::Wiring;

/// What the RAM holds before the firmware has written to it: an unlikely value, so that the deepest
/// stack can be read off afterwards.
const RAM_PAINT: u32 = 0xc0de_57ac;

/// An STM32F407VG with its firmware, and the board around it.
pub struct Machine<W> {
    core: Core,
    memory: Memory,
    soc: Soc<W>,
    image: Image,
    idle_cycles: Cycle,
    lines: Lines,
    debug: DebugUnit,
    flash_timing: FlashTiming,
    /// How fetches meet the flash, as far as it is not what the firmware programs.
    assumed_flash: FlashAssumption,
}

impl<W: Wiring> Machine<W> {
    /// Powers the chip on: `image` in flash, a crystal of `crystal_hz` on HSE, `wiring` around it.
    pub fn new(image: &Image, crystal_hz: u32, wiring: W) -> Result<Self, ImageError> {
        let mut memory = Memory::new();
        memory.fill_ram(RAM_PAINT);
        image.load(&mut memory)?;
        let mut core = Core::new();
        core.reset(&memory);
        let soc = Soc::new(crystal_hz, wiring);
        Ok(Self {
            core,
            memory,
            flash_timing: soc.flash_timing(),
            soc,
            image: image.clone(),
            idle_cycles: 0,
            lines: Lines::default(),
            debug: DebugUnit::default(),
            assumed_flash: FlashAssumption::default(),
        })
    }

    /// Runs the firmware until virtual time reaches `until`; it may pass it by the rest of one
    /// instruction.
    pub fn run_until(&mut self, until: Nanos) -> Result<(), Fault> {
        self.run_while(until, |_| true).map(|_| ())
    }

    /// Runs the firmware for as long as `condition` holds of the wiring, but not beyond `until`. The
    /// condition is looked at whenever the wiring may have changed. True: it still held at `until`.
    pub fn run_while(
        &mut self,
        until: Nanos,
        mut condition: impl FnMut(&W) -> bool,
    ) -> Result<bool, Fault> {
        loop {
            self.synchronise();
            self.check_chip()?;
            if !condition(self.soc.wiring()) {
                return Ok(false);
            }
            let end = self.soc.time().cycle_at(until);
            if self.core.cycles() >= end {
                return Ok(true);
            }
            self.run_to(end)?;
        }
    }

    /// Resets the chip, as after its watchdog expired: the firmware starts again, RAM keeps what it
    /// holds, virtual time and the board go on.
    pub fn reset(&mut self, cause: ResetCause) {
        let now = self.core.cycles();
        self.soc.reset(&mut self.memory, now, cause);
        self.core.reset(&self.memory);
        self.lines = Lines::default();
        self.flash_timing = self.soc.flash_timing();
    }

    /// Assumes another time of instructions than the default one from now on.
    pub fn set_cycle_model(&mut self, model: CycleModel) {
        self.core.set_cycle_model(model);
    }

    /// Assumes that fetches meet the flash like this, whatever the firmware programs; the default
    /// assumes nothing. It takes effect when the machine runs on.
    pub fn assume_flash(&mut self, assumption: FlashAssumption) {
        self.assumed_flash = assumption;
    }

    /// Brings the chip to the core's present, and the core's inputs up to date.
    fn synchronise(&mut self) {
        self.soc.advance(&mut self.memory, self.core.cycles());
        let timing = self.soc.flash_timing().assuming(self.assumed_flash);
        if timing != self.flash_timing {
            self.flash_timing = timing;
            self.core.set_flash_timing(
                u32::from(timing.wait_states),
                timing.prefetch,
                timing.instruction_cache,
                timing.data_cache,
            );
        }
        let lines = self.soc.lines();
        for (irq, level) in lines.changes(self.lines) {
            self.core.set_interrupt_line(irq, level);
        }
        self.lines = lines;
        self.core.take_pending_exceptions(&mut self.memory);
    }

    /// Executes, or sleeps, until the next event but not beyond `end`.
    fn run_to(&mut self, end: Cycle) -> Result<(), Fault> {
        let systick = self.core.next_systick().unwrap_or(NEVER);
        let next = self.soc.next_event().min(systick).min(end);
        if self.core.is_sleeping() && !self.core.try_wake() {
            self.idle_cycles += next.saturating_sub(self.core.cycles());
            self.core.advance_to(next);
            return Ok(());
        }
        match self.core.run(&mut self.memory, &mut self.soc, next) {
            Exit::Reached | Exit::Asleep | Exit::Synchronise => Ok(()),
            Exit::Stopped(stop) => Err(self.stopped(&stop)),
        }
    }

    /// What the chip cannot go on with, if anything.
    fn check_chip(&self) -> Result<(), Fault> {
        match self.soc.refusal() {
            None => Ok(()),
            Some(refusal) => {
                let reason = Reason::Chip(refusal.clone());
                Err(self.fault(reason, self.core.register(15), self.core.register(14)))
            }
        }
    }

    fn stopped(&self, stop: &Stop) -> Fault {
        let reason = match self.soc.refusal() {
            Some(refusal) => Reason::Chip(refusal.clone()),
            None => Reason::Core(stop.cause),
        };
        self.fault(reason, stop.pc, stop.lr)
    }

    fn fault(&self, reason: Reason, pc: u32, lr: u32) -> Fault {
        Fault::new(reason, self.now(), &self.image, pc, lr)
    }

    /// Virtual time since power-on.
    pub fn now(&self) -> Nanos {
        self.soc.time().nanos(self.core.cycles())
    }

    /// HCLK cycles since power-on.
    pub fn cycles(&self) -> Cycle {
        self.core.cycles()
    }

    /// Cycles the core has slept.
    pub fn idle_cycles(&self) -> Cycle {
        self.idle_cycles
    }

    /// Instructions executed.
    pub fn instructions(&self) -> u64 {
        self.core.instructions()
    }

    /// HCLK now, in hertz.
    pub fn hclk_hz(&self) -> u32 {
        self.soc.time().hertz()
    }

    /// The devices around the chip.
    pub fn wiring(&self) -> &W {
        self.soc.wiring()
    }

    /// The devices around the chip, to be changed between runs.
    pub fn wiring_mut(&mut self) -> &mut W {
        self.soc.wiring_mut()
    }

    /// The image in flash.
    pub fn image(&self) -> &Image {
        &self.image
    }

    /// Flash and RAM.
    pub fn memory(&self) -> &Memory {
        &self.memory
    }

    /// Flash and RAM, as a debug probe writes them between runs.
    pub fn memory_mut(&mut self) -> &mut Memory {
        &mut self.memory
    }

    /// Puts `bytes` on the RX line of USART `usart` (1..=6), from `at` on or as soon as the line is
    /// free, at the baud rate programmed when each byte begins. Bytes that begin while the receiver
    /// is off are lost and counted.
    pub fn usart_send(&mut self, usart: u8, at: Nanos, bytes: &[u8]) {
        self.soc.usart_send(usart, at, bytes);
    }

    /// Takes the bytes USART `usart` (1..=6) sent, each with the end of its stop bit.
    pub fn usart_received(&mut self, usart: u8) -> Vec<(Nanos, u8)> {
        self.soc.usart_received(usart)
    }

    /// What passed over the wires of USART `usart` (1..=6).
    pub fn usart_counters(&self, usart: u8) -> UsartCounters {
        self.soc.usart_counters(usart)
    }

    /// What became of the camera's frames.
    pub fn dcmi_counters(&self) -> DcmiCounters {
        self.soc.dcmi_counters()
    }

    /// A bus error, now, at DMA stream `stream` (0..=7) of controller `controller` (1 or 2): the
    /// stream stops with its transfer-error flag (RM0090 §10.3.18). One that is off feels nothing.
    /// The firmware notices when the machine runs on.
    pub fn fail_dma(&mut self, controller: u8, stream: u8) {
        self.soc.fail_dma(controller, stream);
    }

    /// Takes the bus away from DMA controller `controller` (1 or 2) as of now, or gives it back: a
    /// higher master, or a memory that does not answer. Peripherals wait, or overrun.
    pub fn stall_dma(&mut self, controller: u8, stalled: bool) {
        let now = self.core.cycles();
        self.soc
            .stall_dma(&mut self.memory, now, controller, stalled);
    }

    /// From now on records what happens: calls of [traced](Self::trace_calls) functions, exceptions,
    /// sleep, frames, bytes on serial wires and ends of DMA transfers.
    pub fn start_trace(&mut self) {
        self.core.start_trace();
        self.soc.start_trace();
    }

    /// What happened since the last time, in the order of its cycles. A byte on a wire that is under
    /// way has an end that is yet to come.
    pub fn take_trace(&mut self) -> Vec<Event> {
        let mut events = Vec::new();
        self.soc.take_trace(&mut events);
        self.core.take_trace(&mut events);
        // Stable: at one cycle the chip is first, which the core reacts to.
        events.sort_by_key(|event| event.at);
        events
    }

    /// From now on records every call of the function in flash at `address`.
    pub fn trace_calls(&mut self, address: u32) {
        self.core.trace_calls(address);
    }

    /// The traced calls that returned since the last time.
    pub fn take_calls(&mut self) -> Vec<Call> {
        self.core.take_calls()
    }

    /// The most bytes of stack used since power-on, interrupts included; `None` where the image
    /// does not say where its stack begins.
    pub fn stack_peak_bytes(&self) -> Option<u32> {
        stack::peak_bytes(&self.image, &self.memory, RAM_PAINT)
    }
}

#[cfg(test)]
mod tests;
