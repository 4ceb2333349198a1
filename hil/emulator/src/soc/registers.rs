//! The bus: from an address to a block's register, with narrow writes and clock gates.

use super::map::{Block, NarrowWrite, decode};
use super::reach::reach;
use super::{Refusal, Soc, identity};
use crate::core::{Bus, BusFault, Cycle, Width};
use crate::memory::Memory;
use crate::wiring::Wiring;

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

    fn delay(&mut self, now: Cycle, address: u32, write: bool) -> Cycle {
        self.bridges.delay(&self.tree, now, address, write)
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
        self.dma.set_time(now);
        self.awake.wake(block);
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
}

fn lanes(width: Width) -> u32 {
    match width {
        Width::Byte => 0xff,
        Width::Half => 0xffff,
        Width::Word => u32::MAX,
    }
}
