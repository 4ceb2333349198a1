//! The board's end: bytes to frames, in place.

mod incoming;

use heapless::Deque;

use crate::coding::{Coding, Painter};
use crate::pieces::{Piece, coding_of};
use crate::record::Damage;
use crate::request::Request;
use crate::shape::Shape;
use crate::stuffing::{Unstuffed, Unstuffer};
use crate::verdict::{Counts, Verdict};
use incoming::Incoming;

/// What the receiver found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// The host asks for something.
    Asked(Request),
    /// The buffer holds this frame, whole. The next bytes need another buffer.
    Frame {
        /// Its number.
        number: u32,
    },
    /// A frame that will never be one.
    Dropped {
        /// Its number.
        number: u32,
        /// Why.
        why: Verdict,
    },
    /// A record that is none.
    Corrupt(Damage),
}

/// The receiving end of a board.
///
/// The pieces of a frame are written into the caller's buffer as their bytes come, before their check
/// sums are known: a copy less, and nobody looks at the buffer before [`Event::Frame`]. That comes when
/// every piece from the first byte to the last has come in order, under the frame's number, and with
/// the right sum; a piece is written where the ones before it end or at the frame's beginning, so
/// that no broken one can spoil what is right and still be followed by a whole frame.
#[derive(Debug)]
pub struct Receiver {
    shape: Shape,
    unstuffer: Unstuffer,
    record: Incoming,
    /// The piece that is being written.
    painter: Option<Painter>,
    /// The frame that is coming.
    coming: Option<Coming>,
    /// The frame that is dropped already; the rest of its pieces is passed over.
    dropped: Option<u32>,
    /// The last whole frame.
    newest: Option<u32>,
    fresh_ms: u32,
    counts: Counts,
    /// What one byte brought more than one can return.
    events: Deque<Event, 4>,
}

/// A frame of which some pieces have come.
#[derive(Clone, Copy, Debug)]
struct Coming {
    number: u32,
    /// Bytes that are in their place, from the first on.
    filled: usize,
    since_ms: u32,
    /// Another frame's first piece began to be written over it.
    spoilt: bool,
}

impl Receiver {
    /// A receiver of frames of this shape, that has seen nothing.
    pub const fn new(shape: Shape) -> Self {
        Self {
            shape,
            unstuffer: Unstuffer::new(),
            record: Incoming::new(),
            painter: None,
            coming: None,
            dropped: None,
            newest: None,
            fresh_ms: u32::MAX,
            counts: Counts::NONE,
            events: Deque::new(),
        }
    }

    /// What has arrived so far.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Takes received bytes until something is to be told. `bytes` is moved past what was taken: call
    /// again until `None`.
    ///
    /// `now_ms` is any clock that wraps at 2^32. `buffer` takes the frame: the same one until
    /// [`Event::Frame`], at least [`Shape::bytes`] long; none while there is none, and frames that
    /// begin then are [`Verdict::Busy`].
    pub fn next_event(
        &mut self,
        now_ms: u32,
        bytes: &mut &[u8],
        mut buffer: Option<&mut [u8]>,
    ) -> Option<Event> {
        loop {
            if let Some(event) = self.events.pop_front() {
                return Some(event);
            }
            let [byte, rest @ ..] = *bytes else {
                return None;
            };
            *bytes = rest;
            match self.unstuffer.push(*byte) {
                Unstuffed::Nothing => {}
                Unstuffed::Byte(byte) => self.take(byte, buffer.as_deref_mut()),
                Unstuffed::End { whole } => self.end(now_ms, whole),
            }
        }
    }

    /// Says that the wire has been silent for longer than a frame may pause: what has begun will not
    /// be completed. The next call of [`Self::next_event`] tells, and needs no bytes for that.
    pub fn give_up(&mut self) {
        self.tear();
    }

    /// A byte of a record.
    fn take(&mut self, byte: u8, buffer: Option<&mut [u8]>) {
        match (&mut self.painter, buffer) {
            (Some(painter), Some(buffer)) => {
                self.record.sum(byte);
                if painter.at() == 0 {
                    self.coming = self.coming.map(|coming| Coming {
                        spoilt: true,
                        ..coming
                    });
                }
                let frame = self.shape.bytes().min(buffer.len());
                let frame = buffer.get_mut(..frame).unwrap_or_default();
                painter.push(byte, &self.shape, frame);
            }
            (_, buffer) => {
                self.record.push(byte);
                if let Some((coding, piece)) = self.piece_header() {
                    self.painter = buffer.and_then(|_| self.painter(coding, piece));
                }
            }
        }
    }

    /// The header of a piece, at the moment at which it is there.
    fn piece_header(&self) -> Option<(Coding, Piece)> {
        let (kind, header) = self.record.piece_header()?;
        Some((coding_of(kind)?, Piece::decode(header)))
    }

    /// Where a piece may be written.
    fn painter(&self, coding: Coding, piece: Piece) -> Option<Painter> {
        let offset = usize::from(piece.offset);
        let fits = match self.coming {
            _ if offset == 0 => self.judge(piece.number).is_none(),
            Some(coming) => coming.number == piece.number && coming.filled == offset,
            None => false,
        };
        fits.then_some(Painter::new(coding, offset))
    }

    /// What is wrong with a frame's number.
    fn judge(&self, number: u32) -> Option<Verdict> {
        // Numbers wrap: the half of them that lies behind the newest is older.
        match number.wrapping_sub(self.newest?) as i32 {
            0 => Some(Verdict::Repeated),
            1.. => None,
            _ => Some(Verdict::Late),
        }
    }

    /// The end of a record.
    fn end(&mut self, now_ms: u32, whole: bool) {
        let incoming = core::mem::replace(&mut self.record, Incoming::new());
        let written = self.painter.take().map(|painter| painter.at());
        let record = match incoming.finish(whole) {
            Ok(Some(record)) => record,
            Ok(None) => return,
            Err(damage) => return self.corrupt(damage),
        };
        if coding_of(record.kind).is_some() {
            match incoming.header() {
                Some(header) => self.place(now_ms, Piece::decode(header), written),
                None => self.corrupt(Damage::Unknown),
            }
        } else {
            let body = record.body;
            match body.and_then(|body| Request::decode(record.kind, body)) {
                Some(request) => self.obey(request),
                None => self.corrupt(Damage::Unknown),
            }
        }
    }

    fn corrupt(&mut self, damage: Damage) {
        self.counts.corrupt = self.counts.corrupt.wrapping_add(1);
        self.tell(Event::Corrupt(damage));
        if self.coming.is_some_and(|coming| coming.spoilt) {
            self.tear();
        }
    }

    fn obey(&mut self, request: Request) {
        match request {
            Request::Begin { fresh_ms } => {
                self.tear();
                self.newest = None;
                self.dropped = None;
                self.fresh_ms = u32::from(fresh_ms);
            }
            Request::End => self.tear(),
            Request::Identify | Request::Count => {}
        }
        self.tell(Event::Asked(request));
    }

    /// A right piece, written up to `written` if it was.
    fn place(&mut self, now_ms: u32, piece: Piece, written: Option<usize>) {
        let number = piece.number;
        if piece.offset == 0 {
            self.tear();
            self.dropped = None;
            match (self.judge(number), written) {
                (None, Some(filled)) => self.go_on(now_ms, number, filled, now_ms),
                (None, None) => self.drop(number, Verdict::Busy),
                (Some(why), _) => self.drop(number, why),
            }
            return;
        }
        match (self.coming, written) {
            (Some(coming), Some(filled)) => {
                self.go_on(now_ms, number, filled, coming.since_ms);
            }
            _ if self.dropped == Some(number) => {}
            _ => {
                let torn = self.coming.is_some_and(|coming| coming.number == number);
                self.tear();
                if !torn {
                    self.drop(number, self.judge(number).unwrap_or(Verdict::Torn));
                }
            }
        }
    }

    /// The frame `number` is right up to `filled`.
    fn go_on(&mut self, now_ms: u32, number: u32, filled: usize, since_ms: u32) {
        self.coming = None;
        if filled < self.shape.bytes() {
            self.coming = Some(Coming {
                number,
                filled,
                since_ms,
                spoilt: false,
            });
        } else if filled > self.shape.bytes() {
            self.drop(number, Verdict::Torn);
        } else if now_ms.wrapping_sub(since_ms) > self.fresh_ms {
            self.drop(number, Verdict::Late);
        } else {
            self.newest = Some(number);
            self.counts.whole = self.counts.whole.wrapping_add(1);
            self.tell(Event::Frame { number });
        }
    }

    /// Gives up the frame that is coming.
    fn tear(&mut self) {
        if let Some(coming) = self.coming.take() {
            self.drop(coming.number, Verdict::Torn);
        }
    }

    fn drop(&mut self, number: u32, why: Verdict) {
        self.dropped = Some(number);
        self.counts.drop(why);
        self.tell(Event::Dropped { number, why });
    }

    /// Three at most come of one byte, and all are told before the next is taken.
    fn tell(&mut self, event: Event) {
        let _ = self.events.push_back(event);
    }
}
