//! What happens on the wires: bytes arrive, are sent, and DMA moves them.

use super::{
    COMPLETE, CR3_DMA_RECEIVE, CR3_DMA_SEND, ENABLE, IDLE, OVERRUN, OVERSAMPLE_BY_8, RECEIVED,
    RECEIVER, Shift, TRANSMITTER, Usart,
};
use crate::core::Cycle;
use crate::memory::Memory;
use crate::soc::dma::{Dma, Request};
use crate::soc::timeline::{NEVER, Timeline};
use crate::time::Nanos;
use crate::trace::{SerialWire, What};

impl Usart {
    /// Puts bytes on the RX line, back to back, the first not before `at`.
    pub fn send(&mut self, at: Nanos, bytes: &[u8]) {
        self.line.extend(bytes.iter().map(|&byte| (at, byte)));
    }

    /// The bytes the chip sent since the last call, each at the end of its stop bit.
    pub fn take_sent(&mut self) -> Vec<(Nanos, u8)> {
        core::mem::take(&mut self.sent)
    }

    /// HCLK cycles of one character: start bit, eight data bits and the stop bits of CR2.
    fn character_cycles(&self) -> u64 {
        let bus_clocks_per_bit = if self.cr1 & OVERSAMPLE_BY_8 != 0 {
            8 * (self.brr >> 4) + (self.brr & 7)
        } else {
            self.brr
        };
        let half_bits = 18 + [2, 1, 4, 3][(self.cr2 >> 12 & 3) as usize];
        u64::from(bus_clocks_per_bit) * self.bus_cycles * half_bits / 2
    }

    fn on(&self, direction: u32) -> bool {
        self.cr1 & (ENABLE | direction) == ENABLE | direction && self.brr >= 16
    }

    /// The next cycle at which something happens on the wires.
    pub fn next(&self, time: &Timeline) -> Cycle {
        let arrival = match self.arriving {
            Some(shift) => shift.ends,
            None => self.next_start(time),
        };
        let departure = self.sending.map_or(NEVER, |shift| shift.ends);
        arrival.min(departure).min(self.idle_at)
    }

    fn next_start(&self, time: &Timeline) -> Cycle {
        let first = self.line.front();
        first.map_or(NEVER, |&(at, _)| time.cycle_at(at).max(self.line_free))
    }

    /// Performs what is due at `now`.
    pub fn advance(&mut self, now: Cycle, time: &Timeline, memory: &mut Memory, dma: &mut Dma) {
        if let Some(shift) = self.sending.filter(|shift| shift.ends <= now) {
            self.sending = None;
            self.sent.push((time.nanos(shift.ends), shift.byte));
            self.counters.sent += 1;
            self.serve(shift.ends, memory, dma);
            if self.sending.is_none() {
                self.sr |= COMPLETE;
            }
        }
        if let Some(shift) = self.arriving.filter(|shift| shift.ends <= now) {
            self.arriving = None;
            self.receive(shift);
            self.serve(now, memory, dma);
        }
        if self.idle_at <= now {
            self.idle_at = NEVER;
            self.sr |= IDLE;
        }
        while self.arriving.is_none() && self.next_start(time) <= now {
            self.start_arrival(time);
        }
    }

    fn start_arrival(&mut self, time: &Timeline) {
        let start = self.next_start(time);
        let Some((_, byte)) = self.line.pop_front() else {
            return;
        };
        if !self.on(RECEIVER) {
            self.counters.lost += 1;
            return;
        }
        self.idle_at = NEVER;
        let ends = start + self.character_cycles();
        self.line_free = ends;
        self.arriving = Some(Shift { byte, ends });
        self.note(start, SerialWire::Receive, byte, ends);
    }

    fn note(&mut self, at: Cycle, wire: SerialWire, byte: u8, ends: Cycle) {
        let usart = self.number;
        let what = What::Byte {
            usart,
            wire,
            byte,
            ends,
        };
        self.trace.note(at, what);
    }

    fn receive(&mut self, shift: Shift) {
        if !self.on(RECEIVER) {
            self.counters.lost += 1;
            return;
        }
        self.idle_at = shift.ends + self.character_cycles();
        if self.sr & RECEIVED != 0 {
            self.sr |= OVERRUN;
            self.counters.overruns += 1;
        } else {
            self.sr |= RECEIVED;
            self.received = shift.byte;
            self.counters.received += 1;
        }
    }

    /// Lets DMA read and write DR as far as it can, and feeds the transmitter's shift register.
    pub fn serve(&mut self, now: Cycle, memory: &mut Memory, dma: &mut Dma) {
        if self.sr & RECEIVED != 0 && self.cr3 & CR3_DMA_RECEIVE != 0 {
            let request = Request::UsartReceive(self.number);
            if dma.store(memory, request, u32::from(self.received)) {
                self.data_was_read();
            }
        }
        while self.on(TRANSMITTER) {
            if self.to_send.is_none() && self.cr3 & CR3_DMA_SEND != 0 {
                let word = dma.load(memory, Request::UsartSend(self.number));
                self.to_send = word.map(|word| word as u8);
            }
            if self.sending.is_some() {
                return;
            }
            let Some(byte) = self.to_send.take() else {
                return;
            };
            let ends = now + self.character_cycles();
            self.sending = Some(Shift { byte, ends });
            self.note(now, SerialWire::Transmit, byte, ends);
        }
    }

    /// DR was read: RXNE falls, and the flags of a clearing sequence.
    pub(super) fn data_was_read(&mut self) {
        self.sr &= !(RECEIVED | self.seen);
        self.seen = 0;
    }
}
