//! I2C1 to 3 as masters, with interrupts and DMA (RM0090 §27).
//!
//! The bus is a sequence of phases; a phase that takes time ends at `ends`, one that does not waits
//! for the software with the clock held low.

mod phases;

use super::dma::Request;
use super::interrupts::{self, Lines};
use super::map::Block;
use super::reach::Reach;
use super::refusal::Refusal;
use super::timeline::NEVER;
use crate::core::Cycle;
use crate::wiring::Wiring;
use phases::BYTE_BITS;

const CR1: u32 = 0x00;
const CR2: u32 = 0x04;
const OAR1: u32 = 0x08;
const OAR2: u32 = 0x0c;
const DR: u32 = 0x10;
const SR1: u32 = 0x14;
const SR2: u32 = 0x18;
const CCR: u32 = 0x1c;
const TRISE: u32 = 0x20;

/// CR1.
const ENABLE: u32 = 1 << 0;
const START: u32 = 1 << 8;
const STOP: u32 = 1 << 9;
const ACKNOWLEDGE: u32 = 1 << 10;
const SOFTWARE_RESET: u32 = 1 << 15;
/// SMBus, ARP, PEC, POS and ALERT.
const CR1_UNMODELLED: u32 = 0x383a;

/// CR2.
const ERROR_INTERRUPT: u32 = 1 << 8;
const EVENT_INTERRUPT: u32 = 1 << 9;
const BUFFER_INTERRUPT: u32 = 1 << 10;
const DMA_ENABLE: u32 = 1 << 11;
const LAST: u32 = 1 << 12;

/// SR1.
const START_SENT: u32 = 1 << 0;
const ADDRESSED: u32 = 1 << 1;
const TRANSFER_FINISHED: u32 = 1 << 2;
const RECEIVED: u32 = 1 << 6;
const EMPTY: u32 = 1 << 7;
const ACKNOWLEDGE_FAILURE: u32 = 1 << 10;
/// SB, ADDR and BTF; ADD10 and STOPF belong to modes without a model.
const EVENTS: u32 = 0x07;
/// The error flags, cleared by writing zeros.
const ERRORS: u32 = 0xdf00;

/// SR2.
const MASTER: u32 = 1 << 0;
const BUSY: u32 = 1 << 1;
const TRANSMITTER: u32 = 1 << 2;

/// Where the bus stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// Free.
    Free,
    /// A start condition, or a repeated one, is being sent.
    Starting,
    /// SB: waits for an address in DR.
    AwaitAddress,
    /// The address is being sent.
    Addressing(u8),
    /// ADDR: waits until the software has read SR1 and SR2.
    Addressed { read: bool },
    /// Sends the byte, or waits for one in DR.
    Transmit(Option<u8>),
    /// A byte is being received.
    Receive,
    /// BTF: a byte waits in the shift register because DR is full.
    ReceiverFull { byte: u8, acknowledged: bool },
    /// Nothing more to move: waits for a stop or a repeated start.
    Held,
    /// A stop condition is being sent.
    Stopping,
}

/// One I2C peripheral and the bus it is master of.
#[derive(Clone, Debug)]
pub struct I2c {
    number: u8,
    /// HCLK cycles of one bus clock.
    bus_cycles: u64,
    cr1: u32,
    cr2: u32,
    own_addresses: [u32; 2],
    ccr: u32,
    trise: u32,
    /// SB, ADDR, BTF, RXNE and AF; TXE follows from the phase.
    sr1: u32,
    /// What the last read of SR1 showed: flags are cleared by sequences that begin with it.
    seen: u32,
    sr2: u32,
    received: u8,
    to_send: Option<u8>,
    phase: Phase,
    ends: Cycle,
}

impl I2c {
    /// The reset state of I2C `number`, 1..=3.
    pub fn new(number: u8) -> Self {
        Self {
            number,
            bus_cycles: 1,
            cr1: 0,
            cr2: 0,
            own_addresses: [0; 2],
            ccr: 0,
            trise: 2,
            sr1: 0,
            seen: 0,
            sr2: 0,
            received: 0,
            to_send: None,
            phase: Phase::Free,
            ends: NEVER,
        }
    }

    /// Back to the reset state; the bus is released.
    pub fn reset<W: Wiring>(&mut self, reach: &mut Reach<'_, W>) {
        self.release(reach);
        let bus_cycles = self.bus_cycles;
        *self = Self {
            bus_cycles,
            ..Self::new(self.number)
        };
    }

    /// One bus clock is now `cycles` of HCLK.
    pub fn set_clock(&mut self, cycles: u64) {
        self.bus_cycles = cycles;
    }

    fn status(&self) -> u32 {
        let empty = matches!(self.phase, Phase::Transmit(_)) && self.to_send.is_none();
        self.sr1 | if empty { EMPTY } else { 0 }
    }

    /// Drives the event and the error interrupt line.
    pub fn drive(&self, lines: &mut Lines) {
        let (event, error) = interrupts::i2c(self.number);
        let status = self.status();
        let buffer = self.cr2 & BUFFER_INTERRUPT != 0 && status & (RECEIVED | EMPTY) != 0;
        let events = status & EVENTS != 0 || buffer;
        lines.drive(event, self.cr2 & EVENT_INTERRUPT != 0 && events);
        let errors = status & ERRORS != 0;
        lines.drive(error, self.cr2 & ERROR_INTERRUPT != 0 && errors);
    }

    /// Reads a register at `now`; [`serve`](Self::serve) afterwards.
    pub fn read(&mut self, offset: u32, now: Cycle) -> Result<u32, Refusal> {
        Ok(match offset {
            CR1 => self.cr1,
            CR2 => self.cr2,
            OAR1 | OAR2 => self.own_addresses[usize::from(offset == OAR2)],
            DR => {
                let byte = self.received;
                self.data_was_read(now);
                u32::from(byte)
            }
            SR1 => {
                self.seen = self.status();
                self.seen
            }
            SR2 => {
                let sr2 = self.sr2;
                self.address_was_seen(now);
                sr2
            }
            CCR => self.ccr,
            TRISE => self.trise,
            _ => return Err(self.unknown(offset)),
        })
    }

    /// ADDR is cleared by reading SR1, then SR2; the clock is let go.
    fn address_was_seen(&mut self, now: Cycle) {
        if self.seen & self.sr1 & ADDRESSED == 0 {
            return;
        }
        self.sr1 &= !ADDRESSED;
        match self.phase {
            Phase::Addressed { read: true } => self.enter(Phase::Receive, now, BYTE_BITS),
            Phase::Addressed { read: false } => self.wait(Phase::Transmit(None)),
            _ => {}
        }
    }

    /// Writes a register; [`serve`](Self::serve) afterwards.
    pub fn write<W: Wiring>(
        &mut self,
        offset: u32,
        value: u32,
        reach: &mut Reach<'_, W>,
    ) -> Result<(), Refusal> {
        match offset {
            CR1 if value & CR1_UNMODELLED != 0 => return self.refuse("SMBus, PEC or POS", value),
            CR1 => self.write_cr1(value & 0x87c1, reach),
            CR2 => self.cr2 = value & 0x1f3f,
            OAR1 | OAR2 => self.own_addresses[usize::from(offset == OAR2)] = value & 0xffff,
            DR => self.write_data(value as u8, reach.now),
            SR1 => self.sr1 &= value | !ERRORS,
            SR2 => {}
            CCR => self.ccr = value & 0xcfff,
            TRISE => self.trise = value & 0x3f,
            _ => return Err(self.unknown(offset)),
        }
        Ok(())
    }

    fn write_cr1<W: Wiring>(&mut self, value: u32, reach: &mut Reach<'_, W>) {
        if value & SOFTWARE_RESET != 0 {
            self.reset(reach);
            self.cr1 = SOFTWARE_RESET;
        } else if value & ENABLE != 0 {
            self.cr1 = value;
        } else {
            self.release(reach);
            (self.sr1, self.sr2, self.to_send) = (0, 0, None);
            self.cr1 = value & !(START | STOP | ACKNOWLEDGE);
        }
    }

    fn write_data(&mut self, byte: u8, now: Cycle) {
        if self.phase == Phase::AwaitAddress {
            if self.seen & START_SENT != 0 {
                self.sr1 &= !START_SENT;
                self.enter(Phase::Addressing(byte), now, BYTE_BITS);
            }
        } else if matches!(
            self.phase,
            Phase::Addressed { read: false } | Phase::Transmit(_)
        ) {
            self.to_send = Some(byte);
        }
    }

    fn unknown(&self, offset: u32) -> Refusal {
        Refusal::UnmodelledRegister {
            block: Block::I2c(self.number),
            address: Request::I2cSend(self.number).data_register() - DR + offset,
        }
    }

    fn refuse<T>(&self, what: &'static str, value: u32) -> Result<T, Refusal> {
        Err(Refusal::UnmodelledMode {
            block: Block::I2c(self.number),
            what,
            value,
        })
    }
}

#[cfg(test)]
mod tests;
