//! SYSCFG and EXTI (RM0090 §9, §12.3). The wiring drives no inputs, so the only edges are the
//! software's own.

use super::interrupts::{self, Lines};
use super::map::Block;
use super::refusal::Refusal;

/// The lines of an F407: 0 to 22.
const LINES: u32 = 0x007f_ffff;

/// External interrupt controller.
#[derive(Clone, Debug, Default)]
pub struct Exti {
    imr: u32,
    rtsr: u32,
    ftsr: u32,
    pending: u32,
}

impl Exti {
    /// Reads a register.
    pub fn read(&self, offset: u32) -> Result<u32, Refusal> {
        Ok(match offset {
            0x00 => self.imr,
            0x04 => 0,
            0x08 => self.rtsr,
            0x0c => self.ftsr,
            // SWIER: its bits fall with the pending bits.
            0x10 | 0x14 => self.pending,
            _ => return Err(unknown(Block::Exti, 0x4001_3c00 + offset)),
        })
    }

    /// Writes a register.
    pub fn write(&mut self, offset: u32, value: u32) -> Result<(), Refusal> {
        let value = value & LINES;
        match offset {
            0x00 => self.imr = value,
            0x04 if value == 0 => {}
            0x04 => {
                return Err(Refusal::UnmodelledMode {
                    block: Block::Exti,
                    what: "event lines",
                    value,
                });
            }
            0x08 => self.rtsr = value,
            0x0c => self.ftsr = value,
            0x10 => self.pending |= value & self.imr,
            0x14 => self.pending &= !value,
            _ => return Err(unknown(Block::Exti, 0x4001_3c00 + offset)),
        }
        Ok(())
    }

    /// Drives the interrupt lines.
    pub fn drive(&self, lines: &mut Lines) {
        let mut active = self.pending & self.imr;
        while active != 0 {
            if let Some(irq) = interrupts::exti(active.trailing_zeros() as u8) {
                lines.drive(irq, true);
            }
            active &= active - 1;
        }
    }
}

/// System configuration: which port feeds which EXTI line, and the I/O compensation cell.
#[derive(Clone, Debug, Default)]
pub struct Syscfg {
    registers: [u32; 6],
    compensation: bool,
}

/// MEMRMP, PMC and EXTICR1 to EXTICR4: the bits that store.
const SYSCFG_WRITABLE: [u32; 6] = [0, 1 << 23, 0xffff, 0xffff, 0xffff, 0xffff];
const CMPCR: u32 = 0x20;

impl Syscfg {
    /// Reads a register.
    pub fn read(&self, offset: u32) -> Result<u32, Refusal> {
        match (offset, self.registers.get(offset as usize / 4)) {
            // READY follows CMP_PD.
            (CMPCR, _) if self.compensation => Ok(0x101),
            (CMPCR, _) => Ok(0),
            (_, Some(value)) => Ok(*value),
            _ => Err(unknown(Block::Syscfg, 0x4001_3800 + offset)),
        }
    }

    /// Writes a register.
    pub fn write(&mut self, offset: u32, value: u32) -> Result<(), Refusal> {
        let index = offset as usize / 4;
        match self.registers.get_mut(index) {
            _ if offset == CMPCR => self.compensation = value & 1 != 0,
            Some(_) if index == 0 && value & 7 != 0 => {
                return Err(Refusal::UnmodelledMode {
                    block: Block::Syscfg,
                    what: "memory remap",
                    value,
                });
            }
            Some(register) => *register = value & SYSCFG_WRITABLE[index],
            None => return Err(unknown(Block::Syscfg, 0x4001_3800 + offset)),
        }
        Ok(())
    }
}

fn unknown(block: Block, address: u32) -> Refusal {
    Refusal::UnmodelledRegister { block, address }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_software_trigger_pends_an_unmasked_line_until_it_is_cleared() {
        let mut exti = Exti::default();
        exti.write(0x10, 1 << 7).unwrap();
        assert_eq!(exti.read(0x14).unwrap(), 0);
        exti.write(0x00, 1 << 7).unwrap();
        exti.write(0x10, 1 << 7).unwrap();
        let mut lines = Lines::default();
        exti.drive(&mut lines);
        assert!(lines.is_high(23));
        exti.write(0x14, 1 << 7).unwrap();
        assert_eq!(exti.read(0x14).unwrap(), 0);
    }
}
