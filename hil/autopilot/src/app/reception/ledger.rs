//! Accounts for every frame that arrives: it is read, or it is reported as dropped.
//!
//! A strict parser looks at all bytes as they arrive, and so knows every good frame and where it
//! stands. What the app's own receiver then finds, loses or never gets to see is held against that.

use std::collections::VecDeque;

use link::Refused;

use super::dropped::{DropReason, Dropped};
use super::receiver::{Found, NumberedByte, Span, Strict};

/// A good frame that has arrived.
#[derive(Debug, Clone, Copy)]
struct Arrived {
    span: Span,
    message: &'static str,
}

/// The books of one receive buffer.
#[derive(Debug, Default)]
pub struct Ledger {
    /// Knows the good frames.
    witness: Strict,
    /// What the witness takes next.
    arriving: VecDeque<NumberedByte>,
    /// Good frames that the app has not got to yet, in order.
    unread: VecDeque<Arrived>,
    /// Frames that the app's receiver found before the witness was certain of them.
    read_early: VecDeque<Span>,
    /// Bytes lost for want of room that no report mentions yet, in order.
    lost: VecDeque<u64>,
    /// Frames that have been reported for lost bytes and may still turn up as broken ones.
    cut: VecDeque<Span>,
    /// The byte behind the last that the app's receiver is done with.
    read_end: u64,
    dropped: Vec<Dropped>,
}

impl Ledger {
    /// A byte has arrived, and found room in the buffer or not.
    pub fn arrive(&mut self, now_ms: u64, byte: NumberedByte, has_room: bool) {
        if !has_room {
            self.lost.push_back(byte.0);
        }
        self.arriving.push_back(byte);
        while let Some(found) = self.witness.next(&mut self.arriving) {
            if let Found::Message(span, message) = found {
                let message = message.name();
                self.witnessed(now_ms, Arrived { span, message });
            }
        }
    }

    /// The app's receiver is done with all bytes in front of number `end`.
    pub fn read_to(&mut self, now_ms: u64, end: u64) {
        self.read_end = end;
        while let Some(frame) = pop_front_if(&mut self.unread, |frame| frame.span.end <= end) {
            self.report(now_ms, frame.message, frame.span, DropReason::Swallowed);
        }
    }

    /// The app's receiver has found a message here.
    pub fn found(&mut self, now_ms: u64, span: Span) {
        self.read_to(now_ms, span.start);
        self.forget_cut(span.start);
        match self.unread.iter().position(|frame| frame.span == span) {
            Some(index) => {
                self.unread.remove(index);
            }
            None => self.read_early.push_back(span),
        }
        self.read_to(now_ms, span.end);
    }

    /// The app's receiver has refused these bytes.
    pub fn refused(&mut self, now_ms: u64, span: Span, refused: Refused) {
        let why = DropReason::Refused(refused.why);
        self.unusable(now_ms, refused.message_name(), span, why);
    }

    /// The app's receiver has found no start byte in these bytes.
    pub fn noise(&mut self, now_ms: u64, span: Span) {
        self.unusable(now_ms, "?", span, DropReason::NoStart);
    }

    /// Bytes of no use; unless they are the rest of a frame that is reported already.
    fn unusable(&mut self, now_ms: u64, message: &'static str, span: Span, why: DropReason) {
        self.forget_cut(span.start);
        let reported = self.cut.front().is_some_and(|cut| cut.start <= span.start);
        if !reported {
            self.report(now_ms, message, span, why);
        }
    }

    /// A message that was found is not going to be used.
    pub fn discarded(&mut self, now_ms: u64, message: &'static str, span: Span, why: DropReason) {
        self.report(now_ms, message, span, why);
    }

    /// Nothing that has arrived so far will be read.
    pub fn abandon(&mut self, now_ms: u64) {
        while let Some(frame) = self.unread.pop_front() {
            self.report(now_ms, frame.message, frame.span, DropReason::NotRead);
        }
        self.report_noise_lost(now_ms, u64::MAX);
        self.read_early.clear();
        self.cut.clear();
    }

    /// What has been dropped since the last call, in the order in which it became certain.
    pub fn take(&mut self) -> Vec<Dropped> {
        std::mem::take(&mut self.dropped)
    }

    /// The witness has seen a good frame.
    fn witnessed(&mut self, now_ms: u64, frame: Arrived) {
        let Span { start, end } = frame.span;
        self.report_noise_lost(now_ms, start);
        let mut is_cut = false;
        while pop_front_if(&mut self.lost, |number| *number < end).is_some() {
            is_cut = true;
        }
        if is_cut {
            self.cut.push_back(frame.span);
            self.report(now_ms, frame.message, frame.span, DropReason::BufferFull);
        } else if end > self.read_end {
            self.unread.push_back(frame);
        } else if !self.read_early.contains(&frame.span) {
            self.report(now_ms, frame.message, frame.span, DropReason::Swallowed);
        }
        self.read_early.retain(|early| early.end > end);
    }

    /// Frames in front of number `start` cannot turn up any more.
    fn forget_cut(&mut self, start: u64) {
        self.cut.retain(|cut| cut.end > start);
    }

    /// Lost bytes in front of number `end` belong to no good frame.
    fn report_noise_lost(&mut self, now_ms: u64, end: u64) {
        let first = self.lost.front().copied();
        let mut last = None;
        while let Some(number) = pop_front_if(&mut self.lost, |number| *number < end) {
            last = Some(number);
        }
        if let (Some(start), Some(last)) = (first, last) {
            let end = last + 1;
            self.report(now_ms, "?", Span { start, end }, DropReason::BufferFull);
        }
    }

    fn report(&mut self, at_ms: u64, message: &'static str, span: Span, why: DropReason) {
        let bytes = (span.end - span.start) as usize;
        self.dropped.push(Dropped {
            at_ms,
            message,
            bytes,
            why,
        });
    }
}

fn pop_front_if<T>(queue: &mut VecDeque<T>, wanted: impl FnOnce(&T) -> bool) -> Option<T> {
    if wanted(queue.front()?) {
        queue.pop_front()
    } else {
        None
    }
}
