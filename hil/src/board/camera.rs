//! The camera of a rig: image sensor, lens and world, from a pose to lines on the bus.

use emulator::time::Nanos;
use emulator::wiring::{CameraSignal, Pin, Wiring};
use fake_sensors::camera::tcm8230::{Edge, Tcm8230};
use fake_sensors::camera::{Frame, HEIGHT, LINE_BYTES, PanoramicCamera, Pose};
use sensor::tcm8230::SETTLING_FRAMES;

/// The sensor's reset input (pin map of the flight board).
const RESET: Pin = Pin {
    port: 'D',
    number: 2,
};
/// The sensor's clock input.
const EXTCLK: Pin = Pin {
    port: 'A',
    number: 7,
};
/// The I2C bus that the sensor is on.
const I2C_BUS: u8 = 2;

/// The edge with which a frame is complete.
const LAST_LINE: Edge = Edge::Line(HEIGHT - 1);

/// An image sensor behind a panoramic lens, looking at a world.
#[derive(Debug)]
pub struct Camera {
    chip: Tcm8230,
    optics: PanoramicCamera,
    pose: Pose,
    frames_started: u64,
    frames_sent: u64,
    /// Frames that a driver throws away: the sensor's first show nothing yet.
    settling: u8,
}

impl Camera {
    /// A camera on the ground at the start of the route.
    pub fn new(chip: Tcm8230, optics: PanoramicCamera, pose: Pose) -> Self {
        Self {
            chip,
            optics,
            pose,
            frames_started: 0,
            frames_sent: 0,
            settling: SETTLING_FRAMES,
        }
    }

    /// Where the camera is from now on. A frame shows the world from where it started.
    pub fn look_from(&mut self, pose: Pose) {
        self.pose = pose;
    }

    /// The sensor's registers and timing.
    pub fn chip(&mut self) -> &mut Tcm8230 {
        &mut self.chip
    }

    /// The frame that is being put out.
    pub fn frame(&self) -> &Frame {
        self.optics.frame()
    }

    /// Frames that have started since power-on.
    pub fn frames_started(&self) -> u64 {
        self.frames_started
    }

    /// Frames with a picture whose last line has been sent since power-on.
    pub fn frames_sent(&self) -> u64 {
        self.frames_sent
    }

    /// Performs the next edge if it is due; a frame is exposed when it starts.
    pub fn take_edge(&mut self, now_ns: u64) -> Option<Edge> {
        let edge = self.chip.take_edge(now_ns)?;
        match edge {
            Edge::FrameStart { number } => {
                self.frames_started += 1;
                self.expose(number);
            }
            LAST_LINE if self.settling > 0 => self.settling -= 1,
            LAST_LINE => self.frames_sent += 1,
            Edge::Line(_) | Edge::FrameEnd => {}
        }
        Some(edge)
    }

    fn expose(&mut self, number: u32) {
        if self.chip.black() {
            self.optics.black_frame();
        } else {
            self.optics.set_tuning(self.chip.tuning());
            self.optics.expose(&self.pose, self.chip.exposure(), number);
        }
    }
}

/// The camera soldered to an emulated board.
impl Wiring for Camera {
    fn pin_changed(&mut self, now: Nanos, pin: Pin, high: bool) {
        if pin == RESET {
            self.chip.set_reset(now.0, high);
        }
    }

    fn clock_changed(&mut self, now: Nanos, pin: Pin, hertz: Option<f64>) {
        if pin == EXTCLK {
            self.chip
                .set_clock(now.0, hertz.map(|hertz| hertz.round() as u32));
        }
    }

    fn i2c_start(&mut self, now: Nanos, bus: u8, address: u8, read: bool) -> bool {
        bus == I2C_BUS && self.chip.i2c_start(now.0, address, read)
    }

    fn i2c_write(&mut self, now: Nanos, bus: u8, byte: u8) -> bool {
        bus == I2C_BUS && self.chip.i2c_write(now.0, byte)
    }

    fn i2c_read(&mut self, now: Nanos, bus: u8) -> u8 {
        if bus == I2C_BUS {
            self.chip.i2c_read(now.0)
        } else {
            0xff
        }
    }

    fn i2c_stop(&mut self, now: Nanos, bus: u8) {
        if bus == I2C_BUS {
            self.chip.i2c_stop(now.0);
        }
    }

    fn camera_next(&self) -> Option<Nanos> {
        self.chip.next_edge().map(Nanos)
    }

    fn camera_signal(&mut self, now: Nanos) -> Option<CameraSignal<'_>> {
        Some(match self.take_edge(now.0)? {
            Edge::FrameStart { .. } => CameraSignal::FrameStart,
            Edge::Line(line) => {
                CameraSignal::Line(&self.frame()[line * LINE_BYTES..][..LINE_BYTES])
            }
            Edge::FrameEnd => CameraSignal::FrameEnd,
        })
    }
}
