//! The camera of a rig: image sensor, lens and world, from a pose to lines on the bus.

use emulator::time::Nanos;
use emulator::wiring::Pin;
use fake_sensors::camera::tcm8230::{Edge, Tcm8230};
use fake_sensors::camera::{Frame, HEIGHT, PanoramicCamera, Pose};
use sensor::tcm8230::SETTLING_FRAMES;

use super::poses::Poses;

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

/// The edge with which a frame is complete, and the firmware has it.
pub const LAST_LINE: Edge = Edge::Line(HEIGHT - 1);

/// An image sensor behind a panoramic lens, looking at a world.
#[derive(Debug)]
pub struct Camera {
    chip: Tcm8230,
    optics: PanoramicCamera,
    poses: Poses,
    /// When the frame that is being put out began.
    frame_start_ns: u64,
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
            poses: Poses::new(pose),
            frame_start_ns: 0,
            frames_started: 0,
            frames_sent: 0,
            settling: SETTLING_FRAMES,
        }
    }

    /// Where the camera is from now on (on its own clock); the first call begins the flight, and the
    /// world's time. Each row shows the world from where the camera was amid the row's exposure.
    pub fn look_from(&mut self, now_ns: u64, pose: Pose) {
        self.poses.push(now_ns, pose);
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

    /// Performs the next edge if it is due. A row is exposed when it is put out: the shutter rolls.
    pub fn take_edge(&mut self, now_ns: u64) -> Option<Edge> {
        let edge = self.chip.take_edge(now_ns)?;
        match edge {
            Edge::FrameStart { number } => self.begin_frame(now_ns, number),
            Edge::Line(row) => self.read_row(row),
            Edge::FrameEnd => {}
        }
        match edge {
            LAST_LINE if self.settling > 0 => self.settling -= 1,
            LAST_LINE => self.frames_sent += 1,
            _ => {}
        }
        Some(edge)
    }

    fn begin_frame(&mut self, now_ns: u64, number: u32) {
        self.frames_started += 1;
        self.frame_start_ns = now_ns;
        if self.chip.black() {
            self.optics.black_frame();
        } else {
            self.optics.set_tuning(self.chip.tuning());
            self.optics.begin_frame(number);
            self.light_row(0);
        }
    }

    /// The row below has its light a moment early, for the optic blurs: at the newest pose, should
    /// the middle of its exposure be yet to come.
    fn read_row(&mut self, row: usize) {
        if !self.chip.black() {
            if row + 1 < HEIGHT {
                self.light_row(row + 1);
            }
            self.optics.read_row(row, self.chip.exposure());
        }
    }

    fn light_row(&mut self, row: usize) {
        let amid_ns = self.chip.mid_exposure_ns(row);
        let at_ns = self.frame_start_ns.saturating_add_signed(amid_ns);
        self.optics.light_row(row, &self.poses.at(at_ns));
    }
}

/// What the board does to the camera's inputs, in the words of the emulator's wiring.
impl Camera {
    /// A pin of the board changed its level.
    pub fn pin_changed(&mut self, now: Nanos, pin: Pin, high: bool) {
        if pin == RESET {
            self.chip.set_reset(now.0, high);
        }
    }

    /// A clock of the board changed its frequency (none: stopped), hertz.
    pub fn clock_changed(&mut self, now: Nanos, pin: Pin, hertz: Option<f64>) {
        if pin == EXTCLK {
            self.chip
                .set_clock(now.0, hertz.map(|hertz| hertz.round() as u32));
        }
    }

    /// A start condition and an address. True: the sensor acknowledged.
    pub fn i2c_start(&mut self, now: Nanos, bus: u8, address: u8, read: bool) -> bool {
        bus == I2C_BUS && self.chip.i2c_start(now.0, address, read)
    }

    /// A byte for the sensor. True: acknowledged.
    pub fn i2c_write(&mut self, now: Nanos, bus: u8, byte: u8) -> bool {
        bus == I2C_BUS && self.chip.i2c_write(now.0, byte)
    }

    /// A byte from the sensor; the pulled-up line where it is not on this bus.
    pub fn i2c_read(&mut self, now: Nanos, bus: u8) -> u8 {
        if bus == I2C_BUS {
            self.chip.i2c_read(now.0)
        } else {
            0xff
        }
    }

    /// A stop condition.
    pub fn i2c_stop(&mut self, now: Nanos, bus: u8) {
        if bus == I2C_BUS {
            self.chip.i2c_stop(now.0);
        }
    }

    /// When [`Self::take_edge`] has the next edge; none while the sensor is silent.
    pub fn next_edge(&self) -> Option<Nanos> {
        self.chip.next_edge().map(Nanos)
    }
}

#[cfg(test)]
mod tests {
    use fake_sensors::camera::tcm8230::{frame_period_ns, line_offset_ns};
    use fake_sensors::camera::{LINE_BYTES, PanoramicLens};
    use fake_sensors::world::World;
    use nalgebra::{UnitQuaternion, Vector3};

    use super::*;

    const EXTCLK_HZ: u32 = 21_000_000;
    /// A frame's time: it is exposed for the whole time between two of its readouts.
    const LINES: u16 = 525;

    fn heading(yaw_rad: f32) -> Pose {
        Pose {
            position_m: Vector3::new(-1.0, 0.4, 0.5),
            attitude: UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw_rad),
        }
    }

    /// The third frame of a camera (the first is black) that turns at once at `turn_ns`.
    fn third_frame(turn_ns: u64, turn_rad: f32) -> Frame {
        let chip = Tcm8230::streaming(0, EXTCLK_HZ, LINES, 1.0);
        let world = World::named("arena-panels", 1).unwrap();
        let optics = PanoramicCamera::new(world, &PanoramicLens::default(), 1);
        let mut camera = Camera::new(chip, optics, heading(0.0));
        let mut turned = false;
        while let Some(due_ns) = camera.chip().next_edge() {
            if !turned && due_ns >= turn_ns {
                camera.look_from(turn_ns - 1, heading(0.0));
                camera.look_from(turn_ns, heading(turn_rad));
                turned = true;
            }
            if camera.take_edge(due_ns) == Some(Edge::FrameEnd) && camera.frames_started() == 3 {
                break;
            }
        }
        *camera.frame()
    }

    #[test]
    fn a_row_shows_the_world_from_amid_its_exposure_and_not_from_its_readout() {
        let row = 60;
        let frame_ns = 2 * frame_period_ns(EXTCLK_HZ);
        let readout_ns = frame_ns + line_offset_ns(row, EXTCLK_HZ);
        let amid_ns = readout_ns - frame_period_ns(EXTCLK_HZ) / 2;
        let [before, after] = [third_frame(1, 0.0), third_frame(1, 1.0)];
        // Just before and just after the middle of that row's exposure.
        let [early, late] = [amid_ns - 1_000, amid_ns + 1_000].map(|ns| third_frame(ns, 1.0));
        // The blur mixes in the row above and the row below.
        let byte = |row: usize| LINE_BYTES * row;
        assert!(early[..byte(row - 1)] == before[..byte(row - 1)]);
        assert!(early[byte(row + 1)..] == after[byte(row + 1)..]);
        assert!(late[..byte(row)] == before[..byte(row)]);
        assert!(late[byte(row + 2)..] == after[byte(row + 2)..]);
        assert!(early[byte(row)..byte(row + 1)] != late[byte(row)..byte(row + 1)]);
        assert!(before[byte(row)..] != after[byte(row)..]);
        // A turn after the readout began, and still before the frame's end, shows nowhere.
        assert!(third_frame(frame_ns + frame_period_ns(EXTCLK_HZ) - 1, 1.0) == before);
    }
}
