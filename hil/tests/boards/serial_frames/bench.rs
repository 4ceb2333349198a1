//! An emulated board on a bench: no camera, a host on its second UART, an autopilot on its first.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::OnceLock;

use emulator::machine::Machine;
use emulator::time::Nanos;
use emulator::wiring::{Pin, Wiring};
use fake_sensors::camera::{Exposure, Moment, PanoramicCamera, PanoramicLens, Pose};
use fake_sensors::world::World;
use frames::{Reply, Request};
use hil::board::emulated::Firmware;
use hil::board::probe::Probe;
use hil::board::serial_frames::SerialFrames;
use hil::board::{FirmwareLog, FrameLog};
use hil::image::{self, Variant};
use nalgebra::{UnitQuaternion, Vector3};

/// The UART that the autopilot is on.
const LINK_USART: u8 = 2;

/// From power-on to a firmware that listens.
const BOOT_MS: u32 = 20;

/// Longer than a frame, its processing and the answer take at 3 Mbaud.
pub const FRAME_MS: u32 = 90;

/// The pins, watched.
#[derive(Debug, Default)]
pub struct Pins {
    /// Frequencies of clock outputs, hertz.
    pub clocks: HashMap<Pin, Option<f64>>,
    /// Levels of outputs.
    pub levels: HashMap<Pin, bool>,
}

impl Wiring for Pins {
    fn pin_changed(&mut self, _now: Nanos, pin: Pin, high: bool) {
        self.levels.insert(pin, high);
    }

    fn clock_changed(&mut self, _now: Nanos, pin: Pin, hertz: Option<f64>) {
        self.clocks.insert(pin, hertz);
    }
}

/// The file of an image, built first, and once.
pub fn elf(variant: Variant) -> &'static [u8] {
    static FILES: [[OnceLock<Vec<u8>>; 2]; 2] = [const { [const { OnceLock::new() }; 2] }; 2];
    FILES[variant.kind as usize][variant.board as usize].get_or_init(|| {
        let path: PathBuf = image::build_variant(&variant, &|line| eprintln!("{line}"))
            .unwrap_or_else(|error| panic!("{variant}: {error}"));
        std::fs::read(path).expect("the image is there")
    })
}

/// An image to be run.
pub fn firmware(variant: Variant) -> Firmware {
    Firmware::parse(elf(variant)).expect("an image")
}

/// The board with what it said.
pub struct Bench<'f> {
    pub machine: Machine<Pins>,
    probe: Probe<'f>,
    pub host: SerialFrames,
    pub replies: Vec<Reply>,
    log: Vec<FirmwareLog>,
    /// Bytes to the autopilot.
    pub link: Vec<u8>,
}

impl<'f> Bench<'f> {
    /// Switches the board on.
    pub fn boot(firmware: &'f Firmware) -> Self {
        let machine = firmware.machine(Pins::default()).expect("a board");
        let mut bench = Self {
            machine,
            probe: firmware.probe().expect("a log"),
            host: SerialFrames::new(),
            replies: Vec::new(),
            log: Vec::new(),
            link: Vec::new(),
        };
        bench.run_ms(BOOT_MS);
        bench
    }

    /// The same, and a session begins.
    pub fn begin(firmware: &'f Firmware, fresh_ms: u16) -> Self {
        let mut bench = Self::boot(firmware);
        bench.ask(Request::Begin { fresh_ms });
        bench
    }

    pub fn run_ms(&mut self, ms: u32) {
        for _ in 0..ms {
            let next = self.machine.now() + Nanos::from_millis(1);
            self.machine.run_until(next).expect("an image that goes on");
            let read = self.probe.read(&mut self.machine, &mut self.log);
            read.expect("a log");
            self.replies.extend(self.host.replies(&mut self.machine));
            let sent = self.machine.usart_received(LINK_USART);
            self.link.extend(sent.into_iter().map(|(_, byte)| byte));
        }
    }

    /// Asks, and gives the board time to answer.
    pub fn ask(&mut self, request: Request) {
        self.host.ask(&mut self.machine, request);
        self.run_ms(3);
    }

    /// Sends a frame, and gives the board time to look at it.
    pub fn show(&mut self, number: u32, frame: &pilot::Frame) {
        self.host.send_frame(&mut self.machine, number, frame);
        self.run_ms(FRAME_MS);
    }

    /// Sends what the autopilot says.
    pub fn say(&mut self, message: &link::Message) {
        let now = self.machine.now();
        self.machine.usart_send(LINK_USART, now, &message.encode());
        self.run_ms(5);
    }

    /// What the firmware said of the frames that it looked at.
    pub fn frames(&self) -> Vec<FrameLog> {
        let frames = self.log.iter().filter_map(|record| match record {
            FirmwareLog::Frame(frame) => Some(*frame),
            _ => None,
        });
        frames.collect()
    }

    /// What it said besides.
    pub fn lines(&self) -> Vec<&str> {
        let lines = self.log.iter().filter_map(|record| match record {
            FirmwareLog::Line { text, .. } => Some(text.as_str()),
            _ => None,
        });
        lines.collect()
    }
}

/// What a camera sees from a place in the arena, metres north of its middle.
pub fn seen_from(north_m: f32, lines: u16, number: u32) -> Box<pilot::Frame> {
    let world = World::named("arena", 1).expect("a world");
    let mut camera = PanoramicCamera::new(world, &PanoramicLens::default(), 1);
    let moment = Moment {
        pose: Pose {
            position_m: Vector3::new(north_m, 0.0, 1.0),
            attitude: UnitQuaternion::identity(),
        },
        time_s: 0.0,
    };
    let exposure = Exposure { lines, gain: 1.0 };
    Box::new(*camera.expose(&moment, exposure, number))
}
