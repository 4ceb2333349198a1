//! An emulated board on the desk: nothing but a chip, its two UARTs and a probe, against the clock on
//! the wall. Who meets it there meets what he would meet at a board that is really there.
//!
//! ```text
//! port <-> USART2 (link)    \
//! port <-> USART3 (frames)   >  emulated chip, without a camera
//! port <-> flash, RAM, RTT  /
//! ```

mod chip;
mod probe_port;
mod serial_line;

use std::path::PathBuf;

use crate::live::{Common, Endpoint, LiveError, Notice, Pacer, Port, TcpPort};
use crate::summary::PaceFigures;

use super::file::{BoardName, Camera, Line, ProbeKind, Rig};
use super::probe::wire::{Request, granted, refused};
use chip::Chip;
use probe_port::ProbePort;
use serial_line::SerialLine;

/// The UART that the autopilot is on.
const LINK_USART: u8 = 2;
/// The UART that takes frames.
const FRAMES_USART: u8 = 3;

/// A board, and where it is met.
#[derive(Debug)]
pub struct DeskSetup<'s> {
    /// The link's port, speed and end.
    pub common: Common<'s>,
    /// The image that is in the flash at first.
    pub elf: &'s [u8],
    /// Where frames are taken.
    pub frames: Endpoint,
    /// The rate at which they are.
    pub frames_baud: u32,
    /// Where the probe is met.
    pub probe: TcpPort,
}

/// An emulated board whose ports are open.
pub struct Desk<'s> {
    setup: DeskSetup<'s>,
    /// None once it has stopped: until it is flashed or reset.
    chip: Chip,
    stopped: bool,
    link: SerialLine,
    frames: SerialLine,
    probe: ProbePort,
    say: &'s dyn Fn(Notice),
}

impl<'s> Desk<'s> {
    /// Opens the ports and switches the chip on.
    ///
    /// # Errors
    /// [`LiveError`] where a port cannot be opened or the image cannot be loaded.
    pub fn open(setup: DeskSetup<'s>, say: &'s dyn Fn(Notice)) -> Result<Self, LiveError> {
        let common = &setup.common;
        let link = Port::open(&common.link, common.baud)?;
        let frames = Port::open(&setup.frames, setup.frames_baud)?;
        let desk = Self {
            chip: Chip::boot(setup.elf)?,
            stopped: false,
            link: SerialLine::new(LINK_USART, link, common.baud),
            frames: SerialLine::new(FRAMES_USART, frames, setup.frames_baud),
            probe: ProbePort::open(setup.probe)?,
            setup,
            say,
        };
        desk.tell("Link", desk.link.place().to_owned());
        desk.tell("Frames", desk.frames.place().to_owned());
        desk.tell("Probe", desk.setup.probe.to_string());
        Ok(desk)
    }

    /// The rig that this board is part of.
    pub fn rig(&self, name: &str, board: BoardName) -> Rig {
        let line = |place: &str, baud| Line {
            device: PathBuf::from(place),
            baud,
        };
        Rig {
            name: name.to_owned(),
            board,
            probe: ProbeKind::Emulated(self.setup.probe),
            link: line(self.link.place(), self.setup.common.baud),
            camera: Camera::Serial(line(self.frames.place(), self.setup.frames_baud)),
            power_cycle: None,
            wiring: "emulated by `hil emulate`\n".to_owned(),
        }
    }

    /// Runs until somebody asks to end, or the limit. How well it kept step with the clock.
    pub fn run(mut self) -> PaceFigures {
        let mut pacer = Pacer::new(self.setup.common.speed);
        let mut now_ms = 0;
        while !self.setup.common.over(now_ms) {
            pacer.wait();
            if let Some(late) = pacer.falls_behind() {
                let text = format!("{:.1} s behind the clock", late.as_secs_f64());
                (self.say)(Notice::Warning(text));
            }
            self.step();
            now_ms += 1;
        }
        pacer.figures()
    }

    fn step(&mut self) {
        for news in self.link.feed(&mut self.chip) {
            self.tell("Link", news);
        }
        for news in self.frames.feed(&mut self.chip) {
            self.tell("Frames", news);
        }
        if !self.stopped
            && let Err(fault) = self.chip.advance()
        {
            self.stopped = true;
            let text = format!("the chip has stopped, until it is flashed or reset: {fault}");
            (self.say)(Notice::Warning(text));
        }
        self.link.hand_over(&mut self.chip);
        self.frames.hand_over(&mut self.chip);
        self.probe.log(&self.chip.take_log());
        for (client, request) in self.probe.poll() {
            let answer = self.answer(&request);
            self.probe.answer(client, &request, &answer);
        }
    }

    fn answer(&mut self, request: &Request) -> Vec<u8> {
        match request {
            Request::Info => granted(b"emulated STM32F407VG"),
            Request::Log => granted(b""),
            Request::Reset => {
                self.chip.reset();
                self.stopped = false;
                granted(b"")
            }
            Request::Read { address, length } => match self.chip.read(*address, *length) {
                Some(bytes) => granted(bytes),
                None => refused(&format!(
                    "there is no memory at {address:08x}, {length} bytes"
                )),
            },
            Request::Flash(elf) => match Chip::boot(elf) {
                Ok(chip) => {
                    self.chip = chip;
                    self.stopped = false;
                    self.tell("Flashed", format!("an image of {} bytes", elf.len()));
                    granted(b"")
                }
                Err(error) => refused(&error.to_string()),
            },
        }
    }

    fn tell(&self, verb: &'static str, text: String) {
        (self.say)(Notice::Status(verb, text));
    }
}
