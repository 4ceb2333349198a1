//! What happens on the bus: one phase after the other.

use super::{
    ACKNOWLEDGE, ACKNOWLEDGE_FAILURE, ADDRESSED, BUSY, DMA_ENABLE, I2c, LAST, MASTER, Phase,
    RECEIVED, START, START_SENT, STOP, TRANSFER_FINISHED, TRANSMITTER,
};
use crate::core::Cycle;
use crate::soc::dma::Request;
use crate::soc::reach::Reach;
use crate::soc::timeline::NEVER;
use crate::wiring::Wiring;

/// Bits of a byte on the bus, its acknowledge included.
pub(super) const BYTE_BITS: u64 = 9;

impl I2c {
    /// When the phase ends.
    pub fn next(&self) -> Cycle {
        self.ends
    }

    /// HCLK cycles of one bit (RM0090 §27.6.8).
    pub(super) fn bit_cycles(&self) -> u64 {
        let periods = match (self.ccr >> 15 & 1, self.ccr >> 14 & 1) {
            (0, _) => 2,
            (_, 0) => 3,
            _ => 25,
        };
        periods * u64::from(self.ccr & 0xfff).max(1) * self.bus_cycles
    }

    /// A phase that takes so many bits.
    pub(super) fn enter(&mut self, phase: Phase, now: Cycle, bits: u64) {
        self.phase = phase;
        self.ends = now.saturating_add(bits * self.bit_cycles());
    }

    /// A phase that waits for the software.
    pub(super) fn wait(&mut self, phase: Phase) {
        self.phase = phase;
        self.ends = NEVER;
    }

    /// Ends the phase that is due at `reach.now`.
    pub fn advance<W: Wiring>(&mut self, reach: &mut Reach<'_, W>) {
        if self.ends > reach.now {
            return;
        }
        self.ends = NEVER;
        match self.phase {
            Phase::Starting => {
                self.cr1 &= !START;
                self.sr1 |= START_SENT;
                self.sr2 = MASTER | BUSY;
                self.wait(Phase::AwaitAddress);
            }
            Phase::Addressing(byte) => self.address_sent(byte, reach),
            Phase::Transmit(Some(byte)) => self.byte_sent(byte, reach),
            Phase::Receive => self.byte_received(reach),
            Phase::Stopping => {
                self.cr1 &= !STOP;
                self.sr2 = 0;
                self.wait(Phase::Free);
                let now = reach.nanos();
                reach.wiring.i2c_stop(now, self.number);
            }
            _ => {}
        }
        self.serve(reach);
    }

    fn address_sent<W: Wiring>(&mut self, byte: u8, reach: &mut Reach<'_, W>) {
        let (now, read) = (reach.nanos(), byte & 1 != 0);
        if reach.wiring.i2c_start(now, self.number, byte >> 1, read) {
            self.sr1 |= ADDRESSED;
            self.sr2 |= if read { 0 } else { TRANSMITTER };
            self.wait(Phase::Addressed { read });
        } else {
            self.sr1 |= ACKNOWLEDGE_FAILURE;
            self.wait(Phase::Held);
        }
    }

    fn byte_sent<W: Wiring>(&mut self, byte: u8, reach: &mut Reach<'_, W>) {
        let now = reach.nanos();
        if !reach.wiring.i2c_write(now, self.number, byte) {
            self.sr1 |= ACKNOWLEDGE_FAILURE;
            self.wait(Phase::Held);
            return;
        }
        self.wait(Phase::Transmit(None));
        self.serve_transmit(reach);
        if self.to_send.is_none() && self.phase == Phase::Transmit(None) {
            self.sr1 |= TRANSFER_FINISHED;
        }
    }

    fn byte_received<W: Wiring>(&mut self, reach: &mut Reach<'_, W>) {
        let now = reach.nanos();
        let byte = reach.wiring.i2c_read(now, self.number);
        // With LAST the byte that ends the DMA transfer is not acknowledged (RM0090 §27.6.2).
        let request = Request::I2cReceive(self.number);
        let ends_dma = self.cr2 & (DMA_ENABLE | LAST) == DMA_ENABLE | LAST
            && reach.dma.remaining(request) == Some(1);
        let acknowledged = self.cr1 & ACKNOWLEDGE != 0 && !ends_dma;
        if self.sr1 & RECEIVED != 0 {
            self.sr1 |= TRANSFER_FINISHED;
            self.wait(Phase::ReceiverFull { byte, acknowledged });
            return;
        }
        self.received = byte;
        self.sr1 |= RECEIVED;
        self.after_reception(acknowledged, reach.now);
    }

    fn after_reception(&mut self, acknowledged: bool, now: Cycle) {
        if acknowledged && self.cr1 & (START | STOP) == 0 {
            self.enter(Phase::Receive, now, BYTE_BITS);
        } else {
            self.wait(Phase::Held);
        }
    }

    /// Moves what DMA, a waiting byte or a requested condition allows to move now.
    pub fn serve<W: Wiring>(&mut self, reach: &mut Reach<'_, W>) {
        if self.sr1 & RECEIVED != 0 && self.cr2 & DMA_ENABLE != 0 {
            let request = Request::I2cReceive(self.number);
            if reach
                .dma
                .store(reach.memory, request, u32::from(self.received))
            {
                self.data_was_read(reach.now);
            }
        }
        self.serve_conditions(reach.now);
        self.serve_transmit(reach);
    }

    fn serve_transmit<W>(&mut self, reach: &mut Reach<'_, W>) {
        while let Phase::Transmit(sending) = self.phase {
            if self.to_send.is_none() && self.cr2 & DMA_ENABLE != 0 {
                let word = reach.dma.load(reach.memory, Request::I2cSend(self.number));
                self.to_send = word.map(|word| word as u8);
            }
            if sending.is_some() || self.cr1 & (START | STOP) != 0 {
                return;
            }
            let Some(byte) = self.to_send.take() else {
                return;
            };
            self.sr1 &= !TRANSFER_FINISHED;
            self.enter(Phase::Transmit(Some(byte)), reach.now, BYTE_BITS);
        }
    }

    /// Begins a requested stop or start where the bus is at rest.
    fn serve_conditions(&mut self, now: Cycle) {
        let at_rest = matches!(
            self.phase,
            Phase::AwaitAddress | Phase::Transmit(None) | Phase::ReceiverFull { .. } | Phase::Held
        );
        if at_rest && self.cr1 & STOP != 0 {
            self.leave_transfer();
            self.enter(Phase::Stopping, now, 1);
        } else if (at_rest && self.phase != Phase::AwaitAddress || self.phase == Phase::Free)
            && self.cr1 & START != 0
        {
            self.leave_transfer();
            self.enter(Phase::Starting, now, 1);
        } else if self.phase == Phase::Free {
            // Nothing to stop.
            self.cr1 &= !STOP;
        }
    }

    /// A condition clears BTF and empties DR (RM0090 §27.6.6); a received byte stays readable.
    fn leave_transfer(&mut self) {
        self.sr1 &= !(TRANSFER_FINISHED | START_SENT);
        self.sr2 &= !TRANSMITTER;
        self.to_send = None;
    }

    /// DR was read: the next byte may come.
    pub(super) fn data_was_read(&mut self, now: Cycle) {
        self.sr1 &= !(RECEIVED | TRANSFER_FINISHED);
        if let Phase::ReceiverFull { byte, acknowledged } = self.phase {
            self.received = byte;
            self.sr1 |= RECEIVED;
            self.after_reception(acknowledged, now);
        }
    }

    /// Lets go of both wires: devices see a stop.
    pub(super) fn release<W: Wiring>(&mut self, reach: &mut Reach<'_, W>) {
        if self.sr2 & MASTER != 0 {
            let now = reach.nanos();
            reach.wiring.i2c_stop(now, self.number);
        }
        self.wait(Phase::Free);
    }
}
