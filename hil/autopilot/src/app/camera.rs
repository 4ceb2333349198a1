//! The camera as the app sees it: what is sent to it, and what its messages do.

use link::{Implausible, Message, Mode, State, Vector, WorldPoint, WorldPose};
use nalgebra::Vector3;

use super::correction::Corrections;
use super::goal::Goal;
use super::handshake::Handshake;
use super::reception::{Delivery, Dropped, ReceiveLoop};
use super::settings::Settings;
use super::value_check::ValueCheck;
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
    /// Times that a message was handled that had not just come.
    pub repeats: u32,
    /// What the receiver has seen.
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
    receive_loop: ReceiveLoop,
    keeps_ground_bytes: bool,
    handshake: Handshake,
    goal: Goal,
    /// The vector received last.
    vector: Option<Vector>,
    corrections: Corrections,
    check: ValueCheck,
    received: Vec<Received>,
    states_sent: u32,
    commands_sent: u32,
    corrections_ignored: u32,
}

impl Camera {
    /// A camera that has not been heard of.
    pub fn new(settings: &Settings) -> Self {
        Self {
            receive_loop: ReceiveLoop::new(settings.quirks),
            keeps_ground_bytes: settings.quirks.keeps_ground_bytes,
            handshake: Handshake::default(),
            goal: Goal::default(),
            vector: None,
            corrections: Corrections::new(settings),
            check: settings.quirks.value_check(),
            received: Vec::new(),
            states_sent: 0,
            commands_sent: 0,
            corrections_ignored: 0,
        }
    }

    /// Bytes arrive, whether the app reads or not.
    pub fn arrive(&mut self, now_ms: u64, bytes: &[u8]) {
        self.receive_loop.uart().arrive(now_ms, bytes);
    }

    /// The drone has taken off: from now on there are cycles.
    pub fn begin(&mut self, now_ms: u64) {
        if !self.keeps_ground_bytes {
            self.receive_loop.uart().clear(now_ms);
        }
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

    /// The measurements that realign the filter with a drone that has homed to `place`; `None` where
    /// no vector has come.
    ///
    /// # Errors
    /// [`Implausible`] if the last vector asks for a turn that is no angle.
    pub fn realignment(
        &self,
        place: WorldPoint,
        height_m: f32,
    ) -> Result<Option<[Measurement; 2]>, Implausible> {
        let Some(vector) = &self.vector else {
            return Ok(None);
        };
        let turn_rad = self.check.turn(vector)?;
        let measurements = self.corrections.realignment(place, height_m, turn_rad);
        Ok(Some(measurements))
    }

    /// The bytes a cycle sends: STATE, and COMMAND as long as its echo is missing. Begins to read.
    pub fn report(&mut self, now_ms: u64, pose: WorldPose) -> Vec<u8> {
        let mut bytes = Message::State(State::from_world(pose)).encode().to_vec();
        self.states_sent += 1;
        let command = self.handshake.cycle();
        self.receive_loop.begin(now_ms, command.as_ref());
        if let Some(command) = command {
            bytes.extend(Message::Command(command).encode());
            self.commands_sent += 1;
        }
        bytes
    }

    /// Whether the app is reading.
    pub fn listening(&self) -> bool {
        self.receive_loop.is_running()
    }

    /// Stops reading.
    pub fn stop_listening(&mut self, now_ms: u64) {
        self.receive_loop.abort(now_ms);
    }

    /// One receive call; does nothing unless the app is reading.
    pub fn listen(&mut self, now_ms: u64) {
        self.receive_loop.call(now_ms);
    }

    /// Nobody is going to read what arrives.
    pub fn abandon(&mut self, now_ms: u64) {
        self.receive_loop.uart().abandon(now_ms);
    }

    /// Does what the messages of this window ask for, in order; what they mean for the rest.
    ///
    /// The real app handles each message within the 10 ms in which it reads. Here all are handled at
    /// the end, so that a flight does not depend on the microseconds of the camera's answer.
    ///
    /// # Errors
    /// [`Implausible`] if a target or a correction cannot be.
    pub fn act(&mut self, now_ms: u64, estimate_m: Vector3<f32>) -> Result<Vec<News>, Implausible> {
        let mut news = Vec::new();
        for delivery in self.receive_loop.take() {
            match delivery {
                Delivery::New(heard) => {
                    let handled = self.handle(&heard.message, estimate_m);
                    let is_correction = matches!(heard.message, Message::InsCorrection(_));
                    self.corrections_ignored += u32::from(is_correction && handled == Ok(None));
                    self.received.push(Received {
                        at_ms: now_ms,
                        message: heard.message,
                    });
                    news.extend(handled?);
                }
                // What stands between a repeated correction and the filter is its index alone. An
                // operator, though, is not told twice where the camera is.
                Delivery::Stale(message) => {
                    let handled = self.handle(&message, estimate_m)?;
                    news.extend(handled.filter(|news| matches!(news, News::Realigned(_))));
                }
            }
        }
        Ok(news)
    }

    /// The frames dropped since the last call, in the order in which that became certain.
    pub fn take_dropped(&mut self) -> Vec<Dropped> {
        self.receive_loop.take_dropped()
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
            corrections_ignored: self.corrections_ignored,
            overflowed_bytes: self.receive_loop.counted().overflowed_bytes(),
            unused_messages: self.receive_loop.unused_messages(),
            repeats: self.receive_loop.repeats(),
            link: self.receive_loop.counted().counters(),
        }
    }

    fn handle(
        &mut self,
        message: &Message,
        estimate_m: Vector3<f32>,
    ) -> Result<Option<News>, Implausible> {
        match message {
            Message::Command(command) => self.handshake.receive(command.command),
            Message::Vector(vector) => {
                self.goal.receive(self.check.target(vector)?);
                self.vector = Some(vector.clone());
            }
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
