//! PWR: voltage scaling and the backup domain's lock (RM0090 §5.4).

use super::map::Block;
use super::refusal::Refusal;

const CR: u32 = 0x00;
const CSR: u32 = 0x04;

/// VOS: scale 1, the reset state of an F407.
const CR_RESET: u32 = 1 << 14;
/// DBP, PLS, PVDE, CSBF, CWUF, PDDS, LPDS and VOS exist; the detector and the stop modes do
/// nothing until the core sleeps deeply, which it does not model.
const CR_WRITABLE: u32 = 0x0000_43f3;
/// VOSRDY: the regulator has settled.
const CSR_READY: u32 = 1 << 14;
/// BRE and EWUP.
const CSR_WRITABLE: u32 = 0x0000_0300;
/// BRR follows BRE: the backup regulator is ready.
const CSR_BACKUP_READY: u32 = 1 << 3;

/// Power control.
#[derive(Clone, Debug)]
pub struct Power {
    cr: u32,
    csr: u32,
}

impl Power {
    /// The reset state.
    pub fn new() -> Self {
        Self {
            cr: CR_RESET,
            csr: 0,
        }
    }

    /// Reads a register.
    pub fn read(&self, offset: u32) -> Result<u32, Refusal> {
        match offset {
            CR => Ok(self.cr),
            CSR => {
                let backup = if self.csr & 1 << 9 != 0 {
                    CSR_BACKUP_READY
                } else {
                    0
                };
                Ok(self.csr | CSR_READY | backup)
            }
            _ => Err(unknown(offset)),
        }
    }

    /// Writes a register.
    pub fn write(&mut self, offset: u32, value: u32) -> Result<(), Refusal> {
        match offset {
            // CSBF and CWUF (bits 3 and 2) read as zero.
            CR => self.cr = value & CR_WRITABLE & !0xc,
            CSR => self.csr = value & CSR_WRITABLE,
            _ => return Err(unknown(offset)),
        }
        Ok(())
    }
}

fn unknown(offset: u32) -> Refusal {
    Refusal::UnmodelledRegister {
        block: Block::Power,
        address: 0x4000_7000 + offset,
    }
}
