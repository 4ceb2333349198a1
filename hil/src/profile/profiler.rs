//! From events to a profile, as they come.

use emulator::core::Cycle;
use emulator::trace::Event;

use super::figures::Profile;
use super::frames::{FrameProfile, Frames, Miss};
use super::ledger::Ledger;
use super::symbols::Symbols;
use super::timeline::{Timeline, Window};
use super::wires::Wires;
use crate::board::BoardError;
use crate::board::emulated::{Emulated, LINK_USART};
use crate::board::observer::{Interest, Observer};
use crate::board::timing::TimingModel;

/// The observer of a flight.
#[derive(Debug)]
pub struct Profiler {
    symbols: Symbols,
    timing: TimingModel,
    core_hz: u32,
    /// The cycle of the flight's time zero.
    zero: Cycle,
    ledger: Ledger,
    frames: Frames,
    wires: Wires,
    misses: Vec<Miss>,
    window: Option<Window>,
    timeline: Option<Timeline>,
}

impl Profiler {
    /// A profiler of a flight under these assumptions that draws up the time line of a window, should
    /// there be one.
    pub fn new(timing: TimingModel, window: Option<Window>) -> Self {
        Self {
            symbols: Symbols::default(),
            timing,
            core_hz: 1,
            zero: 0,
            ledger: Ledger::default(),
            frames: Frames::default(),
            wires: Wires::new(LINK_USART),
            misses: Vec::new(),
            window,
            timeline: None,
        }
    }

    /// The figures; the frames; and the time line.
    pub fn finish(self) -> (Profile, Vec<FrameProfile>, Option<Timeline>) {
        let books = self.ledger.books();
        let profile = Profile::new(
            &self.frames,
            self.misses,
            books,
            &self.symbols,
            self.core_hz,
            self.timing,
        );
        (profile, self.frames.seen, self.timeline)
    }

    fn follow(&mut self, event: &Event) {
        if let Some((stage, cycles)) = self.ledger.book(event, &self.symbols) {
            self.frames.spend(stage, cycles);
        }
        if self.frames.follow(event, &self.symbols) {
            self.misses.push(Miss {
                at_s: (event.at - self.zero) as f64 / f64::from(self.core_hz),
                running: self.ledger.running(&self.symbols),
            });
        }
        let heard = self.wires.hear(event);
        if let Some(heard) = &heard {
            self.frames.hear(heard);
        }
        if let Some(timeline) = &mut self.timeline {
            timeline.draw(event, heard.as_ref(), &self.symbols);
        }
    }
}

impl Observer for Profiler {
    fn begin(&mut self, board: &Emulated) -> Result<Interest, BoardError> {
        self.symbols = Symbols::of(board.image(), board.memory())?;
        self.core_hz = board.core_hz();
        self.zero = board.cycles();
        let window = self.window.take();
        self.timeline = window.map(|window| Timeline::new(window, self.zero, self.core_hz));
        Ok(Interest::Events(self.symbols.addresses()))
    }

    fn events(&mut self, events: &[Event]) {
        for event in events {
            self.follow(event);
        }
    }
}
