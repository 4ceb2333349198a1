//! What a board was shown and told in a flight, in the order in which it took it, so that another one
//! can be shown and told the same.

use std::collections::BTreeMap;

use frames::{Event, Receiver, Shape};
use link::{Message, Mode, Parser};
use nav::CalibrationError;
use pilot::{Outbox, Pilot};

use crate::board::FirmwareLog;
use crate::record::{Deed, Side, What};

/// What may still be on its way when a flight ends.
const TAIL: usize = 3;

/// A frame that the board has looked at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UsedFrame {
    /// Its number.
    pub number: u32,
    /// As it was sent.
    pub wire: Vec<u8>,
}

/// Something that the board took.
#[derive(Clone, Debug, PartialEq)]
pub enum Taken {
    /// A look.
    Frame(UsedFrame),
    /// A message of the autopilot.
    Message {
        /// When it was sent, milliseconds of flight.
        t_ms: u64,
        /// What it says.
        message: Box<Message>,
    },
}

/// The order in which the board took frames and STATE messages, by its own log.
#[derive(Clone, Debug, Default)]
pub struct Order(Vec<Step>);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Step {
    Frame,
    State,
}

impl Order {
    /// A record of the board's log.
    pub fn note(&mut self, record: &FirmwareLog) {
        match record {
            FirmwareLog::Frame(_) => self.0.push(Step::Frame),
            FirmwareLog::Line { text, .. } if text.starts_with("state cycles ") => {
                self.0.push(Step::State);
            }
            _ => {}
        }
    }
}

/// The log does not tell the order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the log tells of {logged_frames} frames and {logged_states} STATE messages, the wires of {frames} and {states}: \
     records or answers were lost"
)]
pub struct Gap {
    /// Frames in the log.
    pub logged_frames: usize,
    /// STATE messages in the log.
    pub logged_states: usize,
    /// Frames that were used by the board's answers.
    pub frames: usize,
    /// STATE messages that were sent.
    pub states: usize,
}

/// All that a board took, in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Transcript {
    /// In order.
    pub taken: Vec<Taken>,
    /// The frames' shape.
    pub shape: Shape,
    /// What the log told of, and what was sent.
    pub known: Gap,
}

/// Coefficients of the snapshots of a recorded route by their index.
pub type Snapshots = BTreeMap<u16, Vec<i8>>;

impl Transcript {
    /// Frames and messages, each in the order in which they were sent, brought into one order.
    ///
    /// # Errors
    /// [`Gap`].
    pub fn merge(
        order: &Order,
        frames: Vec<UsedFrame>,
        messages: Vec<(u64, Message)>,
        shape: Shape,
    ) -> Result<Self, Gap> {
        let is_state = |message: &Message| matches!(message, Message::State(_));
        let logged = |step| order.0.iter().filter(|logged| **logged == step).count();
        let gap = Gap {
            logged_frames: logged(Step::Frame),
            logged_states: logged(Step::State),
            frames: frames.len(),
            states: messages
                .iter()
                .filter(|(_, message)| is_state(message))
                .count(),
        };
        let lacks = |logged: usize, known: usize| logged > known || logged + TAIL < known;
        if lacks(gap.logged_frames, gap.frames) || lacks(gap.logged_states, gap.states) {
            return Err(gap);
        }
        let (mut frames, mut messages) = (frames.into_iter(), messages.into_iter());
        let mut taken = Vec::new();
        for step in &order.0 {
            match step {
                Step::Frame => taken.extend(frames.next().map(Taken::Frame)),
                Step::State => {
                    for (t_ms, message) in messages.by_ref() {
                        let last = is_state(&message);
                        let message = Box::new(message);
                        taken.push(Taken::Message { t_ms, message });
                        if last {
                            break;
                        }
                    }
                }
            }
        }
        Ok(Self {
            taken,
            shape,
            known: gap,
        })
    }

    /// The first difference of a board's snapshots from those that this machine takes, in words; none where they are
    /// the same.
    ///
    /// # Errors
    /// [`CalibrationError`], never with the default lens.
    pub fn difference(&self, of_board: &Snapshots) -> Result<Option<String>, CalibrationError> {
        let here = self.snapshots()?;
        let differs = |index: &u16| of_board.get(index) != here.get(index);
        let mut all = of_board.keys().chain(here.keys());
        let in_words = |snapshot: Option<&Vec<i8>>| {
            snapshot.map_or("none".to_owned(), |snapshot| format!("{snapshot:?}"))
        };
        Ok(all.find(|index| differs(index)).map(|index| {
            format!(
                "the board took other snapshots than this machine does from the same frames: the first is {index}, {} \
                 there and {} here; its log tells of {} frames of {} and {} STATE messages of {}",
                in_words(of_board.get(index)),
                in_words(here.get(index)),
                self.known.logged_frames,
                self.known.frames,
                self.known.logged_states,
                self.known.states,
            )
        }))
    }

    /// The snapshots that this machine takes of it, by the same logic compiled for it.
    ///
    /// # Errors
    /// [`CalibrationError`], never with the default lens.
    pub fn snapshots(&self) -> Result<Snapshots, CalibrationError> {
        let mut pilot = Pilot::new(&pilot::Parameters::DEFAULT)?;
        let mut receiver = Receiver::new(self.shape);
        let mut frame = Box::new([0; pilot::FRAME_LAYOUT.bytes()]);
        let mut said = Said::default();
        for taken in &self.taken {
            match taken {
                Taken::Frame(used) => {
                    let mut bytes = &used.wire[..];
                    while let Some(event) =
                        receiver.next_event(0, &mut bytes, Some(frame.as_mut_slice()))
                    {
                        if matches!(event, Event::Frame { .. }) {
                            pilot.on_frame(&frame);
                        }
                    }
                }
                Taken::Message { t_ms, message } => {
                    said.on_sent(message);
                    let mut outbox = Outbox::new();
                    pilot.on_message(*t_ms as u32, message, &mut outbox);
                    said.on_answer(outbox.bytes());
                }
            }
        }
        Ok(said.snapshots)
    }
}

/// The snapshots that a board took on the way out, by all that both ends said on the link. The recording's marks
/// may lack some: they are of the messages that the app used, and of ten it uses nine.
pub fn snapshots_said(deeds: &[Deed]) -> Snapshots {
    let mut said = Said::default();
    for deed in deeds {
        if let What::Sent { by, message } = &deed.what {
            match by {
                Side::Autopilot => said.on_sent(message),
                Side::Camera => said.on_said(message),
            }
        }
    }
    said.into_snapshots()
}

/// Collects the snapshots out of what a board says while it records.
#[derive(Debug, Default)]
pub struct Said {
    parser: Parser,
    follows: bool,
    snapshots: Snapshots,
}

impl Said {
    /// The autopilot has sent a message.
    pub fn on_sent(&mut self, message: &Message) {
        if let Message::Command(command) = message {
            self.follows |= command.command == Mode::Follow.byte();
        }
    }

    /// The board has sent bytes.
    pub fn on_answer(&mut self, bytes: &[u8]) {
        let heard: Vec<_> = self.parser.frames(bytes).collect();
        for frame in heard {
            self.on_said(&frame.message);
        }
    }

    /// The board has sent a message.
    pub fn on_said(&mut self, message: &Message) {
        if let Message::Map(map) = message
            && !self.follows
            && !map.snapshot_ak_bk.is_empty()
        {
            let coefficients = map.snapshot_ak_bk.to_vec();
            self.snapshots.insert(map.snapshot_index, coefficients);
        }
    }

    /// All of them.
    pub fn into_snapshots(self) -> Snapshots {
        self.snapshots
    }
}
