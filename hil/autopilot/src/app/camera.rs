//! The camera as the app sees it: what is sent to it, and what its messages do.

use link::{Implausible, Message, Mode, State, WorldPoint, WorldPose};
use nalgebra::Vector3;

use super::correction::Corrections;
use super::goal::Goal;
use super::handshake::Handshake;
use super::settings::CorrectionSd;
use super::uart::Uart;
use crate::ekf::Measurement;

/// A message the app has taken from its UART.
#[derive(Debug, Clone, PartialEq)]
pub struct Received {
    /// When it was handled, ms: at the end of the window in which it was read.
    pub at_ms: u64,
    /// What it says.
    pub message: Message,
}

/// How often each thing happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counters {
    /// STATE messages sent: runs of the 10 Hz loop.
    pub states_sent: u32,
    /// COMMAND messages sent, repeats included.
    pub commands_sent: u32,
    /// Corrections put into the filter's queue.
    pub corrections_applied: u32,
    /// Corrections whose index was that of the one before.
    pub corrections_ignored: u32,
    /// Bytes that the full UART buffer lost.
    pub overflowed_bytes: u64,
    /// Messages beyond the nine that a cycle can use.
    pub unused_messages: u32,
    /// What the parser has seen.
    pub link: link::Counters,
}

/// What a message means for the rest of the app.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum News {
    /// The camera has turned to the snapshot with this number.
    ActiveSnapshot(u16),
    /// The estimate is to be corrected: what to put into the filter's queue.
    Realigned([Measurement; 2]),
}

/// Both directions of the link, and the state that its messages have.
#[derive(Debug)]
pub struct Camera {
    uart: Uart,
    handshake: Handshake,
    goal: Goal,
    corrections: Corrections,
    /// Read in this window, not yet handled.
    heard: Vec<Message>,
    received: Vec<Received>,
    states_sent: u32,
    commands_sent: u32,
}

impl Camera {
    /// A camera that has not been heard of.
    pub fn new(correction_sd: CorrectionSd) -> Self {
        Self {
            uart: Uart::new(),
            handshake: Handshake::default(),
            goal: Goal::default(),
            corrections: Corrections::new(correction_sd),
            heard: Vec::new(),
            received: Vec::new(),
            states_sent: 0,
            commands_sent: 0,
        }
    }

    /// Bytes arrive, whether the app reads or not.
    pub fn arrive(&mut self, bytes: &[u8]) {
        self.uart.arrive(bytes);
    }

    /// Wants `mode`; whether the camera was in it at the last cycle.
    pub fn command(&mut self, mode: Mode, args: &[u8]) -> bool {
        self.handshake.want(mode, args);
        self.handshake.synced()
    }

    /// Wants `mode`, a following one; a new target to fly to, once both sides agree on the mode.
    ///
    /// A vector that arrives in one cycle is flown from the next one on.
    pub fn follow(&mut self, mode: Mode) -> Option<WorldPoint> {
        self.handshake.want(mode, &[]);
        if self.handshake.settled() {
            self.goal.issue()
        } else {
            None
        }
    }

    /// The bytes a cycle sends: STATE, and COMMAND as long as its echo is missing. Begins to read.
    pub fn report(&mut self, pose: WorldPose) -> Vec<u8> {
        let mut bytes = Message::State(State::from_world(pose)).encode().to_vec();
        self.states_sent += 1;
        if let Some(command) = self.handshake.cycle() {
            bytes.extend(Message::Command(command).encode());
            self.commands_sent += 1;
        }
        self.uart.open_window();
        bytes
    }

    /// Whether the app is reading.
    pub fn listening(&self) -> bool {
        self.uart.window_is_open()
    }

    /// Stops reading.
    pub fn stop_listening(&mut self) {
        self.heard.clear();
        self.uart.close_window();
    }

    /// One receive call; does nothing unless the app is reading.
    pub fn listen(&mut self) {
        self.heard.extend(self.uart.receive());
    }

    /// Does what the messages of this window ask for, in order; what they mean for the rest.
    ///
    /// The real app handles each message within the 10 ms in which it reads. Here all are handled at
    /// the end, so that a flight does not depend on the microseconds of the camera's answer.
    ///
    /// # Errors
    /// [`Implausible`] if a target or a correction cannot be believed.
    pub fn act(&mut self, now_ms: u64, estimate_m: Vector3<f32>) -> Result<Vec<News>, Implausible> {
        let mut news = Vec::new();
        for message in std::mem::take(&mut self.heard) {
            let handled = self.handle(&message, estimate_m);
            self.received.push(Received {
                at_ms: now_ms,
                message,
            });
            news.extend(handled?);
        }
        Ok(news)
    }

    /// The messages handled since the last call, in order.
    pub fn take_received(&mut self) -> Vec<Received> {
        std::mem::take(&mut self.received)
    }

    /// How often each thing happened.
    pub fn counters(&self) -> Counters {
        Counters {
            states_sent: self.states_sent,
            commands_sent: self.commands_sent,
            corrections_applied: self.corrections.applied(),
            corrections_ignored: self.corrections.ignored(),
            overflowed_bytes: self.uart.overflowed_bytes(),
            unused_messages: self.uart.unused_messages(),
            link: self.uart.counters(),
        }
    }

    fn handle(
        &mut self,
        message: &Message,
        estimate_m: Vector3<f32>,
    ) -> Result<Option<News>, Implausible> {
        match message {
            Message::Command(command) => self.handshake.receive(command.command),
            Message::Vector(vector) => self.goal.receive(vector.target()?),
            Message::Map(map) => return Ok(Some(News::ActiveSnapshot(map.snapshot_index))),
            Message::InsCorrection(correction) => {
                let measurements = self.corrections.apply(correction, estimate_m)?;
                return Ok(measurements.map(News::Realigned));
            }
            // Only logged, or the app's own.
            Message::Camera(_) | Message::State(_) | Message::Debug(_) => {}
        }
        Ok(None)
    }
}
