//! One emulated board on a bench, with every frame that it looks at held against the camera's.

use emulator::machine::{Fault, Machine};
use emulator::time::Nanos;
use fake_sensors::camera::tcm8230::Tcm8230;
use fake_sensors::camera::{FRAME_BYTES, PanoramicCamera, PanoramicLens};
use fake_sensors::world::{UnknownWorld, World};
use pilot::{Parameters, Pilot};

use crate::board::camera::Camera;
use crate::board::emulated::Firmware;
use crate::board::probe::Probe;
use crate::board::sabotage::Sabotaged;
use crate::board::{BoardError, FirmwareLog};
use crate::flight::aircraft;

/// The world the board stands in, and what its noise is drawn from.
const WORLD: &str = "arena-panels";
const SEED: u64 = 1;

/// The firmware's two frame buffers, one behind the other.
const BUFFERS: &str = "firmware::capture::buffers::MEMORY";

/// The firmware's log is read so often; its buffer is small.
const STEP: Nanos = Nanos::from_millis(1);

/// The longest wait for an edge of the camera's.
const EDGE_TIMEOUT: Nanos = Nanos::from_millis(1_000);

/// From the fall of VSYNC to the middle of the blanking.
const INTO_BLANKING: Nanos = Nanos(500_000);

/// The bench cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    /// The board.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// There is no world to stand in.
    #[error(transparent)]
    World(#[from] UnknownWorld),
    /// The camera sends no more.
    #[error("the camera did not {what} within {} s", EDGE_TIMEOUT.as_secs_f64())]
    Silent {
        /// What was waited for.
        what: &'static str,
    },
}

impl From<Fault> for BenchError {
    fn from(fault: Fault) -> Self {
        Self::Board(fault.into())
    }
}

/// A board on the ground, without an autopilot.
pub struct Bench<'f> {
    machine: Machine<Sabotaged>,
    probe: Probe<'f>,
    /// Looks at the camera's frames as the firmware looks at its own.
    reference: Pilot,
    buffers: u32,
    log: Vec<FirmwareLog>,
    good: Vec<Nanos>,
    faults: Vec<(Nanos, String)>,
    wrong: u64,
}

impl<'f> Bench<'f> {
    /// Switches a board on and waits until its camera sends. `crystal_hz`: the camera does not run on
    /// the board's clock.
    pub fn boot(firmware: &'f Firmware, crystal_hz: Option<u32>) -> Result<Self, BenchError> {
        let world = World::named(WORLD, SEED)?;
        let optics = PanoramicCamera::new(world, &PanoramicLens::default(), SEED);
        let camera = Camera::new(Tcm8230::default(), optics, aircraft::pose_on_the_ground());
        let mut bench = Self {
            machine: firmware.machine(Sabotaged::new(camera, crystal_hz))?,
            probe: firmware.probe()?,
            reference: Pilot::new(&Parameters::DEFAULT).map_err(BoardError::Calibration)?,
            buffers: firmware.address(BUFFERS)?,
            log: Vec::new(),
            good: Vec::new(),
            faults: Vec::new(),
            wrong: 0,
        };
        bench.run_while("send a frame", |camera| camera.frames_ended() == 0)?;
        Ok(bench)
    }

    /// Virtual time since power-on.
    pub fn now(&self) -> Nanos {
        self.machine.now()
    }

    /// The camera and its wires.
    pub fn camera(&self) -> &Sabotaged {
        self.machine.wiring()
    }

    /// Does something to the camera's wires, now.
    pub fn tamper(&mut self, deed: impl FnOnce(&mut Sabotaged, Nanos)) {
        let now = self.now();
        deed(self.machine.wiring_mut(), now);
    }

    /// Does something to the chip, now.
    pub fn meddle(&mut self, deed: impl FnOnce(&mut Machine<Sabotaged>)) {
        deed(&mut self.machine);
    }

    /// When the frames ended that the firmware looked at and that were what the camera had sent.
    pub fn good_frames(&self) -> &[Nanos] {
        &self.good
    }

    /// Frames that the firmware looked at and that were not.
    pub fn wrong_frames(&self) -> u64 {
        self.wrong
    }

    /// The names of the faults that the firmware has told of since `from`.
    pub fn faults_since(&self, from: Nanos) -> impl Iterator<Item = &str> {
        let since = self.faults.iter().filter(move |(at, _)| *at >= from);
        since.map(|(_, name)| name.as_str())
    }

    /// Runs until `until`.
    pub fn run_until(&mut self, until: Nanos) -> Result<(), BenchError> {
        while self.now() < until {
            self.step(until, |_| true)?;
        }
        Ok(())
    }

    /// Runs until the camera has ended so many more frames.
    pub fn run_frames(&mut self, frames: u64) -> Result<(), BenchError> {
        for _ in 0..frames {
            self.run_into_blanking()?;
        }
        Ok(())
    }

    /// Runs into the middle of the next vertical blanking, at the camera.
    pub fn run_into_blanking(&mut self) -> Result<(), BenchError> {
        let ended = self.camera().frames_ended();
        self.run_while("end its frame", |camera| camera.frames_ended() == ended)?;
        self.run_until(self.now() + INTO_BLANKING)
    }

    /// Runs until `after` the start of the camera's next frame.
    pub fn run_into_frame(&mut self, after: Nanos) -> Result<(), BenchError> {
        let started = self.camera().camera().frames_started();
        self.run_while("begin a frame", |camera| {
            camera.camera().frames_started() == started
        })?;
        self.run_until(self.now() + after)
    }

    /// Runs until the firmware has looked at a good frame that ended after `after`, but not beyond
    /// `until`. When that frame ended.
    pub fn run_to_good_frame(
        &mut self,
        after: Nanos,
        until: Nanos,
    ) -> Result<Option<Nanos>, BenchError> {
        loop {
            let good = self.good.iter().find(|good| **good > after).copied();
            if good.is_some() || self.now() >= until {
                return Ok(good);
            }
            self.step(until, |_| true)?;
        }
    }

    fn run_while(
        &mut self,
        what: &'static str,
        condition: impl Fn(&Sabotaged) -> bool,
    ) -> Result<(), BenchError> {
        let until = self.now() + EDGE_TIMEOUT;
        while self.now() < until {
            if !self.step(until, &condition)? {
                return Ok(());
            }
        }
        Err(BenchError::Silent { what })
    }

    /// A step of the log's, but not beyond `until`, nor for longer than the condition holds. True: it
    /// still does.
    fn step(
        &mut self,
        until: Nanos,
        condition: impl Fn(&Sabotaged) -> bool,
    ) -> Result<bool, BenchError> {
        let end = (self.now() + STEP).min(until);
        let holds = self.machine.run_while(end, condition)?;
        self.probe.read(&mut self.machine, &mut self.log)?;
        let now = self.now();
        for record in std::mem::take(&mut self.log) {
            match record {
                FirmwareLog::Frame(frame) => self.judge(frame.luma),
                FirmwareLog::CaptureFault { name, .. } => self.faults.push((now, name)),
                FirmwareLog::LinkDrop { .. } | FirmwareLog::Line { .. } => {}
            }
        }
        Ok(holds)
    }

    /// The firmware has looked at a frame: is it the one that the camera sent last?
    fn judge(&mut self, luma: f32) {
        let sent = self.machine.wiring().last_sent();
        let genuine = sent.filter(|sent| {
            let expected = self.reference.on_frame(&sent.picture).mean_luma;
            let buffers = self.machine.memory().bytes(self.buffers, 2 * FRAME_BYTES);
            let in_memory = buffers.is_some_and(|buffers| {
                buffers
                    .chunks_exact(FRAME_BYTES)
                    .any(|buffer| buffer == sent.picture.as_slice())
            });
            sent.intact && in_memory && luma.to_bits() == expected.to_bits()
        });
        match genuine.map(|sent| sent.ended) {
            Some(ended) if self.good.last() != Some(&ended) => self.good.push(ended),
            _ => self.wrong += 1,
        }
    }
}
