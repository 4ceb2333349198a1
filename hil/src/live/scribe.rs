//! Tells people what happens while it happens, and writes it down.

use std::time::Duration;

use link::{Message, Parser};

use crate::record::{Recording, Side};
use crate::recorder::Recorder;
use crate::summary::PaceFigures;

use super::pace::LATE;
use super::port::{News, Unsent};

/// Lines about broken poses that are told and written down; the others are only counted.
const TOLD_BAD_LINES: u64 = 20;

/// Something for people, now.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Notice {
    /// What it concerns, and what happened.
    Status(&'static str, String),
    /// Something that is not as it should be.
    Warning(String),
}

/// A recorder with a voice.
pub struct Scribe<'s> {
    /// What is written down.
    pub recorder: Recorder,
    say: &'s dyn Fn(Notice),
    bad_lines: u64,
}

impl<'s> Scribe<'s> {
    /// Before the flight; `recording` holds what is known beforehand.
    pub fn new(recording: Recording, say: &'s dyn Fn(Notice)) -> Self {
        Self {
            recorder: Recorder::new(recording),
            say,
            bad_lines: 0,
        }
    }

    /// Something that the recorder has of itself.
    pub fn say(&self, verb: &'static str, text: String) {
        (self.say)(Notice::Status(verb, text));
    }

    /// What goes as it should.
    pub fn tell(&mut self, now_ms: u64, verb: &'static str, text: String) {
        self.recorder
            .note(now_ms, "info", format!("{}: {text}", verb.to_lowercase()));
        self.say(verb, text);
    }

    /// What does not.
    pub fn warn(&mut self, now_ms: u64, text: String) {
        self.recorder.note(now_ms, "warn", text.clone());
        (self.say)(Notice::Warning(text));
    }

    /// What happened at a port.
    pub fn news(&mut self, now_ms: u64, verb: &'static str, news: News) {
        match news {
            News::Came(peer) => self.tell(now_ms, verb, format!("connected: {peer}")),
            News::Gone { peer, .. } => {
                let text = format!("{}: peer lost: {peer}", verb.to_lowercase());
                self.warn(now_ms, text);
            }
            News::Note(text) => self.tell(now_ms, verb, text),
        }
    }

    /// What happened at the link, whose far end is `to`.
    pub fn link_news(&mut self, now_ms: u64, to: Side, news: News) {
        if let News::Gone { unread, .. } = &news {
            for frame in Parser::new().frames(unread) {
                self.unsent(now_ms, to, frame.message.name(), Unsent::NoPeer);
            }
        }
        self.news(now_ms, "Link", news);
    }

    /// A line that is no pose.
    pub fn bad_line(&mut self, now_ms: u64, error: &dyn std::fmt::Display) {
        self.bad_lines += 1;
        if self.bad_lines <= TOLD_BAD_LINES {
            self.warn(
                now_ms,
                format!("not a pose: {error}; the last good one holds"),
            );
        }
    }

    /// A frame could not be handed over; `to` is who did not get it.
    pub fn unsent(&mut self, now_ms: u64, to: Side, message: &str, why: Unsent) {
        let why = format!("not handed over: {why}");
        self.recorder.link_loss(now_ms, to, message.to_owned(), why);
    }
}

impl Scribe<'_> {
    /// The flight has fallen behind the clock.
    pub fn behind(&mut self, now_ms: u64, late: Duration) {
        let text = format!(
            "{:.1} s behind the clock: this machine is too slow, or has too much else to do",
            late.as_secs_f64()
        );
        self.warn(now_ms, text);
    }

    /// A frame came to `to` when the flight had ended.
    pub fn too_late(&mut self, now_ms: u64, to: Side, message: &Message) {
        let (message, why) = (message.name().to_owned(), "came after the end".to_owned());
        self.recorder.link_loss(now_ms, to, message, why);
    }

    /// How well the flight kept step with the clock.
    pub fn report_pace(&mut self, now_ms: u64, pace: &PaceFigures) {
        let text = format!(
            "{:.2} % of the steps began more than {} ms late, the latest {:.1} ms",
            100.0 * pace.late_share,
            LATE.as_millis(),
            pace.largest_lateness_ms
        );
        if pace.late_share > 0.0 {
            self.warn(now_ms, text);
        } else {
            self.recorder.note(now_ms, "info", text);
        }
    }
}
