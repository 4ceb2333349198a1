//! USART1 to 6 as asynchronous 8-bit receivers and transmitters, by DMA or by hand (RM0090 §30).

mod wires;

use std::collections::VecDeque;

use super::dma::Request;
use super::interrupts::{self, Lines};
use super::map::Block;
use super::refusal::Refusal;
use super::timeline::NEVER;
use crate::core::Cycle;
use crate::time::Nanos;
use crate::trace::Recorder;

const SR: u32 = 0x00;
const DR: u32 = 0x04;
const BRR: u32 = 0x08;
const CR1: u32 = 0x0c;
const CR2: u32 = 0x10;
const CR3: u32 = 0x14;
const GTPR: u32 = 0x18;

/// SR. PE, FE and NF are never set: the emulated wire is clean.
const OVERRUN: u32 = 1 << 3;
const IDLE: u32 = 1 << 4;
const RECEIVED: u32 = 1 << 5;
const COMPLETE: u32 = 1 << 6;
const EMPTY: u32 = 1 << 7;
/// Cleared by reading SR, then DR.
const CLEARED_BY_SEQUENCE: u32 = 0x1f;

/// CR1.
const RECEIVER: u32 = 1 << 2;
const TRANSMITTER: u32 = 1 << 3;
const ENABLE: u32 = 1 << 13;
const OVERSAMPLE_BY_8: u32 = 1 << 15;
/// SBK, RWU, PS, PCE, WAKE, M.
const CR1_UNMODELLED: u32 = 0x1e03;
/// IDLEIE to TXEIE are at the places of their flags.
const CR1_INTERRUPTS: u32 = 0xf0;
/// CLKEN and LINEN.
const CR2_UNMODELLED: u32 = 0x4800;
/// IrDA, half duplex, smartcard and flow control.
const CR3_UNMODELLED: u32 = 0x073e;
const CR3_ERROR_INTERRUPT: u32 = 1 << 0;
const CR3_DMA_RECEIVE: u32 = 1 << 6;
const CR3_DMA_SEND: u32 = 1 << 7;

/// What passed over one USART's wires.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct UsartCounters {
    /// Bytes the chip took from its RX line.
    pub received: u64,
    /// Bytes the chip sent.
    pub sent: u64,
    /// Bytes lost because the one before had not been read.
    pub overruns: u64,
    /// Bytes lost because the receiver was off.
    pub lost: u64,
}

/// A byte in a shift register.
#[derive(Clone, Copy, Debug)]
struct Shift {
    byte: u8,
    /// The end of its stop bit.
    ends: Cycle,
}

/// One USART and the two wires it is on.
#[derive(Clone, Debug)]
pub struct Usart {
    number: u8,
    /// HCLK cycles of one bus clock.
    bus_cycles: u64,
    sr: u32,
    /// Flags of the sequence-cleared kind that the last read of SR showed.
    seen: u32,
    received: u8,
    to_send: Option<u8>,
    sending: Option<Shift>,
    brr: u32,
    cr1: u32,
    cr2: u32,
    cr3: u32,
    gtpr: u32,
    /// Bytes the other end will send, none before its instant.
    line: VecDeque<(Nanos, u8)>,
    arriving: Option<Shift>,
    line_free: Cycle,
    idle_at: Cycle,
    sent: Vec<(Nanos, u8)>,
    counters: UsartCounters,
    pub(super) trace: Recorder,
}

impl Usart {
    /// The reset state of USART `number`, 1..=6.
    pub fn new(number: u8) -> Self {
        Self {
            number,
            bus_cycles: 1,
            sr: COMPLETE,
            seen: 0,
            received: 0,
            to_send: None,
            sending: None,
            brr: 0,
            cr1: 0,
            cr2: 0,
            cr3: 0,
            gtpr: 0,
            line: VecDeque::new(),
            arriving: None,
            line_free: 0,
            idle_at: NEVER,
            sent: Vec::new(),
            counters: UsartCounters::default(),
            trace: Recorder::default(),
        }
    }

    /// Back to the reset state. What is on the wires stays there.
    pub fn reset(&mut self) {
        let before = core::mem::replace(self, Self::new(self.number));
        self.bus_cycles = before.bus_cycles;
        self.line = before.line;
        self.line_free = before.line_free;
        self.sent = before.sent;
        self.counters = before.counters;
        self.trace = before.trace;
    }

    /// One bus clock is now `cycles` of HCLK; bytes in flight keep their end.
    pub fn set_clock(&mut self, cycles: u64) {
        self.bus_cycles = cycles;
    }

    /// What passed over the wires so far.
    pub fn counters(&self) -> UsartCounters {
        self.counters
    }

    fn status(&self) -> u32 {
        let empty = if self.to_send.is_none() { EMPTY } else { 0 };
        self.sr | empty
    }

    /// Drives the interrupt line.
    pub fn drive(&self, lines: &mut Lines) {
        let status = self.status();
        let by_dma = self.cr3 & (CR3_ERROR_INTERRUPT | CR3_DMA_RECEIVE);
        let errors = by_dma == CR3_ERROR_INTERRUPT | CR3_DMA_RECEIVE || self.cr1 & RECEIVED != 0;
        let active = status & self.cr1 & CR1_INTERRUPTS != 0 || errors && status & OVERRUN != 0;
        lines.drive(
            interrupts::usart(self.number),
            active && self.cr1 & ENABLE != 0,
        );
    }

    /// Reads a register.
    pub fn read(&mut self, offset: u32) -> Result<u32, Refusal> {
        Ok(match offset {
            SR => {
                let status = self.status();
                self.seen = status & CLEARED_BY_SEQUENCE;
                status
            }
            DR => {
                self.data_was_read();
                u32::from(self.received)
            }
            BRR => self.brr,
            CR1 => self.cr1,
            CR2 => self.cr2,
            CR3 => self.cr3,
            GTPR => self.gtpr,
            _ => return Err(self.unknown(offset)),
        })
    }

    /// Writes a register; [`serve`](Self::serve) afterwards.
    pub fn write(&mut self, offset: u32, value: u32) -> Result<(), Refusal> {
        let value = value & 0xffff;
        match offset {
            // RXNE and TC are cleared by writing zeros, the others by sequences.
            SR => self.sr &= value | !(RECEIVED | COMPLETE),
            DR => {
                self.sr &= !COMPLETE;
                self.to_send = Some(value as u8);
            }
            BRR => self.brr = value,
            CR1 if value & CR1_UNMODELLED != 0 => {
                return self.refuse("break, mute, parity or 9-bit words", value);
            }
            CR1 => self.cr1 = value & 0xa1fc,
            CR2 if value & CR2_UNMODELLED != 0 => {
                return self.refuse("synchronous or LIN mode", value);
            }
            CR2 => self.cr2 = value & 0x376f,
            CR3 if value & CR3_UNMODELLED != 0 => {
                return self.refuse("IrDA, half duplex, smartcard or flow control", value);
            }
            CR3 => self.cr3 = value & 0x08c1,
            // Guard time and prescaler serve IrDA and smartcards, which are refused above.
            GTPR => self.gtpr = value,
            _ => return Err(self.unknown(offset)),
        }
        Ok(())
    }

    fn unknown(&self, offset: u32) -> Refusal {
        Refusal::UnmodelledRegister {
            block: Block::Usart(self.number),
            address: Request::UsartSend(self.number).data_register() - DR + offset,
        }
    }

    fn refuse<T>(&self, what: &'static str, value: u32) -> Result<T, Refusal> {
        Err(Refusal::UnmodelledMode {
            block: Block::Usart(self.number),
            what,
            value,
        })
    }
}

#[cfg(test)]
mod tests;
