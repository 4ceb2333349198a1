//! A frame's stages, its deadline, and the way from its last pixel to the vector's first byte.

use emulator::core::Cycle;
use emulator::trace::{Event, SerialWire, What};
use fake_sensors::camera::HEIGHT;
use link::Message;
use serde::Serialize;

use super::stage::Stage;
use super::symbols::Symbols;
use super::wires::Heard;

/// What a frame took, by stage; none where it was not needed.
pub type Cycles = [Option<Cycle>; Stage::ALL.len()];

/// A frame that the firmware looked at, and the answers that followed from it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameProfile {
    /// Cycles of each stage, in the order of [`Stage::ALL`].
    pub stages: Cycles,
    /// When its last pixel was in memory.
    pub last_pixel: Cycle,
    /// When the firmware was through with it.
    pub done: Cycle,
    /// From there until the last pixel of the next frame; none of the last.
    pub margin: Option<Cycle>,
}

impl FrameProfile {
    /// Cycles of the stages of vision together.
    pub fn vision(&self) -> Cycle {
        let stages = Stage::VISION.map(|stage| self.stages[stage as usize]);
        stages.into_iter().flatten().sum()
    }

    fn add(&mut self, stage: Stage, cycles: Cycle) {
        *self.stages[stage as usize].get_or_insert(0) += cycles;
    }
}

/// A frame that was complete and not looked at before the next was.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Miss {
    /// When the next was complete, seconds since power-on.
    pub at_s: f64,
    /// What the core was at.
    pub running: String,
}

/// The frames of a flight.
#[derive(Debug, Default)]
pub struct Frames {
    /// Those that were looked at.
    pub seen: Vec<FrameProfile>,
    /// Cycles from the last pixel of a frame until it was looked at, and from the last byte of a STATE
    /// to the first of the VECTOR that answers it: without the wait of the view for the STATE.
    pub pixel_to_vector: Vec<Cycle>,
    /// The second part alone.
    pub answer: Vec<Cycle>,
    lines: usize,
    /// Of the newest whole frame, until it is looked at.
    waiting: Option<Cycle>,
    looking: Option<FrameProfile>,
    state: Option<Cycle>,
    /// The answer is being made, or waits for the wire.
    answered: Option<Cycle>,
}

impl Frames {
    /// Takes cycles to the books of the frame that is being looked at, or was last.
    pub fn spend(&mut self, stage: Stage, cycles: Cycle) {
        if let Some(frame) = self.looking.as_mut().or(self.seen.last_mut()) {
            frame.add(stage, cycles);
        }
    }

    /// Follows the camera, vision and the answers. True: a frame's deadline has passed unmet.
    pub fn follow(&mut self, event: &Event, symbols: &Symbols) -> bool {
        match event.what {
            What::FrameStart => self.lines = 0,
            What::Line => {
                self.lines += 1;
                if self.lines == HEIGHT {
                    return self.complete(event.at);
                }
            }
            What::Entered(address) if symbols.is_vision(address) => self.begin(event.at),
            What::Returned(address) if symbols.is_vision(address) => {
                if let Some(frame) = self.looking.take() {
                    let done = event.at;
                    self.seen.push(FrameProfile { done, ..frame });
                }
            }
            What::Entered(address) if symbols.is_answer(address) => self.answered = None,
            What::Returned(address) if symbols.is_answer(address) => {
                self.answered = Some(event.at);
            }
            What::Byte {
                wire: SerialWire::Transmit,
                ..
            } => {
                if let Some(answered) = self.answered.take() {
                    self.spend(Stage::Send, event.at - answered);
                }
            }
            _ => {}
        }
        false
    }

    /// Follows the conversation.
    pub fn hear(&mut self, heard: &Heard) {
        match (heard.wire, &heard.message) {
            (SerialWire::Receive, Message::State(_)) => self.state = Some(heard.ended),
            (SerialWire::Transmit, Message::Vector(_)) => {
                let (Some(state), Some(frame)) = (self.state.take(), self.seen.last()) else {
                    return;
                };
                let answer = heard.began.saturating_sub(state);
                self.answer.push(answer);
                self.pixel_to_vector
                    .push(frame.done - frame.last_pixel + answer);
            }
            _ => {}
        }
    }

    /// A frame is complete. True: the one before was not looked at.
    fn complete(&mut self, at: Cycle) -> bool {
        if let Some(last) = self.seen.last_mut() {
            last.margin.get_or_insert(at.saturating_sub(last.done));
        }
        let missed = self.waiting.replace(at).is_some() || self.looking.is_some();
        // What the firmware skips before its first is no deadline's matter.
        missed && !self.seen.is_empty()
    }

    fn begin(&mut self, at: Cycle) {
        let last_pixel = self.waiting.take().unwrap_or(at);
        let mut frame = FrameProfile {
            last_pixel,
            ..FrameProfile::default()
        };
        frame.add(Stage::CaptureWait, at - last_pixel);
        self.looking = Some(frame);
    }
}
