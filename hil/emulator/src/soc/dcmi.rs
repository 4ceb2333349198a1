//! DCMI: the parallel camera interface with hardware synchronisation (RM0090 §15).
//!
//! The wiring reports a line when its last byte has been clocked out, so bytes are packed and moved
//! once per line. On the wires data is valid while VSYNC and HSYNC are high.

mod fifo;
mod window;

use super::dma::{Dma, Request};
use super::interrupts::{self, Lines};
use super::map::Block;
use super::refusal::Refusal;
use crate::memory::Memory;
use crate::wiring::CameraSignal;
use fifo::Fifo;
use window::Window;

const CR: u32 = 0x00;
const SR: u32 = 0x04;
const RIS: u32 = 0x08;
const IER: u32 = 0x0c;
const MIS: u32 = 0x10;
const ICR: u32 = 0x14;
const ESCR: u32 = 0x18;
const ESUR: u32 = 0x1c;
const CWSTRT: u32 = 0x20;
const CWSIZE: u32 = 0x24;
const DR: u32 = 0x28;

/// CR.
const CAPTURE: u32 = 1 << 0;
const SNAPSHOT: u32 = 1 << 1;
const CROP: u32 = 1 << 2;
const VSYNC_HIGH_IS_BLANKING: u32 = 1 << 7;
const ENABLE: u32 = 1 << 14;
const CR_WRITABLE: u32 = 0x43e7;
/// JPEG, embedded synchronisation and 10 to 14 bits.
const CR_UNMODELLED: u32 = 0x0c18;
const HSYNC_HIGH_IS_BLANKING: u32 = 1 << 6;

/// RIS, IER, MIS and ICR. ERR belongs to embedded synchronisation and never rises.
const FRAME: u32 = 1 << 0;
const OVERRUN: u32 = 1 << 1;
const VSYNC: u32 = 1 << 3;
const LINE: u32 = 1 << 4;
const INTERRUPTS: u32 = 0x1f;

/// What became of the camera's frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DcmiCounters {
    /// Frames the camera began.
    pub frames_started: u64,
    /// Frames captured whole, with all their data taken by DMA.
    pub frames_captured: u64,
    /// Frames that passed while nothing captured, after the first one captured.
    pub frames_missed: u64,
    /// Frames lost because nobody took their data in time.
    pub overruns: u64,
}

/// What the interface does with the frame that is passing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Frame {
    /// None is passing.
    Blanking,
    /// It passes unseen.
    Ignored,
    /// It is being captured.
    Capturing,
    /// All that is wanted of it has been captured.
    Done,
}

/// The camera interface.
#[derive(Clone, Debug)]
pub struct Dcmi {
    cr: u32,
    ris: u32,
    ier: u32,
    window: Window,
    frame: Frame,
    /// CAPTURE was cleared while a frame is being captured: it falls at the end of the frame.
    stopping: bool,
    /// Frames since CAPTURE was set: FCRC leaves out some.
    grabbed: u32,
    line: u32,
    fifo: Fifo,
    counters: DcmiCounters,
}

impl Dcmi {
    /// The reset state.
    pub fn new() -> Self {
        Self {
            cr: 0,
            ris: 0,
            ier: 0,
            window: Window::default(),
            frame: Frame::Blanking,
            stopping: false,
            grabbed: 0,
            line: 0,
            fifo: Fifo::default(),
            counters: DcmiCounters::default(),
        }
    }

    /// Back to the reset state; the frame on the wires goes on.
    pub fn reset(&mut self) {
        let (frame, counters) = (self.frame, self.counters);
        *self = Self {
            counters,
            ..Self::new()
        };
        if frame != Frame::Blanking {
            self.frame = Frame::Ignored;
        }
    }

    /// What became of the camera's frames so far.
    pub fn counters(&self) -> DcmiCounters {
        self.counters
    }

    fn inverted(&self) -> bool {
        self.cr & VSYNC_HIGH_IS_BLANKING != 0
    }

    /// The camera moved its wires.
    pub fn signal(&mut self, signal: CameraSignal<'_>, memory: &mut Memory, dma: &mut Dma) {
        if matches!(signal, CameraSignal::FrameStart) {
            self.counters.frames_started += 1;
        }
        match signal {
            CameraSignal::FrameStart if !self.inverted() => {
                self.fall_before_rise(memory, dma);
                self.frame_start();
            }
            // With the wrong VSPOL frames begin where they end: all they hold is blanking.
            CameraSignal::FrameEnd if self.inverted() => self.frame_start(),
            CameraSignal::Line(bytes) => self.line(bytes, memory, dma),
            _ => self.frame_end(memory, dma),
        }
    }

    /// VSYNC cannot rise again without having fallen: a camera that broke its frame off, or was
    /// taken away in the middle of one, let it fall while nobody looked.
    fn fall_before_rise(&mut self, memory: &mut Memory, dma: &mut Dma) {
        if self.frame != Frame::Blanking {
            self.frame_end(memory, dma);
        }
    }

    fn frame_start(&mut self) {
        self.line = 0;
        self.frame = Frame::Ignored;
        if self.cr & (ENABLE | CAPTURE) != ENABLE | CAPTURE {
            if self.counters.frames_captured > 0 {
                self.counters.frames_missed += 1;
            }
            return;
        }
        // FCRC: every frame, every second, every fourth.
        let wanted = self.grabbed.is_multiple_of(1 << (self.cr >> 8 & 3).min(2));
        self.grabbed = self.grabbed.wrapping_add(1);
        if wanted {
            self.frame = Frame::Capturing;
        }
    }

    /// The flag rises even if the line is not valid (RM0090 §15.8.3).
    fn line(&mut self, bytes: &[u8], memory: &mut Memory, dma: &mut Dma) {
        if self.cr & ENABLE == 0 {
            return;
        }
        self.ris |= LINE;
        let number = self.line;
        self.line += 1;
        if self.frame != Frame::Capturing {
            return;
        }
        let cropped = self.cr & CROP != 0;
        let wanted = if cropped {
            self.window.of_line(number, bytes)
        } else {
            bytes
        };
        let mut rest = wanted;
        while let Some((&byte, behind)) = rest.split_first() {
            if self.fifo.is_empty() {
                // What DMA takes at once need not go through the FIFO.
                let stored = dma.store_words(memory, Request::Dcmi, rest);
                if stored > 0 {
                    rest = &rest[stored..];
                    continue;
                }
            }
            if !self.take(byte, memory, dma) {
                return;
            }
            rest = behind;
        }
        if cropped && self.window.ends_with(number) {
            self.frame_captured(memory, dma);
        }
    }

    /// False: the FIFO overran and the frame is lost.
    fn take(&mut self, byte: u8, memory: &mut Memory, dma: &mut Dma) -> bool {
        let taken = self.fifo.push(byte);
        if taken {
            self.serve(memory, dma);
        } else {
            self.overrun();
        }
        taken
    }

    /// The FIFO is reset and the next frame start awaited (RM0090 §15.5.4); a snapshot is over.
    fn overrun(&mut self) {
        self.ris |= OVERRUN;
        self.counters.overruns += 1;
        self.fifo = Fifo::default();
        self.frame = Frame::Ignored;
        if self.cr & SNAPSHOT != 0 || self.stopping {
            self.stop();
        }
    }

    fn stop(&mut self) {
        self.cr &= !CAPTURE;
        self.stopping = false;
    }

    /// Lets DMA empty the FIFO.
    pub fn serve(&mut self, memory: &mut Memory, dma: &mut Dma) {
        while let Some(word) = self.fifo.first() {
            if !dma.store(memory, Request::Dcmi, word) {
                return;
            }
            self.fifo.pop();
        }
    }

    /// The last byte of the frame, or of its window, is in.
    fn frame_captured(&mut self, memory: &mut Memory, dma: &mut Dma) {
        // An unfinished word is filled with zeros.
        while self.fifo.is_mid_word() {
            if !self.take(0, memory, dma) {
                return;
            }
        }
        self.frame = Frame::Done;
        self.ris |= FRAME;
        if self.line > 0 && self.fifo.first().is_none() {
            self.counters.frames_captured += 1;
        }
        if self.cr & SNAPSHOT != 0 || self.stopping {
            self.stop();
        }
    }

    fn frame_end(&mut self, memory: &mut Memory, dma: &mut Dma) {
        if self.frame == Frame::Capturing {
            self.frame_captured(memory, dma);
        }
        self.frame = Frame::Blanking;
        if self.cr & ENABLE != 0 {
            self.ris |= VSYNC;
        }
    }

    /// Drives the interrupt line.
    pub fn drive(&self, lines: &mut Lines) {
        lines.drive(interrupts::DCMI, self.ris & self.ier != 0);
    }

    /// Reads a register.
    pub fn read(&mut self, offset: u32) -> Result<u32, Refusal> {
        Ok(match offset {
            CR => self.cr,
            SR => self.status(),
            RIS => self.ris,
            IER => self.ier,
            MIS => self.ris & self.ier,
            // Embedded synchronisation is refused; its codes rest at zero.
            ICR | ESCR | ESUR => 0,
            CWSTRT => self.window.start,
            CWSIZE => self.window.size,
            DR => {
                let word = self.fifo.first().unwrap_or(0);
                self.fifo.pop();
                word
            }
            _ => return Err(unknown(offset)),
        })
    }

    /// HSYNC is low whenever software looks: lines pass in one instant. VSYNC shows the blanking.
    fn status(&self) -> u32 {
        let blanking = u32::from(self.frame == Frame::Blanking);
        1 | blanking << 1 | u32::from(self.fifo.first().is_some()) << 2
    }

    /// Writes a register.
    pub fn write(&mut self, offset: u32, value: u32) -> Result<(), Refusal> {
        match offset {
            CR => self.write_cr(value)?,
            IER => self.ier = value & INTERRUPTS,
            ICR => self.ris &= !value,
            CWSTRT => self.window.start = value & 0x1fff_3fff,
            CWSIZE => self.window.size = value & 0x3fff_3fff,
            SR | RIS | MIS | DR => {}
            ESCR | ESUR if value == 0 => {}
            ESCR | ESUR => return refuse("embedded synchronisation", value),
            _ => return Err(unknown(offset)),
        }
        Ok(())
    }

    fn write_cr(&mut self, value: u32) -> Result<(), Refusal> {
        if value & CR_UNMODELLED != 0 {
            return refuse("JPEG, embedded synchronisation or more than 8 bits", value);
        }
        if value & (ENABLE | HSYNC_HIGH_IS_BLANKING) == ENABLE | HSYNC_HIGH_IS_BLANKING {
            return refuse("capture while HSYNC is low", value);
        }
        let (before, enabled) = (self.cr, value & ENABLE != 0);
        self.cr = value & CR_WRITABLE;
        if value & CAPTURE != 0 {
            self.stopping = false;
            if before & CAPTURE == 0 {
                self.grabbed = 0;
            }
        } else if enabled && before & CAPTURE != 0 && self.frame == Frame::Capturing {
            // The bit falls at the end of the frame that is being captured (RM0090 §15.8.1).
            self.cr |= CAPTURE;
            self.stopping = true;
        }
        if !enabled {
            self.stopping = false;
            self.fifo = Fifo::default();
            if self.frame != Frame::Blanking {
                self.frame = Frame::Ignored;
            }
        }
        Ok(())
    }
}

fn unknown(offset: u32) -> Refusal {
    Refusal::UnmodelledRegister {
        block: Block::Dcmi,
        address: 0x5005_0000 + offset,
    }
}

fn refuse<T>(what: &'static str, value: u32) -> Result<T, Refusal> {
    Err(Refusal::UnmodelledMode {
        block: Block::Dcmi,
        what,
        value,
    })
}

#[cfg(test)]
mod tests;
