//! The watch over the wires: what their silence means.

use core::cell::Cell;

use critical_section::Mutex;
use embassy_time::{Duration, Instant};

use super::fault::Fault;
use super::timing::{SILENCE, SYNC_SILENCE};

/// When the wires moved last, whatever became of it.
#[derive(Clone, Copy)]
pub struct Pulse {
    line: Instant,
    sync: Instant,
}

/// Written by the interrupt.
static PULSE: Mutex<Cell<Pulse>> = Mutex::new(Cell::new(Pulse {
    line: Instant::MIN,
    sync: Instant::MIN,
}));

impl Pulse {
    /// The last one.
    pub fn now() -> Self {
        critical_section::with(|section| PULSE.borrow(section).get())
    }

    /// A line has ended. Returns the time since the one before it.
    pub fn line(now: Instant) -> Duration {
        critical_section::with(|section| {
            let last = PULSE.borrow(section).get();
            PULSE.borrow(section).set(Self { line: now, ..last });
            now.saturating_duration_since(last.line)
        })
    }

    /// A frame has ended.
    pub fn sync(now: Instant) {
        critical_section::with(|section| {
            let last = PULSE.borrow(section).get();
            PULSE.borrow(section).set(Self { sync: now, ..last });
        });
    }
}

/// Names the silence of a sensor that should be sending.
pub struct Watch {
    /// From when on silence counts; never, while nothing is to be expected of the sensor.
    since: Option<Instant>,
    /// From when on a missing sync counts: as `since`, or from the last time it was reported.
    sync_since: Instant,
}

impl Watch {
    /// A watch that expects nothing yet.
    pub const fn new() -> Self {
        Self {
            since: None,
            sync_since: Instant::MIN,
        }
    }

    /// The first line is to be there by `at`.
    pub fn expect_signal(&mut self, at: Instant) {
        self.since = Some(at);
        self.sync_since = at;
    }

    /// Silence is no fault from now on.
    pub fn expect_silence(&mut self) {
        self.since = None;
    }

    /// When to [`look`](Self::look) next if nothing moves before.
    pub fn next_look(&self) -> Option<Instant> {
        let (line_due, sync_due) = self.due(Pulse::now())?;
        Some(line_due.min(sync_due))
    }

    /// What is wrong with the wires at `now`. A vertical sync that stays away is told once in
    /// [`SYNC_SILENCE`], the end of the signal once.
    pub fn look(&mut self, now: Instant) -> Option<Fault> {
        let (line_due, sync_due) = self.due(Pulse::now())?;
        if now >= line_due {
            self.expect_silence();
            Some(Fault::NoSignal)
        } else if now >= sync_due {
            self.sync_since = now;
            Some(Fault::NoVsync)
        } else {
            None
        }
    }

    /// By when the next line and the next sync must have come.
    fn due(&self, pulse: Pulse) -> Option<(Instant, Instant)> {
        let since = self.since?;
        Some((
            pulse.line.max(since) + SILENCE,
            pulse.sync.max(self.sync_since) + SYNC_SILENCE,
        ))
    }
}
