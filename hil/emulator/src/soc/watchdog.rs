//! IWDG: the independent watchdog on the 32 kHz internal oscillator (RM0090 §21).

use super::map::Block;
use super::refusal::Refusal;
use crate::time::Nanos;

const KR: u32 = 0x00;
const PR: u32 = 0x04;
const RLR: u32 = 0x08;
const SR: u32 = 0x0c;

const KEY_UNLOCK: u32 = 0x5555;
const KEY_RELOAD: u32 = 0xaaaa;
const KEY_START: u32 = 0xcccc;

/// One LSI period at the typical 32 kHz (DS8626 table 34): a real part is 17 to 47 kHz.
const LSI_PERIOD_NANOS: u64 = 31_250;

/// The independent watchdog.
#[derive(Clone, Debug)]
pub struct Watchdog {
    unlocked: bool,
    prescaler: u32,
    reload: u32,
    expires: Option<Nanos>,
}

impl Watchdog {
    /// The reset state: not started.
    pub fn new() -> Self {
        Self {
            unlocked: false,
            prescaler: 0,
            reload: 0xfff,
            expires: None,
        }
    }

    /// When it runs down; `None` until it is started.
    pub fn expires(&self) -> Option<Nanos> {
        self.expires
    }

    /// Reads a register.
    pub fn read(&self, offset: u32) -> Result<u32, Refusal> {
        match offset {
            // The key register reads zero; PVU and RVU are clear: updates take no time here.
            KR | SR => Ok(0),
            PR => Ok(self.prescaler),
            RLR => Ok(self.reload),
            _ => Err(unknown(offset)),
        }
    }

    /// Writes a register at `now`. A new prescaler or reload value counts from the next reload on.
    pub fn write(&mut self, offset: u32, value: u32, now: Nanos) -> Result<(), Refusal> {
        match offset {
            KR => self.key(value & 0xffff, now),
            PR if self.unlocked => self.prescaler = value & 7,
            RLR if self.unlocked => self.reload = value & 0xfff,
            PR | RLR | SR => {}
            _ => return Err(unknown(offset)),
        }
        Ok(())
    }

    fn key(&mut self, key: u32, now: Nanos) {
        self.unlocked = key == KEY_UNLOCK;
        let reloads = match key {
            KEY_START => true,
            KEY_RELOAD => self.expires.is_some(),
            _ => false,
        };
        if reloads {
            self.expires = Some(now + self.timeout());
        }
    }

    /// (RLR + 1) · 4 · 2^PR periods; PR 6 and 7 both divide by 256 (RM0090 table 107).
    fn timeout(&self) -> Nanos {
        let divider = 4 << self.prescaler.min(6);
        Nanos(u64::from(self.reload + 1) * divider * LSI_PERIOD_NANOS)
    }
}

fn unknown(offset: u32) -> Refusal {
    Refusal::UnmodelledRegister {
        block: Block::Watchdog,
        address: 0x4000_3000 + offset,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_timeout_at_a_prescaler_of_four_is_512_ms() {
        let mut dog = Watchdog::new();
        dog.write(KR, KEY_START, Nanos(0)).unwrap();
        assert_eq!(dog.expires(), Some(Nanos::from_millis(512)));
    }

    #[test]
    fn a_reload_key_starts_the_count_afresh() {
        let mut dog = Watchdog::new();
        dog.write(KR, KEY_RELOAD, Nanos(0)).unwrap();
        assert_eq!(dog.expires(), None);
        dog.write(KR, KEY_UNLOCK, Nanos(0)).unwrap();
        dog.write(PR, 2, Nanos(0)).unwrap();
        dog.write(RLR, 199, Nanos(0)).unwrap();
        dog.write(KR, KEY_START, Nanos(0)).unwrap();
        dog.write(KR, KEY_RELOAD, Nanos::from_millis(50)).unwrap();
        // 200 counts of 16 / 32 kHz.
        assert_eq!(dog.expires(), Some(Nanos::from_millis(150)));
    }

    #[test]
    fn settings_are_locked_until_the_unlock_key_and_after_any_other() {
        let mut dog = Watchdog::new();
        dog.write(RLR, 7, Nanos(0)).unwrap();
        assert_eq!(dog.read(RLR).unwrap(), 0xfff);
        dog.write(KR, KEY_UNLOCK, Nanos(0)).unwrap();
        dog.write(KR, KEY_RELOAD, Nanos(0)).unwrap();
        dog.write(RLR, 7, Nanos(0)).unwrap();
        assert_eq!(dog.read(RLR).unwrap(), 0xfff);
    }
}
