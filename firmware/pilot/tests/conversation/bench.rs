//! A pilot, its clock and the autopilot's ear.

#![allow(dead_code, reason = "several tests share it, and none needs all of it")]

use heapless::Vec as Args;
use link::{Command, Message, Parser, State};
use pilot::{Event, Frame, FrameReport, Outbox, PERIOD_BYTES, Parameters, Pilot};

/// Time between two STATE messages.
const STATE_PERIOD_MS: u32 = 100;

/// Bytes of a pixel (U Y V Y), pixels of a row, and the edge of a patch of even luma.
const PIXEL_BYTES: usize = 2;
const ROW_PIXELS: usize = 128;
const PATCH_PIXELS: usize = 24;

pub struct Bench {
    pub pilot: Pilot,
    now_ms: u32,
    /// What the messages of the last `hear` told.
    pub events: Vec<Event>,
}

impl Bench {
    pub fn new() -> Self {
        Self {
            pilot: Pilot::new(&Parameters::DEFAULT).expect("the default lens is valid"),
            now_ms: 0,
            events: vec![],
        }
    }

    pub fn see(&mut self, frame: &Frame) -> FrameReport {
        self.pilot.on_frame(frame)
    }

    /// The answer to a message. Whatever the message: whole frames, and no more of them than the
    /// autopilot can take.
    pub fn hear(&mut self, message: &Message) -> Vec<Message> {
        let mut outbox = Outbox::new();
        let events = self.pilot.on_message(self.now_ms, message, &mut outbox);
        self.events = events.to_vec();
        assert!(outbox.bytes().len() <= PERIOD_BYTES);
        let mut parser = Parser::new();
        let answer: Vec<_> = parser
            .frames(outbox.bytes())
            .map(|frame| frame.message)
            .collect();
        assert_eq!(parser.held(), 0, "the last frame was cut");
        assert_eq!(parser.counters().bytes_skipped, 0, "a frame was cut");
        answer
    }

    pub fn command(&mut self, command: u8, args: &[u8]) -> Vec<Message> {
        let args = Args::from_slice(args).expect("few arguments");
        self.hear(&Message::Command(Command { command, args }))
    }

    /// Time in which nothing is heard.
    pub fn wait(&mut self, ms: u32) {
        self.now_ms = self.now_ms.wrapping_add(ms);
    }

    /// A STATE, a period after the last one: metres north and east, radians clockwise from north.
    pub fn state(&mut self, north: f32, east: f32, psi: f32) -> Vec<Message> {
        self.now_ms = self.now_ms.wrapping_add(STATE_PERIOD_MS);
        self.hear(&Message::State(State {
            ins_e: east,
            ins_n: north,
            psi,
            ..State::default()
        }))
    }
}

/// The message that says a mode.
pub fn mode(command: u8) -> Message {
    Message::Command(Command {
        command,
        args: Args::new(),
    })
}

/// A frame of one luma.
pub fn uniform(luma: u8) -> Frame {
    core::array::from_fn(|byte| if byte % PIXEL_BYTES == 1 { luma } else { 128 })
}

/// A frame of patches, no two alike: something to be seen in every direction.
pub fn patches() -> Frame {
    core::array::from_fn(|byte| {
        let pixel = byte / PIXEL_BYTES;
        let (column, row) = (pixel % ROW_PIXELS, pixel / ROW_PIXELS);
        let patch = column / PATCH_PIXELS + 6 * (row / PATCH_PIXELS);
        // 97 is prime to 200: lumas from 20 to 219 in no order.
        (20 + patch * 97 % 200) as u8
    })
}
