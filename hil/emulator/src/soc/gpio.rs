//! One GPIO port: modes, output data, alternate functions (RM0090 §8.4).

use super::map::Block;
use super::refusal::Refusal;
use crate::time::Nanos;
use crate::wiring::{Pin, Wiring};

const MODER: u32 = 0x00;
const OTYPER: u32 = 0x04;
const OSPEEDR: u32 = 0x08;
const PUPDR: u32 = 0x0c;
const IDR: u32 = 0x10;
const ODR: u32 = 0x14;
const BSRR: u32 = 0x18;
const LCKR: u32 = 0x1c;
const AFRL: u32 = 0x20;
const AFRH: u32 = 0x24;

/// MODER field: general-purpose output.
const OUTPUT: u32 = 1;
/// MODER field: alternate function.
const ALTERNATE: u32 = 2;
/// PUPDR field: pull-up.
const PULL_UP: u32 = 1;

/// A port of 16 pins.
#[derive(Clone, Debug)]
pub struct Gpio {
    port: u8,
    moder: u32,
    otyper: u32,
    ospeedr: u32,
    pupdr: u32,
    odr: u32,
    afr: [u32; 2],
    /// Pins whose output level the wiring has been told, and those levels.
    told: u16,
    told_level: u16,
}

impl Gpio {
    /// The reset state of port `port` (0 is A). A and B start with the debug pins in use.
    pub fn new(port: u8) -> Self {
        let (moder, ospeedr, pupdr) = match port {
            0 => (0xa800_0000, 0x0c00_0000, 0x6400_0000),
            1 => (0x0000_0280, 0x0000_00c0, 0x0000_0100),
            _ => (0, 0, 0),
        };
        Self {
            port,
            moder,
            otyper: 0,
            ospeedr,
            pupdr,
            odr: 0,
            afr: [0; 2],
            told: 0,
            told_level: 0,
        }
    }

    /// Back to the reset state; the world remembers the levels it saw.
    pub fn reset(&mut self) {
        let (told, told_level) = (self.told, self.told_level);
        *self = Self {
            told,
            told_level,
            ..Self::new(self.port)
        };
    }

    /// Reads a register.
    pub fn read(&self, offset: u32) -> Result<u32, Refusal> {
        Ok(match offset {
            MODER => self.moder,
            OTYPER => self.otyper,
            OSPEEDR => self.ospeedr,
            PUPDR => self.pupdr,
            IDR => self.input(),
            ODR => self.odr,
            BSRR => 0,
            AFRL => self.afr[0],
            AFRH => self.afr[1],
            _ => return Err(self.unknown(offset)),
        })
    }

    /// Writes a register and tells the wiring which outputs changed.
    pub fn write<W: Wiring>(
        &mut self,
        offset: u32,
        value: u32,
        now: Nanos,
        wiring: &mut W,
    ) -> Result<(), Refusal> {
        match offset {
            MODER => self.moder = value,
            OTYPER => self.otyper = value & 0xffff,
            OSPEEDR => self.ospeedr = value,
            PUPDR => self.pupdr = value,
            IDR => {}
            ODR => self.odr = value & 0xffff,
            // Set wins over reset (RM0090 §8.4.7).
            BSRR => self.odr = self.odr & !(value >> 16) | value & 0xffff,
            AFRL => self.afr[0] = value,
            AFRH => self.afr[1] = value,
            LCKR => {
                return Err(Refusal::UnmodelledMode {
                    block: Block::Gpio(self.port),
                    what: "configuration lock",
                    value,
                });
            }
            _ => return Err(self.unknown(offset)),
        }
        self.tell(now, wiring);
        Ok(())
    }

    /// True if pin `number` is switched to alternate function `function`.
    pub fn is_alternate(&self, number: u8, function: u8) -> bool {
        let field = self.afr[usize::from(number >> 3 & 1)] >> (4 * (number & 7)) & 15;
        self.mode(number) == ALTERNATE && field == u32::from(function)
    }

    fn mode(&self, number: u8) -> u32 {
        self.moder >> (2 * number) & 3
    }

    /// What the port reads: outputs read back, inputs rest on their pull, floating ones read low.
    fn input(&self) -> u32 {
        (0..16).fold(0, |levels, number| {
            let level = if self.mode(number) == OUTPUT {
                self.odr >> number & 1
            } else {
                u32::from(self.pupdr >> (2 * number) & 3 == PULL_UP)
            };
            levels | level << number
        })
    }

    fn tell<W: Wiring>(&mut self, now: Nanos, wiring: &mut W) {
        for number in 0..16u8 {
            let mask = 1u16 << number;
            let high = self.odr >> number & 1 != 0;
            let known = self.told & mask != 0 && (self.told_level & mask != 0) == high;
            if self.mode(number) != OUTPUT || known {
                continue;
            }
            self.told |= mask;
            self.told_level = self.told_level & !mask | u16::from(high) << number;
            let pin = Pin {
                port: char::from(b'A' + self.port),
                number,
            };
            wiring.pin_changed(now, pin, high);
        }
    }

    fn unknown(&self, offset: u32) -> Refusal {
        Refusal::UnmodelledRegister {
            block: Block::Gpio(self.port),
            address: 0x4002_0000 + (u32::from(self.port) << 10) + offset,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Default)]
    struct Probe(Vec<(u8, bool)>);

    impl Wiring for Probe {
        fn pin_changed(&mut self, _now: Nanos, pin: Pin, high: bool) {
            assert_eq!(pin.port, 'D');
            self.0.push((pin.number, high));
        }
    }

    #[test]
    fn a_pin_speaks_when_it_becomes_an_output_and_when_its_level_changes() {
        let mut port = Gpio::new(3);
        let mut probe = Probe::default();
        let mut write = |offset, value| port.write(offset, value, Nanos(0), &mut probe).unwrap();
        write(BSRR, 1 << 2);
        write(MODER, OUTPUT << 4);
        write(BSRR, 1 << 2);
        write(BSRR, 1 << 18);
        write(ODR, 1 << 2);
        assert_eq!(probe.0, [(2, true), (2, false), (2, true)]);
    }

    #[test]
    fn setting_wins_over_resetting_in_one_bsrr_write() {
        let mut port = Gpio::new(3);
        port.write(BSRR, 0x0004_0004, Nanos(0), &mut Probe::default())
            .unwrap();
        assert_eq!(port.read(ODR).unwrap(), 4);
    }

    #[test]
    fn inputs_rest_on_their_pull_and_outputs_read_back() {
        let mut port = Gpio::new(3);
        let mut probe = Probe::default();
        let mut write = |offset, value| port.write(offset, value, Nanos(0), &mut probe).unwrap();
        write(PUPDR, PULL_UP << 8 | 2 << 10);
        write(MODER, OUTPUT);
        write(ODR, 1);
        assert_eq!(port.read(IDR).unwrap(), 1 << 4 | 1);
    }

    #[test]
    fn alternate_functions_are_four_bits_a_pin() {
        let mut port = Gpio::new(3);
        let mut write = |offset, value| {
            port.write(offset, value, Nanos(0), &mut Probe::default())
                .unwrap()
        };
        write(MODER, ALTERNATE << 14 | ALTERNATE << 18);
        write(AFRL, 2 << 28);
        write(AFRH, 13 << 4);
        assert!(port.is_alternate(7, 2) && port.is_alternate(9, 13));
        assert!(!port.is_alternate(6, 0));
    }
}
