//! What a machine does, event by event, for whoever profiles it. Nothing is recorded unless somebody
//! asked for it, and recording changes nothing.

use crate::core::Cycle;

/// Something that happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Event {
    /// When, in HCLK cycles since power-on.
    pub at: Cycle,
    /// What.
    pub what: What,
}

/// The kinds of events.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    /// A traced function begins: its first instruction is next.
    Entered(u32),
    /// A traced function, by its first instruction, has returned.
    Returned(u32),
    /// The core begins to stack a context for this exception; 16 is interrupt 0.
    ExceptionEntered(u8),
    /// The context of an exception is unstacked, or the next handler begins without (tail-chaining).
    ExceptionReturned(u8),
    /// The core has nothing to do.
    Slept {
        /// Until then.
        until: Cycle,
    },
    /// The chip was reset: all contexts are gone.
    Reset,
    /// A DMA stream has moved the last item of a transfer, or of one of its two buffers.
    DmaDone {
        /// 1 or 2.
        controller: u8,
        /// 0 to 7.
        stream: u8,
    },
    /// The start bit of a byte on a USART's wire.
    Byte {
        /// 1 to 6.
        usart: u8,
        /// Which wire.
        wire: SerialWire,
        /// The byte.
        byte: u8,
        /// The end of its stop bit.
        ends: Cycle,
    },
    /// The camera begins a frame.
    FrameStart,
    /// The last byte of a camera's line is through.
    Line,
    /// The camera's frame has ended.
    FrameEnd,
}

/// A wire of a USART, as the chip sees it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SerialWire {
    /// RX.
    Receive,
    /// TX.
    Transmit,
}

/// Where events are kept, if they are to be.
#[derive(Clone, Debug, Default)]
pub(crate) struct Recorder(Option<Vec<Event>>);

impl Recorder {
    /// Records from now on.
    pub fn start(&mut self) {
        self.0.get_or_insert_default();
    }

    /// Records an event.
    #[inline]
    pub fn note(&mut self, at: Cycle, what: What) {
        if let Some(events) = &mut self.0 {
            events.push(Event { at, what });
        }
    }

    /// Records sleep; what continues the last becomes one with it.
    pub fn note_sleep(&mut self, from: Cycle, to: Cycle) {
        let Some(events) = &mut self.0 else {
            return;
        };
        if let Some(Event {
            what: What::Slept { until },
            ..
        }) = events.last_mut()
            && *until == from
        {
            *until = to;
            return;
        }
        let what = What::Slept { until: to };
        events.push(Event { at: from, what });
    }

    /// Moves what was recorded since the last time to `into`.
    pub fn take(&mut self, into: &mut Vec<Event>) {
        if let Some(events) = &mut self.0 {
            into.append(events);
        }
    }
}
