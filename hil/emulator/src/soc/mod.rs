//! The STM32F407 around the core: clocks, memory-mapped blocks, and the schedule that ties them to
//! the cycle counter (RM0090).
//!
//! Blocks act at the exact cycle of their events and in the order of those cycles, whenever
//! somebody looks; so a run does not depend on how it is sliced. What the model does not have stops
//! the run with a [`Refusal`].

mod awake;
mod bridges;
mod clocks;
mod dcmi;
mod dma;
mod effects;
mod exti;
mod flash;
mod gpio;
mod i2c;
mod identity;
mod interrupts;
mod map;
mod outputs;
mod power;
mod reach;
mod refusal;
mod registers;
mod timeline;
mod timer;
mod usart;
mod watchdog;

pub use clocks::ResetCause;
pub use dcmi::DcmiCounters;
pub use flash::{FlashAssumption, FlashTiming};
pub use interrupts::Lines;
pub use map::Block;
pub use refusal::Refusal;
pub use timeline::{NEVER, Timeline};
pub use usart::UsartCounters;

use crate::core::Cycle;
use crate::memory::Memory;
use crate::time::Nanos;
use crate::trace::{Event, Recorder, What};
use crate::wiring::{CameraSignal, Wiring};
use awake::Awake;
use bridges::Bridges;
use clocks::{ClockTree, Rcc};
use dcmi::Dcmi;
use dma::Dma;
use exti::{Exti, Syscfg};
use flash::Flash;
use gpio::Gpio;
use i2c::I2c;
use identity::Debug;
use outputs::{Outputs, Sources};
use power::Power;
use reach::reach;
use timer::Timer;
use usart::Usart;
use watchdog::Watchdog;

/// Everything on the chip but the core and the plain memories, and the wiring around it.
pub struct Soc<W> {
    wiring: W,
    time: Timeline,
    tree: ClockTree,
    rcc: Rcc,
    power: Power,
    flash: Flash,
    /// Port A first.
    ports: [Gpio; 9],
    syscfg: Syscfg,
    exti: Exti,
    dma: Dma,
    /// TIM1 first.
    timers: [Timer; 14],
    /// USART1 first.
    usarts: [Usart; 6],
    /// I2C1 first.
    i2cs: [I2c; 3],
    dcmi: Dcmi,
    watchdog: Watchdog,
    debug: Debug,
    outputs: Outputs,
    bridges: Bridges,
    awake: Awake,
    /// The camera had nothing to say at this instant: it is not asked again before the next.
    camera_silent_at: Option<Nanos>,
    /// The next event, until something may have changed it.
    next: Option<Cycle>,
    refusal: Option<Refusal>,
    trace: Recorder,
}

impl<W: Wiring> Soc<W> {
    /// The chip after power-on, with a crystal of `crystal_hz` and `wiring` around it.
    pub fn new(crystal_hz: u32, wiring: W) -> Self {
        Self {
            wiring,
            time: Timeline::new(ClockTree::RESET.hclk),
            tree: ClockTree::RESET,
            rcc: Rcc::new(crystal_hz),
            power: Power::new(),
            flash: Flash::default(),
            ports: core::array::from_fn(|port| Gpio::new(port as u8)),
            syscfg: Syscfg::default(),
            exti: Exti::default(),
            dma: Dma::new(),
            timers: core::array::from_fn(|index| Timer::new(index as u8 + 1)),
            usarts: core::array::from_fn(|index| Usart::new(index as u8 + 1)),
            i2cs: core::array::from_fn(|index| I2c::new(index as u8 + 1)),
            dcmi: Dcmi::new(),
            watchdog: Watchdog::new(),
            debug: Debug::default(),
            outputs: Outputs::new(),
            bridges: Bridges::default(),
            awake: Awake::default(),
            camera_silent_at: None,
            next: None,
            refusal: None,
            trace: Recorder::default(),
        }
    }

    /// A system reset at `now`. What is on the wires goes on, and the counters with it; pins float,
    /// of which the wiring is not told.
    pub fn reset(&mut self, memory: &mut Memory, now: Cycle, cause: ResetCause) {
        self.rcc.reset(cause);
        self.tree = ClockTree::RESET;
        self.time.change(now, self.tree.hclk);
        self.power = Power::new();
        self.flash = Flash::default();
        self.syscfg = Syscfg::default();
        self.exti = Exti::default();
        self.dma.restart();
        self.watchdog = Watchdog::new();
        self.timers = core::array::from_fn(|index| Timer::new(index as u8 + 1));
        self.ports.iter_mut().for_each(Gpio::reset);
        self.usarts.iter_mut().for_each(Usart::reset);
        self.dcmi.reset();
        for i2c in &mut self.i2cs {
            i2c.reset(reach!(self, memory, now));
        }
        self.refusal = None;
        self.next = None;
        self.refresh_outputs(now);
    }

    /// The devices around the chip.
    pub fn wiring(&self) -> &W {
        &self.wiring
    }

    /// The devices around the chip, to be changed from outside.
    pub fn wiring_mut(&mut self) -> &mut W {
        self.next = None;
        self.camera_silent_at = None;
        &mut self.wiring
    }

    /// The relation of cycles to virtual time.
    pub fn time(&self) -> &Timeline {
        &self.time
    }

    /// How fetches meet the flash memory now.
    pub fn flash_timing(&self) -> FlashTiming {
        self.flash.timing()
    }

    /// Why the run must stop, if it must.
    pub fn refusal(&self) -> Option<&Refusal> {
        self.refusal.as_ref()
    }

    /// Forgets why the run must stop: it was a debugger that asked for too much.
    pub fn pardon(&mut self) {
        self.refusal = None;
    }

    /// What became of the camera's frames.
    pub fn dcmi_counters(&self) -> DcmiCounters {
        self.dcmi.counters()
    }

    /// USART `number`, 1..=6.
    fn usart(&mut self, number: u8) -> Option<&mut Usart> {
        self.next = None;
        self.awake.wake(Block::Usart(number));
        self.usarts.get_mut(usize::from(number).checked_sub(1)?)
    }

    /// Puts bytes on the RX line of USART `number` (1..=6; others are not connected).
    pub fn usart_send(&mut self, number: u8, at: Nanos, bytes: &[u8]) {
        if let Some(usart) = self.usart(number) {
            usart.send(at, bytes);
        }
    }

    /// Takes the bytes USART `number` sent.
    pub fn usart_received(&mut self, number: u8) -> Vec<(Nanos, u8)> {
        self.usart(number).map(Usart::take_sent).unwrap_or_default()
    }

    /// What passed over the wires of USART `number`.
    pub fn usart_counters(&self, number: u8) -> UsartCounters {
        let usart = self.usarts.get(usize::from(number).wrapping_sub(1));
        usart.map(Usart::counters).unwrap_or_default()
    }

    /// The bus refuses the transfer of a DMA stream.
    pub fn fail_dma(&mut self, controller: u8, stream: u8) {
        self.next = None;
        self.dma.fail(controller, stream);
    }

    /// The bus is taken away from a DMA controller, or given back at `now`.
    pub fn stall_dma(&mut self, memory: &mut Memory, now: Cycle, controller: u8, stalled: bool) {
        self.next = None;
        self.dma.stall(controller, stalled);
        if !stalled {
            self.dma.set_time(now);
            self.serve_requests(memory, now);
        }
    }

    /// From now on records the camera's edges, the bytes on serial wires and the ends of DMA
    /// transfers.
    pub fn start_trace(&mut self) {
        self.trace.start();
        self.dma.trace.start();
        self.usarts.iter_mut().for_each(|usart| usart.trace.start());
    }

    /// Appends what was recorded since the last time, block by block.
    pub fn take_trace(&mut self, into: &mut Vec<Event>) {
        self.trace.take(into);
        self.dma.trace.take(into);
        for usart in &mut self.usarts {
            usart.trace.take(into);
        }
    }

    /// The next cycle at which a block does something by itself.
    pub fn next_event(&mut self) -> Cycle {
        if let Some(next) = self.next {
            return next;
        }
        let awake = self.awake;
        let timers = awake.timers().map(|index| self.timers[index].next());
        let usarts = awake
            .usarts()
            .map(|index| self.usarts[index].next(&self.time));
        let i2cs = awake.i2cs().map(|index| self.i2cs[index].next());
        let rest = [self.camera_cycle(), self.watchdog_cycle()];
        let all = timers.chain(usarts).chain(i2cs).chain(rest);
        let next = all.min().unwrap_or(NEVER);
        self.next = Some(next);
        next
    }

    fn camera_cycle(&self) -> Cycle {
        let due = self.wiring.camera_next();
        let due = due.filter(|&due| self.camera_silent_at.is_none_or(|silent| due > silent));
        due.map_or(NEVER, |due| self.time.cycle_at(due))
    }

    fn watchdog_cycle(&self) -> Cycle {
        let expiry = self.watchdog.expires();
        expiry.map_or(NEVER, |expiry| self.time.cycle_at(expiry))
    }

    /// Performs all events up to and including `now`, in their order.
    pub fn advance(&mut self, memory: &mut Memory, now: Cycle) {
        while self.refusal.is_none() {
            let due = self.next_event();
            if due > now {
                return;
            }
            self.next = None;
            self.perform(memory, due);
        }
    }

    /// Performs the events of one cycle.
    fn perform(&mut self, memory: &mut Memory, now: Cycle) {
        self.dma.set_time(now);
        if self.watchdog_cycle() <= now {
            self.refusal = Some(Refusal::Watchdog);
            return;
        }
        let mut outputs = false;
        for index in self.awake.timers() {
            let timer = &mut self.timers[index];
            if timer.next() <= now {
                timer.sync(now);
                outputs |= timer.drives_pins();
            }
        }
        if outputs {
            self.refresh_outputs(now);
        }
        for index in self.awake.usarts() {
            let usart = &mut self.usarts[index];
            if usart.next(&self.time) <= now {
                usart.advance(now, &self.time, memory, &mut self.dma);
            }
        }
        for index in self.awake.i2cs() {
            let i2c = &mut self.i2cs[index];
            if i2c.next() <= now {
                i2c.advance(reach!(self, memory, now));
            }
        }
        if self.camera_cycle() <= now {
            self.camera_edge(memory);
        }
    }

    fn camera_edge(&mut self, memory: &mut Memory) {
        let Some(due) = self.wiring.camera_next() else {
            return;
        };
        let Some(signal) = self.wiring.camera_signal(due) else {
            self.camera_silent_at = Some(due);
            return;
        };
        let what = match signal {
            CameraSignal::FrameStart => What::FrameStart,
            CameraSignal::Line(_) => What::Line,
            CameraSignal::FrameEnd => What::FrameEnd,
        };
        self.trace.note(self.time.cycle_at(due), what);
        self.dcmi.signal(signal, memory, &mut self.dma);
    }

    /// The level of every interrupt line.
    pub fn lines(&self) -> Lines {
        let mut lines = Lines::default();
        let awake = self.awake;
        awake
            .timers()
            .for_each(|index| self.timers[index].drive(&mut lines));
        awake
            .usarts()
            .for_each(|index| self.usarts[index].drive(&mut lines));
        awake
            .i2cs()
            .for_each(|index| self.i2cs[index].drive(&mut lines));
        self.dma.drive(&mut lines);
        self.dcmi.drive(&mut lines);
        self.exti.drive(&mut lines);
        lines
    }

    fn refresh_outputs(&mut self, now: Cycle) {
        let sources = Sources {
            rcc: &self.rcc,
            tree: self.tree,
            timers: &self.timers,
            ports: &self.ports,
        };
        let now = self.time.nanos(now);
        self.outputs.refresh(&sources, now, &mut self.wiring);
    }
}

#[cfg(test)]
mod tests;
