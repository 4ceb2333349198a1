//! The app on a bench: a camera of a few lines, and a drone that is where it should be.

mod accounts;
mod exchange;
mod flights;
mod operator;
mod quirks;

use link::{Command, Message, Mode, Parser, Vector};
use nalgebra::{SVector, UnitQuaternion, Vector3};

use super::{FlightApp, Outcome, Output, Phase, Script, Settings, Step, Until};
use crate::controller::SetPoint;
use crate::ekf::Estimate;

const FOLLOW: u8 = 0x12;
/// First run of the loop: 1 s on the ground, 1 s reset, 1 s climb, 1 s hover, and the next period.
const FIRST_CYCLE_MS: u64 = 4_100;

fn estimate(position_m: Vector3<f32>) -> Estimate {
    Estimate {
        position_m,
        velocity_m_s: Vector3::zeros(),
        velocity_body_m_s: Vector3::zeros(),
        attitude: UnitQuaternion::identity(),
        variances: SVector::zeros(),
    }
}

fn command(byte: u8) -> Message {
    Message::Command(Command {
        command: byte,
        ..Command::default()
    })
}

fn vector(north: f32, east: f32) -> Message {
    Message::Vector(Vector {
        target_n: north,
        target_e: east,
        ..Vector::default()
    })
}

/// The app, the drone that follows it without delay, and the wire in between.
struct Bench {
    app: FlightApp,
    parser: Parser,
    now_ms: u64,
    position_m: Vector3<f32>,
    /// Arrives at the app in the next millisecond.
    inbound: Vec<u8>,
    /// What the app sent in the last millisecond.
    sent: Vec<Message>,
}

impl Bench {
    fn new(script: Script, settings: Settings) -> Self {
        Self {
            app: FlightApp::new(script, settings),
            parser: Parser::new(),
            now_ms: 0,
            position_m: Vector3::zeros(),
            inbound: Vec::new(),
            sent: Vec::new(),
        }
    }

    /// A bench on which the app follows as soon as it flies.
    fn following() -> Self {
        let follow = Step::Follow {
            mode: Mode::Follow,
            until: Until::Home,
        };
        let script = Script {
            steps: vec![follow],
        };
        Self::new(script, Settings::default())
    }

    fn send(&mut self, message: &Message) {
        self.inbound.extend(message.encode());
    }

    fn tick(&mut self) -> Output {
        let inbound = std::mem::take(&mut self.inbound);
        let output = self
            .app
            .tick(self.now_ms, &estimate(self.position_m), &inbound);
        let frames = self.parser.frames(&output.transmit);
        self.sent = frames.map(|frame| frame.message).collect();
        if let SetPoint::Hold { position_m, .. } = output.set_point {
            self.position_m = position_m;
        }
        self.now_ms += 1;
        output
    }

    /// Ticks up to and including `until_ms`; the last output.
    fn run(&mut self, until_ms: u64) -> Output {
        loop {
            let output = self.tick();
            if self.now_ms > until_ms {
                return output;
            }
        }
    }

    fn command_bytes_sent(&self) -> Vec<u8> {
        let commands = self.sent.iter().filter_map(|message| match message {
            Message::Command(command) => Some(command.command),
            _ => None,
        });
        commands.collect()
    }

    /// Flies to the end against a camera that answers every message; `limit_ms` is the patience.
    fn fly(&mut self, limit_ms: u64, mut answer: impl FnMut(&Message) -> Vec<Message>) -> Outcome {
        while self.now_ms < limit_ms {
            self.tick();
            for message in std::mem::take(&mut self.sent) {
                for reply in answer(&message) {
                    self.send(&reply);
                }
            }
            if let Phase::Landed(outcome) = self.app.phase() {
                return outcome;
            }
        }
        panic!("still {:?} after {limit_ms} ms", self.app.phase());
    }
}
