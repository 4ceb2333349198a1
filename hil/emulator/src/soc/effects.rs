//! What one block's registers do to others: clocks, resets, outputs and waiting requests.

use super::clocks::Effect;
use super::map::Block;
use super::reach::reach;
use super::{Power, Refusal, Soc, Syscfg};
use crate::core::Cycle;
use crate::memory::Memory;
use crate::wiring::Wiring;

/// GPIO registers that connect pins to alternate functions: MODER, AFRL, AFRH.
const PIN_ROUTING: [u32; 3] = [0x00, 0x20, 0x24];
/// TIM_CCER: a write to it may silence an output.
const TIMER_CCER: u32 = 0x20;

impl<W: Wiring> Soc<W> {
    pub(super) fn write_timer(
        &mut self,
        now: Cycle,
        number: u8,
        offset: u32,
        value: u32,
    ) -> Result<(), Refusal> {
        let timer = &mut self.timers[usize::from(number) - 1];
        timer.sync(now);
        timer.write(offset, value, now)?;
        if timer.drives_pins() || offset == TIMER_CCER {
            self.refresh_outputs(now);
        }
        Ok(())
    }

    pub(super) fn write_gpio(
        &mut self,
        now: Cycle,
        port: u8,
        offset: u32,
        value: u32,
    ) -> Result<(), Refusal> {
        let instant = self.time.nanos(now);
        self.ports[usize::from(port)].write(offset, value, instant, &mut self.wiring)?;
        if PIN_ROUTING.contains(&offset) {
            self.refresh_outputs(now);
        }
        Ok(())
    }

    pub(super) fn write_rcc(
        &mut self,
        memory: &mut Memory,
        now: Cycle,
        offset: u32,
        value: u32,
    ) -> Result<(), Refusal> {
        match self.rcc.write(offset, value, self.time.nanos(now))? {
            Effect::None => Ok(()),
            Effect::Clocks => self.change_clocks(now),
            Effect::Reset => {
                self.reset_blocks(memory, now);
                Ok(())
            }
        }
    }

    /// Carries a change of the clock tree or of a gate to everything that counts its clocks.
    fn change_clocks(&mut self, now: Cycle) -> Result<(), Refusal> {
        let tree = self.rcc.tree()?;
        self.flash.check(tree.hclk)?;
        if tree.hclk != self.tree.hclk {
            self.time.change(now, tree.hclk);
        }
        self.tree = tree;
        for (number, timer) in (1..).zip(&mut self.timers) {
            let block = Block::Timer(number);
            let runs = block.gate().is_none_or(|gate| self.rcc.enabled(gate));
            timer.set_clock(now, if runs { tree.timer_cycles(block) } else { 0 });
        }
        for (number, usart) in (1..).zip(&mut self.usarts) {
            usart.set_clock(tree.bus_cycles(Block::Usart(number)));
        }
        for (number, i2c) in (1..).zip(&mut self.i2cs) {
            i2c.set_clock(tree.bus_cycles(Block::I2c(number)));
        }
        self.refresh_outputs(now);
        Ok(())
    }

    /// Resets every block whose reset bit is set.
    fn reset_blocks(&mut self, memory: &mut Memory, now: Cycle) {
        let rcc = self.rcc.clone();
        let held = |block: Block| block.gate().is_some_and(|gate| rcc.in_reset(gate));
        for (number, timer) in (1..).zip(&mut self.timers) {
            if held(Block::Timer(number)) {
                timer.reset();
            }
        }
        for (number, usart) in (1..).zip(&mut self.usarts) {
            if held(Block::Usart(number)) {
                usart.reset();
            }
        }
        for (number, i2c) in (1..).zip(&mut self.i2cs) {
            if held(Block::I2c(number)) {
                i2c.reset(reach!(self, memory, now));
            }
        }
        for (number, port) in (0..).zip(&mut self.ports) {
            if held(Block::Gpio(number)) {
                port.reset();
            }
        }
        for number in [1, 2] {
            if held(Block::Dma(number)) {
                self.dma.reset(number);
            }
        }
        if held(Block::Dcmi) {
            self.dcmi.reset();
        }
        if held(Block::Power) {
            self.power = Power::new();
        }
        if held(Block::Syscfg) {
            self.syscfg = Syscfg::default();
        }
        self.refresh_outputs(now);
    }

    /// A stream was written: requests that waited may be served now.
    pub(super) fn serve_requests(&mut self, memory: &mut Memory, now: Cycle) {
        for usart in &mut self.usarts {
            usart.serve(now, memory, &mut self.dma);
        }
        for i2c in &mut self.i2cs {
            i2c.serve(reach!(self, memory, now));
        }
        self.dcmi.serve(memory, &mut self.dma);
    }
}
