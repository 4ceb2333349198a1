//! The flash interface's registers (RM0090 §3.9): access control, and a locked controller.

use super::map::Block;
use super::refusal::Refusal;

const ACR: u32 = 0x00;
const SR: u32 = 0x0c;
const CR: u32 = 0x10;
const OPTCR: u32 = 0x14;

/// LATENCY, PRFTEN, ICEN, DCEN, ICRST, DCRST.
const ACR_WRITABLE: u32 = 0x0000_1f07;
/// CR.LOCK: programming and erasing are not modelled.
const CR_LOCKED: u32 = 1 << 31;
/// Option bytes as delivered: no protection, brown-out level off.
const OPTION_BYTES: u32 = 0x0fff_aaed;

/// What one more wait state is worth between 2.7 V and 3.6 V, in hertz (RM0090 table 10).
const HERTZ_PER_WAIT_STATE: u32 = 30_000_000;

/// How the core's fetches and loads meet the flash memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FlashTiming {
    /// FLASH_ACR.LATENCY.
    pub wait_states: u8,
    /// FLASH_ACR.PRFTEN.
    pub prefetch: bool,
    /// FLASH_ACR.ICEN.
    pub instruction_cache: bool,
    /// FLASH_ACR.DCEN.
    pub data_cache: bool,
}

/// What is assumed of the flash in place of what the firmware programs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FlashAssumption {
    /// Wait states.
    pub wait_states: Option<u8>,
    /// Prefetch and both caches are off.
    pub without_accelerator: bool,
}

impl FlashTiming {
    /// What the firmware programs, as far as nothing else is assumed.
    #[must_use]
    pub fn assuming(self, assumption: FlashAssumption) -> Self {
        let accelerated = !assumption.without_accelerator;
        Self {
            wait_states: assumption.wait_states.unwrap_or(self.wait_states),
            prefetch: self.prefetch && accelerated,
            instruction_cache: self.instruction_cache && accelerated,
            data_cache: self.data_cache && accelerated,
        }
    }
}

/// The flash interface.
#[derive(Clone, Debug, Default)]
pub struct Flash {
    acr: u32,
}

impl Flash {
    /// The timing now programmed.
    pub fn timing(&self) -> FlashTiming {
        FlashTiming {
            wait_states: (self.acr & 7) as u8,
            prefetch: self.acr & 1 << 8 != 0,
            instruction_cache: self.acr & 1 << 9 != 0,
            data_cache: self.acr & 1 << 10 != 0,
        }
    }

    /// Refuses an HCLK the programmed wait states cannot serve.
    pub fn check(&self, hertz: u32) -> Result<(), Refusal> {
        let wait_states = self.timing().wait_states;
        if hertz > HERTZ_PER_WAIT_STATE * (u32::from(wait_states) + 1) {
            return Err(Refusal::WaitStates { hertz, wait_states });
        }
        Ok(())
    }

    /// Reads a register.
    pub fn read(&self, offset: u32) -> Result<u32, Refusal> {
        match offset {
            ACR => Ok(self.acr),
            SR => Ok(0),
            CR => Ok(CR_LOCKED),
            OPTCR => Ok(OPTION_BYTES),
            _ => Err(unknown(offset)),
        }
    }

    /// Writes a register. Only ACR takes writes.
    pub fn write(&mut self, offset: u32, value: u32) -> Result<(), Refusal> {
        if offset != ACR {
            return Err(unknown(offset));
        }
        self.acr = value & ACR_WRITABLE;
        Ok(())
    }
}

fn unknown(offset: u32) -> Refusal {
    Refusal::UnmodelledRegister {
        block: Block::Flash,
        address: 0x4002_3c00 + offset,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn full_speed_needs_five_wait_states() {
        let mut flash = Flash::default();
        flash.write(ACR, 4).unwrap();
        assert!(flash.check(168_000_000).is_err());
        flash.write(ACR, 5).unwrap();
        assert!(flash.check(168_000_000).is_ok());
    }

    #[test]
    fn latency_alone_leaves_prefetch_and_caches_off() {
        let mut flash = Flash::default();
        flash.write(ACR, 0x5).unwrap();
        let timing = flash.timing();
        assert!(!timing.prefetch && !timing.instruction_cache && !timing.data_cache);
        flash.write(ACR, 0x705).unwrap();
        let timing = flash.timing();
        assert!(timing.prefetch && timing.instruction_cache && timing.data_cache);
    }

    #[test]
    fn unlocking_the_flash_controller_is_refused() {
        assert!(Flash::default().write(0x04, 0x4567_0123).is_err());
    }
}
