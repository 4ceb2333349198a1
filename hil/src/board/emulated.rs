//! The emulated board: the image that would be flashed, on an STM32F407 in software.

use emulator::core::Cycle;
use emulator::image::{Image, ImageError};
use emulator::machine::Machine;
use emulator::memory::Memory;
use emulator::soc::ResetCause;
use emulator::time::Nanos;
use emulator::wiring::Wiring;
use fake_sensors::camera::Pose;
use sensor::tcm8230::SETTLING_FRAMES;

use super::camera::Camera;
use super::firmware_log::{LogDecoder, LogTable};
use super::observer::{Interest, Observer};
use super::probe::Probe;
use super::rtt::UpChannel;
use super::sabotage::Sabotaged;
use super::timing::TimingModel;
use super::{Board, BoardError, BoardFigures, CAMERA_LEAD_NS, FirmwareLog};
use crate::scenario::{CameraTrouble, LensPage};

/// The crystal on the flight board, hertz.
const CRYSTAL_HZ: u32 = 8_000_000;
/// The UART that the autopilot is on.
pub const LINK_USART: u8 = 2;
/// From power-on to the first camera frame; a healthy board needs some 50 ms.
const FIRST_FRAME_TIMEOUT: Nanos = Nanos::from_millis(1_000);
/// From the end of a frame to the end of its processing, at most, milliseconds.
const FRAME_GRACE_MS: u32 = 10;
const MILLISECOND: Nanos = Nanos::from_millis(1);

/// The function whose cycles are a frame's cycles.
const VISION_FUNCTION: &str = "vision_frame";

/// The symbol of the lens record's page.
const LENS_PAGE: &str = "_lens_page";

/// What is in the chip's flash, an image and perhaps a lens record, the image's log table, and what is
/// assumed of the chip's time; boards borrow it.
#[derive(Debug)]
pub struct Firmware {
    image: Image,
    table: LogTable,
    lens: Option<LensPage>,
    timing: TimingModel,
}

impl Firmware {
    /// Reads an ELF file.
    pub fn parse(elf: &[u8]) -> Result<Self, BoardError> {
        Ok(Self {
            image: Image::parse(elf)?,
            table: LogTable::parse(elf)?,
            lens: None,
            timing: TimingModel::default(),
        })
    }

    /// The same with a lens record; none leaves its page erased.
    #[must_use]
    pub fn with_lens(self, lens: Option<LensPage>) -> Self {
        Self { lens, ..self }
    }

    /// The same on a chip of which other times are assumed.
    #[must_use]
    pub fn with_timing(self, timing: TimingModel) -> Self {
        Self { timing, ..self }
    }

    /// Where the image looks for the lens record.
    pub fn lens_page_address(&self) -> Result<u32, BoardError> {
        self.address(LENS_PAGE)
    }

    /// Where a function or a static of the image is.
    pub fn address(&self, symbol: &'static str) -> Result<u32, BoardError> {
        let found = self.image.symbol(symbol);
        Ok(found.ok_or(BoardError::NoSymbol(symbol))?.address)
    }

    /// The image.
    pub fn image(&self) -> &Image {
        &self.image
    }

    /// A probe for the image's log.
    pub fn probe(&self) -> Result<Probe<'_>, BoardError> {
        Probe::new(&self.image, &self.table)
    }

    /// A decoder for what the image logs.
    pub(crate) fn log_decoder(&self) -> LogDecoder<'_> {
        LogDecoder::new(&self.table)
    }

    /// Where the image's log is in the chip's memory.
    pub(crate) fn log_channel(&self) -> Result<UpChannel, BoardError> {
        UpChannel::of(&self.image).ok_or(BoardError::NoSymbol(UpChannel::SYMBOL))
    }

    /// A chip with all of it, on a board with this wiring, switched on.
    pub fn machine<W: Wiring>(&self, wiring: W) -> Result<Machine<W>, BoardError> {
        let mut machine = Machine::new(&self.image, CRYSTAL_HZ, wiring)?;
        machine.set_cycle_model(self.timing.core);
        machine.assume_flash(self.timing.flash);
        if let Some(lens) = &self.lens {
            let (address, bytes) = (self.lens_page_address()?, lens.bytes());
            let placed = machine.memory_mut().place(address, bytes);
            placed.ok_or(ImageError::OutsideMemory {
                address,
                len: bytes.len(),
            })?;
        }
        Ok(machine)
    }

    /// Bytes of flash.
    pub fn flash_bytes(&self) -> u32 {
        self.image.flash_bytes()
    }

    /// Bytes of static RAM.
    pub fn static_ram_bytes(&self) -> u32 {
        self.image.static_ram_bytes()
    }
}

/// An STM32F407 with a camera, in flight.
pub struct Emulated<'f> {
    machine: Machine<Sabotaged>,
    /// What is to happen to the camera's wires.
    trouble: Option<CameraTrouble>,
    observer: Option<(&'f mut dyn Observer, Interest)>,
    probe: Probe<'f>,
    log: Vec<FirmwareLog>,
    traced_cycles: Vec<u32>,
    /// Frames in the log so far.
    frames_logged: usize,
    vision: u32,
    /// How far the flight has come on the board's clock.
    clock: Nanos,
    /// Milliseconds of flight.
    elapsed_ms: u64,
    /// Cycles asleep and in all when the flight began: the boot is not part of its load.
    epoch: (u64, u64),
}

impl<'f> Emulated<'f> {
    /// Switches a board on and waits until its camera sends; then the flight's time is zero, and
    /// stands where the native board's does: [`CAMERA_LEAD_NS`] after the start of the first frame.
    pub fn boot(firmware: &'f Firmware, camera: Camera) -> Result<Self, BoardError> {
        let camera = Sabotaged::new(camera, None);
        let vision = firmware.address(VISION_FUNCTION)?;
        let mut machine = firmware.machine(camera)?;
        machine.trace_calls(vision);
        let mut board = Self {
            probe: firmware.probe()?,
            trouble: None,
            observer: None,
            log: Vec::new(),
            traced_cycles: Vec::new(),
            frames_logged: 0,
            vision,
            clock: Nanos(0),
            elapsed_ms: 0,
            epoch: (0, 0),
            machine,
        };
        if board.machine.run_while(FIRST_FRAME_TIMEOUT, |wires| {
            wires.camera().frames_started() == 0
        })? {
            return Err(board.no_frame());
        }
        board.clock = board.machine.now() + Nanos(CAMERA_LEAD_NS);
        board.machine.run_until(board.clock)?;
        board.epoch = (board.machine.idle_cycles(), board.machine.cycles());
        Ok(board)
    }

    /// Lets something happen to the camera's wires in the course of the flight.
    #[must_use]
    pub fn with_trouble(self, trouble: Option<CameraTrouble>) -> Self {
        Self { trouble, ..self }
    }

    /// What the chip's memories hold now.
    pub fn memory(&self) -> &Memory {
        self.machine.memory()
    }

    /// The image that it runs.
    pub fn image(&self) -> &Image {
        self.machine.image()
    }

    /// The core's cycles since power-on.
    pub fn cycles(&self) -> Cycle {
        self.machine.cycles()
    }

    /// The core's clock, hertz.
    pub fn core_hz(&self) -> u32 {
        self.machine.hclk_hz()
    }

    /// Lets somebody watch from now on.
    pub fn watched_by(mut self, observer: &'f mut dyn Observer) -> Result<Self, BoardError> {
        let interest = observer.begin(&self)?;
        if let Interest::Events(functions) = &interest {
            for function in functions {
                self.machine.trace_calls(*function);
            }
            self.machine.start_trace();
        }
        self.observer = Some((observer, interest));
        Ok(self)
    }

    /// Runs the machine, and lets the observer see it.
    fn run(&mut self, until: Nanos) -> Result<(), BoardError> {
        match &mut self.observer {
            Some((observer, Interest::Steps)) => {
                let see = |step| observer.step(step);
                self.machine.run_stepwise(until, see)?;
            }
            Some((observer, Interest::Events(_))) => {
                self.machine.run_until(until)?;
                observer.events(&self.machine.take_trace());
            }
            None => self.machine.run_until(until)?,
        }
        Ok(())
    }

    /// Begins and ends what is to happen in the millisecond that begins now.
    fn disturb(&mut self) {
        if let Some(trouble) = self.trouble {
            let (now, elapsed_ms) = (self.clock, self.elapsed_ms);
            let wires = self.machine.wiring_mut();
            if elapsed_ms == trouble.from_ms {
                wires.begin(now, trouble.fault.into());
            }
            if elapsed_ms == trouble.until_ms() {
                wires.end(now);
            }
        }
        self.elapsed_ms += 1;
    }

    /// Advances by one millisecond, in which `run` brings the machine to the instant that it is given.
    ///
    /// # Errors
    /// As of [`Board::advance`], and those of `run`.
    pub fn advance_by(
        &mut self,
        run: impl FnOnce(&mut Self, Nanos) -> Result<(), BoardError>,
    ) -> Result<(), BoardError> {
        self.disturb();
        self.clock = self.clock + MILLISECOND;
        run(self, self.clock)?;
        self.collect_calls();
        self.read_log()?;
        // The firmware may stand between looking at a frame and logging it.
        self.check_log(1)
    }

    /// The chip and what is around it.
    pub fn machine(&mut self) -> &mut Machine<Sabotaged> {
        &mut self.machine
    }

    /// Pulls the reset pin for a moment. Virtual time, the camera and the link go on.
    pub fn reset(&mut self) {
        self.machine.reset(ResetCause::Pin);
        self.probe.restart();
        self.collect_calls();
        // What was about to be logged never will be.
        self.frames_logged = self.traced_cycles.len();
    }

    fn no_frame(&mut self) -> BoardError {
        let mut lines = String::new();
        match self.read_log() {
            Ok(()) => {
                for record in &self.log {
                    if let FirmwareLog::Line { level, text, .. } = record {
                        lines += &format!("  {level} {text}\n");
                    }
                }
            }
            Err(error) => lines = error.to_string(),
        }
        BoardError::NoFrame {
            seconds: FIRST_FRAME_TIMEOUT.as_secs_f64(),
            log: lines,
        }
    }

    fn read_log(&mut self) -> Result<(), BoardError> {
        let known = self.log.len();
        self.probe.read(&mut self.machine, &mut self.log)?;
        let is_frame = |record: &&FirmwareLog| matches!(record, FirmwareLog::Frame(_));
        self.frames_logged += self.log[known..].iter().filter(is_frame).count();
        Ok(())
    }

    /// Nothing else tells of a log that overflowed: a record is written over, and a frame's cycles
    /// would be held against those of the next. `on_their_way` records may not be there yet.
    fn check_log(&self, on_their_way: usize) -> Result<(), BoardError> {
        let (processed, logged) = (self.traced_cycles.len(), self.frames_logged);
        if (logged..=logged + on_their_way).contains(&processed) {
            Ok(())
        } else {
            Err(BoardError::LogLost { processed, logged })
        }
    }

    fn collect_calls(&mut self) {
        let vision = self.vision;
        let calls = self
            .machine
            .take_calls()
            .into_iter()
            .filter(|call| call.address == vision);
        self.traced_cycles
            .extend(calls.map(|call| (call.returned - call.entered) as u32));
    }
}

impl Board for Emulated<'_> {
    fn name(&self) -> &'static str {
        "emulator"
    }

    fn look_from(&mut self, pose: Pose) {
        let now_ns = self.clock.0;
        let camera = self.machine.wiring_mut().camera_mut();
        camera.look_from(now_ns, pose);
    }

    fn transmit(&mut self, bytes: &[u8]) {
        self.machine.usart_send(LINK_USART, self.clock, bytes);
    }

    fn advance(&mut self) -> Result<(), BoardError> {
        self.advance_by(Self::run)
    }

    fn receive(&mut self, into: &mut Vec<u8>) {
        into.extend(
            self.machine
                .usart_received(LINK_USART)
                .into_iter()
                .map(|(_, byte)| byte),
        );
    }

    fn drain_log(&mut self, into: &mut Vec<FirmwareLog>) {
        into.append(&mut self.log);
    }

    fn finish(&mut self) -> Result<BoardFigures, BoardError> {
        // A frame may have been captured this very moment: it is processed before the next ends.
        for _ in 0..FRAME_GRACE_MS {
            if self.machine.wiring().camera().frames_sent() > self.traced_cycles.len() as u64 {
                self.advance()?;
            }
        }
        self.check_log(0)?;
        let captured = self.machine.dcmi_counters().frames_captured;
        let (idle, all) = self.epoch;
        let idle = self.machine.idle_cycles() - idle;
        let all = self.machine.cycles() - all;
        Ok(BoardFigures {
            frames_sent: self.machine.wiring().camera().frames_sent(),
            frames_captured: captured.saturating_sub(u64::from(SETTLING_FRAMES)),
            frames_processed: self.traced_cycles.len() as u64,
            traced_cycles: std::mem::take(&mut self.traced_cycles),
            cpu_load: Some(1.0 - idle as f64 / all.max(1) as f64),
            stack_peak_bytes: self.machine.stack_peak_bytes(),
        })
    }
}
