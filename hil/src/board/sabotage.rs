//! A camera whose wires can be cut, shorted and pulled out while the board runs.
//!
//! It stands between the camera and the chip and changes what passes. What the camera meant to send
//! it keeps, so that a frame that the firmware believed can be held against it.

use emulator::time::Nanos;
use emulator::wiring::{CameraSignal, Pin, Wiring};
use fake_sensors::camera::tcm8230::Edge;
use fake_sensors::camera::{Frame, HEIGHT, LINE_BYTES};

use super::camera::Camera;
use crate::scenario::WireFault;

/// What is wrong with the wires.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sabotage {
    /// VSYNC is broken: the chip's pull-down holds it low.
    VsyncLow,
    /// VSYNC is shorted to the supply.
    VsyncHigh,
    /// HSYNC is broken: no line is framed.
    HsyncLow,
    /// Of each line in `lines`, the first `bytes` are framed.
    LineBytes {
        /// From this line of the frame on,
        first: usize,
        /// to this one; both included.
        last: usize,
        /// Bytes framed. Beyond the line's own, further pixel clocks bring blanking.
        bytes: usize,
    },
    /// The first line given loses bytes, the second wins as many.
    Slip {
        /// The line that loses.
        loses: usize,
        /// The line that wins.
        wins: usize,
        /// So many bytes.
        bytes: usize,
    },
    /// EXTCLK does not reach the sensor, which stands still.
    ClockStopped,
    /// Nothing reaches the sensor, not even its supply, nor anything from it: it forgets its
    /// registers, and wants a reset when it is back.
    Unplugged,
}

/// A fault of a flight, as it is done to the wires.
impl From<WireFault> for Sabotage {
    fn from(fault: WireFault) -> Self {
        match fault {
            WireFault::LostVsync => Self::VsyncLow,
            WireFault::StuckVsync => Self::VsyncHigh,
            WireFault::LostHsync => Self::HsyncLow,
            WireFault::ShortLine => Self::LineBytes {
                first: SHORT_LINE,
                last: SHORT_LINE,
                bytes: LINE_BYTES - 4,
            },
            WireFault::ExtraBytes => Self::LineBytes {
                first: 0,
                last: usize::MAX,
                bytes: LINE_BYTES + 8,
            },
            WireFault::StoppedClock => Self::ClockStopped,
            WireFault::Unplugged => Self::Unplugged,
        }
    }
}

/// The line that is short in [`WireFault::ShortLine`]: in the middle of the image.
const SHORT_LINE: usize = HEIGHT / 2;

/// A frame as the camera meant it.
#[derive(Clone, Debug)]
pub struct Sent {
    /// When its last line was out.
    pub ended: Nanos,
    /// No wire was tampered with while it was sent.
    pub intact: bool,
    /// Its bytes.
    pub picture: Box<Frame>,
}

/// The camera on an emulated board, with somebody at its wires.
#[derive(Debug)]
pub struct Sabotaged {
    camera: Camera,
    /// A clock of the camera's own, hertz; none: it has the board's.
    crystal_hz: Option<f64>,
    /// What the board drives: its clock, with the pin, and the sensor's other inputs.
    clock: Option<(Pin, Option<f64>)>,
    inputs: Vec<(Pin, bool)>,
    sabotage: Option<Sabotage>,
    /// VSYNC at the camera, and as the chip last saw it.
    vsync: bool,
    vsync_seen: bool,
    /// When VSYNC changed at the chip because of somebody at the wire.
    change_due: Option<Nanos>,
    tampered: bool,
    line_struck: Option<Nanos>,
    line: Vec<u8>,
    frames_ended: u64,
    last: Option<Sent>,
}

impl Sabotaged {
    /// A camera that is well, on the board's clock or on a crystal of its own.
    pub fn new(camera: Camera, crystal_hz: Option<u32>) -> Self {
        Self {
            camera,
            crystal_hz: crystal_hz.map(f64::from),
            clock: None,
            inputs: Vec::new(),
            sabotage: None,
            vsync: false,
            vsync_seen: false,
            change_due: None,
            tampered: false,
            line_struck: None,
            line: Vec::new(),
            frames_ended: 0,
            last: None,
        }
    }

    /// The camera itself.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The same, to move it.
    pub fn camera_mut(&mut self) -> &mut Camera {
        &mut self.camera
    }

    /// Times that the camera let VSYNC fall after a frame since power-on, whatever became of it.
    pub fn frames_ended(&self) -> u64 {
        self.frames_ended
    }

    /// The last frame whose last line the camera has sent.
    pub fn last_sent(&self) -> Option<&Sent> {
        self.last.as_ref()
    }

    /// When a line was last tampered with.
    pub fn line_struck(&self) -> Option<Nanos> {
        self.line_struck
    }

    /// From `now` on this is wrong with the wires.
    pub fn begin(&mut self, now: Nanos, sabotage: Sabotage) {
        self.sabotage = Some(sabotage);
        // What happens to lines is seen when they are struck.
        self.tampered |= self.vsync_at_chip() != self.vsync;
        match sabotage {
            Sabotage::ClockStopped => {
                self.tampered = true;
                self.drive_clock(now, None);
            }
            Sabotage::Unplugged => {
                self.tampered = true;
                self.drive_clock(now, None);
                for (pin, _) in self.inputs.clone() {
                    self.camera.pin_changed(now, pin, false);
                }
                self.vsync = false;
            }
            _ => self.follow_vsync(now),
        }
    }

    /// From `now` on the wires are whole.
    pub fn end(&mut self, now: Nanos) {
        match self.sabotage.take() {
            Some(Sabotage::ClockStopped) => self.drive_clock(now, self.hertz()),
            Some(Sabotage::Unplugged) => {
                self.drive_clock(now, self.hertz());
                for (pin, high) in self.inputs.clone() {
                    self.camera.pin_changed(now, pin, high);
                }
            }
            _ => self.follow_vsync(now),
        }
    }

    fn hertz(&self) -> Option<f64> {
        let driven = self.clock.and_then(|(_, hertz)| hertz);
        driven.map(|hertz| self.crystal_hz.unwrap_or(hertz))
    }

    fn drive_clock(&mut self, now: Nanos, hertz: Option<f64>) {
        if let Some((pin, _)) = self.clock {
            self.camera.clock_changed(now, pin, hertz);
        }
    }

    fn is_cut_off(&self) -> bool {
        matches!(
            self.sabotage,
            Some(Sabotage::ClockStopped | Sabotage::Unplugged)
        )
    }

    /// VSYNC as it reaches the chip.
    fn vsync_at_chip(&self) -> bool {
        match self.sabotage {
            Some(Sabotage::VsyncLow) => false,
            Some(Sabotage::VsyncHigh) => true,
            _ => self.vsync,
        }
    }

    /// The chip is to see a change that no edge of the camera's brings.
    fn follow_vsync(&mut self, now: Nanos) {
        self.change_due = (self.vsync_at_chip() != self.vsync_seen).then_some(now);
    }

    /// The change of VSYNC that the chip sees, if it sees one.
    fn vsync_signal(&mut self) -> Option<CameraSignal<'static>> {
        let high = self.vsync_at_chip();
        if high == self.vsync_seen {
            return None;
        }
        self.vsync_seen = high;
        Some(if high {
            CameraSignal::FrameStart
        } else {
            CameraSignal::FrameEnd
        })
    }

    /// The last line is out: the frame is what it is, whatever becomes of VSYNC.
    fn frame_sent(&mut self, now: Nanos) {
        self.last = Some(Sent {
            ended: now,
            intact: !self.tampered,
            picture: Box::new(*self.camera.frame()),
        });
    }

    /// How many bytes of a line are framed; none where the line does not pass.
    fn framed(&self, line: usize) -> Option<usize> {
        match self.sabotage {
            Some(Sabotage::HsyncLow) => None,
            Some(Sabotage::LineBytes { first, last, bytes }) if (first..=last).contains(&line) => {
                (bytes > 0).then_some(bytes)
            }
            Some(Sabotage::Slip { loses, bytes, .. }) if line == loses => Some(LINE_BYTES - bytes),
            Some(Sabotage::Slip { wins, bytes, .. }) if line == wins => Some(LINE_BYTES + bytes),
            _ => Some(LINE_BYTES),
        }
    }

    fn line_signal(&mut self, now: Nanos, line: usize) -> Option<CameraSignal<'_>> {
        let framed = self.framed(line);
        if framed != Some(LINE_BYTES) {
            self.tampered = true;
            self.line_struck = Some(now);
        }
        if line == HEIGHT - 1 {
            self.frame_sent(now);
        }
        let bytes = &self.camera.frame()[line * LINE_BYTES..][..LINE_BYTES];
        self.line.clear();
        self.line.extend_from_slice(bytes);
        self.line.resize(framed?, 0);
        Some(CameraSignal::Line(&self.line))
    }
}

impl Wiring for Sabotaged {
    fn pin_changed(&mut self, now: Nanos, pin: Pin, high: bool) {
        self.inputs.retain(|(known, _)| *known != pin);
        self.inputs.push((pin, high));
        // A sensor in reset drives no sync.
        self.vsync &= high;
        if self.sabotage != Some(Sabotage::Unplugged) {
            self.camera.pin_changed(now, pin, high);
        }
    }

    fn clock_changed(&mut self, now: Nanos, pin: Pin, hertz: Option<f64>) {
        self.clock = Some((pin, hertz));
        if !self.is_cut_off() {
            self.drive_clock(now, self.hertz());
        }
    }

    fn i2c_start(&mut self, now: Nanos, bus: u8, address: u8, read: bool) -> bool {
        self.sabotage != Some(Sabotage::Unplugged) && self.camera.i2c_start(now, bus, address, read)
    }

    fn i2c_write(&mut self, now: Nanos, bus: u8, byte: u8) -> bool {
        self.sabotage != Some(Sabotage::Unplugged) && self.camera.i2c_write(now, bus, byte)
    }

    fn i2c_read(&mut self, now: Nanos, bus: u8) -> u8 {
        self.camera.i2c_read(now, bus)
    }

    fn i2c_stop(&mut self, now: Nanos, bus: u8) {
        self.camera.i2c_stop(now, bus);
    }

    fn camera_next(&self) -> Option<Nanos> {
        let next = self.camera.next_edge();
        match (self.change_due, next) {
            (Some(due), Some(next)) => Some(due.min(next)),
            (due, next) => due.or(next),
        }
    }

    fn camera_signal(&mut self, now: Nanos) -> Option<CameraSignal<'_>> {
        if self.change_due.take().is_some() {
            return self.vsync_signal();
        }
        match self.camera.take_edge(now.0)? {
            Edge::FrameStart { .. } => {
                self.vsync = true;
                // A frame that a reset broke off has let VSYNC fall without an edge.
                self.vsync_seen &= self.sabotage.is_some();
                self.tampered = self.vsync_at_chip() == self.vsync_seen;
                self.vsync_signal()
            }
            Edge::Line(line) => self.line_signal(now, line),
            Edge::FrameEnd => {
                self.vsync = false;
                self.frames_ended += 1;
                self.vsync_signal()
            }
        }
    }
}
