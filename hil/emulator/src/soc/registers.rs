//! The bus: from an address to a block's register, with clock gates, narrow writes and the effects
//! one block's registers have on others.

use super::clocks::Effect;
use super::map::{Block, NarrowWrite, decode};
use super::reach::Reach;
use super::{Refusal, Soc, identity};
use crate::core::{Bus, BusFault, Cycle, Width};
use crate::memory::Memory;
use crate::wiring::Wiring;

/// GPIO registers that connect pins to alternate functions: MODER, AFRL, AFRH.
const PIN_ROUTING: [u32; 3] = [0x00, 0x20, 0x24];
/// TIM_CCER: a write to it may silence an output.
const TIMER_CCER: u32 = 0x20;

/// What `Reach` needs of a `Soc` while one of its blocks is borrowed.
macro_rules! reach {
    ($soc:ident, $memory:ident, $now:ident) => {
        &mut Reach {
            now: $now,
            time: &$soc.time,
            memory: $memory,
            dma: &mut $soc.dma,
            wiring: &mut $soc.wiring,
        }
    };
}

impl<W: Wiring> Bus for Soc<W> {
    fn read(
        &mut self,
        memory: &mut Memory,
        now: Cycle,
        address: u32,
        width: Width,
    ) -> Result<u32, BusFault> {
        self.advance(memory, now);
        let result = self.read_narrow(memory, now, address, width);
        self.settle(result)
    }

    fn write(
        &mut self,
        memory: &mut Memory,
        now: Cycle,
        address: u32,
        width: Width,
        value: u32,
    ) -> Result<(), BusFault> {
        self.advance(memory, now);
        let result = self.write_narrow(memory, now, address, width, value);
        self.settle(result)
    }
}

impl<W: Wiring> Soc<W> {
    /// Remembers why an access was refused.
    fn settle<T>(&mut self, result: Result<T, Refusal>) -> Result<T, BusFault> {
        self.next = None;
        result.map_err(|refusal| {
            self.refusal.get_or_insert(refusal);
            BusFault
        })
    }

    /// The block at `address` and the offset in it.
    fn locate(&self, address: u32, width: Width) -> Result<(Block, u32), Refusal> {
        let mask = match width {
            Width::Byte => 0,
            Width::Half => 1,
            Width::Word => 3,
        };
        if address & mask != 0 {
            return Err(Refusal::Unaligned { address });
        }
        let (block, offset) = decode(address).ok_or(Refusal::Unmapped { address })?;
        if let Block::Other(_) = block {
            return Err(Refusal::UnmodelledRegister { block, address });
        }
        Ok((block, offset))
    }

    fn clock_is_off(&self, block: Block) -> bool {
        block.gate().is_some_and(|gate| !self.rcc.enabled(gate))
    }

    fn read_narrow(
        &mut self,
        memory: &mut Memory,
        now: Cycle,
        address: u32,
        width: Width,
    ) -> Result<u32, Refusal> {
        let (block, offset) = self.locate(address, width)?;
        if self.clock_is_off(block) {
            return Ok(0);
        }
        let word = self.read_register(memory, now, block, offset & !3)?;
        Ok(word >> (8 * (address & 3)) & lanes(width))
    }

    fn write_narrow(
        &mut self,
        memory: &mut Memory,
        now: Cycle,
        address: u32,
        width: Width,
        value: u32,
    ) -> Result<(), Refusal> {
        let (block, offset) = self.locate(address, width)?;
        let register = offset & !3;
        let word = match (width, block.narrow_write()) {
            (Width::Word, _) => value,
            (Width::Byte, NarrowWrite::Repeated) => value.wrapping_mul(0x0101_0101),
            (Width::Half, NarrowWrite::Repeated) => value.wrapping_mul(0x0001_0001),
            (_, NarrowWrite::Lanes) => {
                let shift = 8 * (address & 3);
                let others = self.read_register(memory, now, block, register)?;
                others & !(lanes(width) << shift) | value << shift
            }
            (_, NarrowWrite::Refused) => return Err(Refusal::WordOnly { block, address }),
        };
        if !self.clock_is_off(block) {
            return self.write_register(memory, now, block, register, word);
        }
        // The write is lost. That does no harm if the register holds the value already.
        if self.read_register(memory, now, block, register)? == word {
            return Ok(());
        }
        Err(Refusal::ClockOff { block, address })
    }

    fn read_register(
        &mut self,
        memory: &mut Memory,
        now: Cycle,
        block: Block,
        offset: u32,
    ) -> Result<u32, Refusal> {
        match block {
            Block::Timer(number) => {
                let timer = &mut self.timers[usize::from(number) - 1];
                timer.sync(now);
                timer.read(offset)
            }
            Block::Usart(number) => self.usarts[usize::from(number) - 1].read(offset),
            Block::I2c(number) => {
                let i2c = &mut self.i2cs[usize::from(number) - 1];
                let value = i2c.read(offset, now);
                i2c.serve(reach!(self, memory, now));
                value
            }
            Block::Gpio(port) => self.ports[usize::from(port)].read(offset),
            Block::Dma(number) => self.dma.read(number, offset),
            Block::Rcc => self.rcc.read(offset, self.time.nanos(now)),
            Block::Power => self.power.read(offset),
            Block::Flash => self.flash.read(offset),
            Block::Syscfg => self.syscfg.read(offset),
            Block::Exti => self.exti.read(offset),
            Block::Dcmi => self.dcmi.read(offset),
            Block::Watchdog => self.watchdog.read(offset),
            Block::Debug => self.debug.read(offset),
            Block::Signature | Block::Other(_) => Ok(identity::signature(offset)),
        }
    }

    fn write_register(
        &mut self,
        memory: &mut Memory,
        now: Cycle,
        block: Block,
        offset: u32,
        value: u32,
    ) -> Result<(), Refusal> {
        match block {
            Block::Timer(number) => self.write_timer(now, number, offset, value),
            Block::Usart(number) => {
                let usart = &mut self.usarts[usize::from(number) - 1];
                usart.write(offset, value)?;
                usart.serve(now, memory, &mut self.dma);
                Ok(())
            }
            Block::I2c(number) => {
                let i2c = &mut self.i2cs[usize::from(number) - 1];
                let reach = reach!(self, memory, now);
                i2c.write(offset, value, reach)?;
                i2c.serve(reach);
                Ok(())
            }
            Block::Gpio(port) => self.write_gpio(now, port, offset, value),
            Block::Dma(number) => {
                self.dma.write(number, offset, value)?;
                self.serve_requests(memory, now);
                Ok(())
            }
            Block::Rcc => self.write_rcc(memory, now, offset, value),
            Block::Power => self.power.write(offset, value),
            Block::Flash => {
                self.flash.write(offset, value)?;
                self.flash.check(self.tree.hclk)
            }
            Block::Syscfg => self.syscfg.write(offset, value),
            Block::Exti => self.exti.write(offset, value),
            Block::Dcmi => {
                self.dcmi.write(offset, value)?;
                self.dcmi.serve(memory, &mut self.dma);
                Ok(())
            }
            Block::Watchdog => self.watchdog.write(offset, value, self.time.nanos(now)),
            Block::Debug => self.debug.write(offset, value),
            Block::Signature | Block::Other(_) => Ok(()),
        }
    }

    fn write_timer(
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

    fn write_gpio(&mut self, now: Cycle, port: u8, offset: u32, value: u32) -> Result<(), Refusal> {
        let instant = self.time.nanos(now);
        self.ports[usize::from(port)].write(offset, value, instant, &mut self.wiring)?;
        if PIN_ROUTING.contains(&offset) {
            self.refresh_outputs(now);
        }
        Ok(())
    }

    fn write_rcc(
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
            self.power = super::Power::new();
        }
        if held(Block::Syscfg) {
            self.syscfg = super::Syscfg::default();
        }
        self.refresh_outputs(now);
    }

    /// A stream was written: requests that waited may be served now.
    fn serve_requests(&mut self, memory: &mut Memory, now: Cycle) {
        for usart in &mut self.usarts {
            usart.serve(now, memory, &mut self.dma);
        }
        for i2c in &mut self.i2cs {
            i2c.serve(reach!(self, memory, now));
        }
        self.dcmi.serve(memory, &mut self.dma);
    }
}

fn lanes(width: Width) -> u32 {
    match width {
        Width::Byte => 0xff,
        Width::Half => 0xffff,
        Width::Word => u32::MAX,
    }
}
