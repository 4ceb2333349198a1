//! The camera of a rig: image sensor, lens and world, from a pose to lines on the bus.

use emulator::time::Nanos;
use emulator::wiring::Pin;
use fake_sensors::camera::tcm8230::{Edge, Tcm8230};
use fake_sensors::camera::{
    Exposure, FRAME_BYTES, Frame, HEIGHT, ImageTuning, LINE_BYTES, Moment, PanoramicCamera, Pose,
};
use sensor::tcm8230::SETTLING_FRAMES;

use super::poses::Poses;
use super::rows::{Order, Rows, Ticket};

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
    rows: Rows,
    poses: Poses,
    /// The frame that is being put out, as far as it has been; below that the one before.
    frame: Box<Frame>,
    /// What is being lit: the same frame, or ahead of time the next; none where that is black.
    exposed: Option<Exposed>,
    /// What its first rows are seen from, as far as that is known, and with which order each was lit.
    lit: Vec<(Moment, Ticket)>,
    frames_started: u64,
    frames_sent: u64,
    /// Frames that a driver throws away: the sensor's first show nothing yet.
    settling: u8,
}

/// A frame that is being exposed.
#[derive(Debug)]
struct Exposed {
    picture: Picture,
    /// The sensor as it was when the frame began, or as it will be.
    chip: Tcm8230,
}

/// What a frame shows but for the light on its rows.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Picture {
    number: u32,
    start_ns: u64,
    tuning: ImageTuning,
    exposure: Exposure,
}

impl Camera {
    /// A camera on the ground at the start of the route.
    pub fn new(chip: Tcm8230, optics: PanoramicCamera, pose: Pose) -> Self {
        Self {
            chip,
            rows: Rows::new(optics),
            poses: Poses::new(pose),
            frame: Box::new([0; FRAME_BYTES]),
            exposed: None,
            lit: Vec::with_capacity(HEIGHT),
            frames_started: 0,
            frames_sent: 0,
            settling: SETTLING_FRAMES,
        }
    }

    /// The same with a second thread that renders ahead: for a flight that has the machine to itself.
    #[must_use]
    pub fn with_helper(self) -> Self {
        Self {
            rows: self.rows.with_helper(),
            ..self
        }
    }

    /// Where the camera is from now on (on its own clock); the first call begins the flight, and the
    /// world's time. Each row shows the world from where the camera was amid the row's exposure.
    pub fn look_from(&mut self, now_ns: u64, pose: Pose) {
        self.poses.push(now_ns, pose);
        self.light_ahead();
    }

    /// The sensor's registers and timing.
    pub fn chip(&mut self) -> &mut Tcm8230 {
        &mut self.chip
    }

    /// The frame that is being put out.
    pub fn frame(&self) -> &Frame {
        &self.frame
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
        if self.chip.black() {
            self.frame = PanoramicCamera::black_frame();
        }
        let picture = Picture::of(&self.chip, now_ns, number);
        if picture != self.exposed.as_ref().map(|exposed| exposed.picture) {
            self.expose(self.chip.clone(), picture);
        }
        self.light_row(0);
        self.light_ahead();
    }

    /// The row below has its light a moment early, for the optic blurs: at the newest pose, should
    /// the middle of its exposure be yet to come.
    fn read_row(&mut self, row: usize) {
        let below = (row + 1).min(HEIGHT - 1);
        if below > row {
            self.light_row(below);
        }
        if let Some((_, ticket)) = self.lit.get(below) {
            let (lines, _) = self.frame.as_chunks_mut::<LINE_BYTES>();
            lines[row] = self.rows.read(row, *ticket);
        }
        if row == below {
            self.expose_next();
        }
    }

    /// Begins with the frame that follows if nobody touches the sensor until then.
    fn expose_next(&mut self) {
        let mut chip = self.chip.clone();
        while let Some(due_ns) = chip.next_edge() {
            if let Some(Edge::FrameStart { number }) = chip.take_edge(due_ns) {
                let picture = Picture::of(&chip, due_ns, number);
                self.expose(chip, picture);
                self.light_ahead();
                return;
            }
        }
    }

    fn expose(&mut self, chip: Tcm8230, picture: Option<Picture>) {
        self.lit.clear();
        self.exposed = picture.map(|picture| Exposed { picture, chip });
        if let Some(Picture { number, tuning, .. }) = picture {
            self.rows.order(Order::Begin { number, tuning });
        }
    }

    /// Now a row must have its light. If it has it already, ahead of time, then almost always the right one. But a
    /// clock that changed in between has moved the middle of its exposure: the row and those below have it afresh.
    fn light_row(&mut self, row: usize) {
        let Some(Exposed { picture, .. }) = &self.exposed else {
            return;
        };
        let picture = *picture;
        let moment = self.poses.at(picture.amid_ns(&self.chip, row));
        if self.lit.get(row).is_none_or(|(lit, _)| *lit != moment) {
            self.lit.truncate(row);
            self.order_light(&picture, row, moment);
        }
    }

    /// Rows the middle of whose exposure has passed have their light now: no pose to come changes it.
    fn light_ahead(&mut self) {
        while let Some(Exposed { picture, chip }) = &self.exposed
            && self.lit.len() < HEIGHT
            && let row = self.lit.len()
            && let Some(moment) = self.poses.settled(picture.amid_ns(chip, row))
        {
            let picture = *picture;
            self.order_light(&picture, row, moment);
        }
    }

    fn order_light(&mut self, picture: &Picture, row: usize, moment: Moment) {
        let ticket = self.rows.order(Order::Light {
            row,
            moment,
            exposure: picture.exposure,
        });
        self.lit.push((moment, ticket));
    }
}

impl Picture {
    /// The frame that `chip` has begun at `start_ns`; none where it is black.
    fn of(chip: &Tcm8230, start_ns: u64, number: u32) -> Option<Self> {
        (!chip.black()).then(|| Self {
            number,
            start_ns,
            tuning: chip.tuning(),
            exposure: chip.exposure(),
        })
    }

    /// The middle of a row's exposure, by the clock that `chip` has.
    fn amid_ns(&self, chip: &Tcm8230, row: usize) -> u64 {
        let amid_ns = chip.mid_exposure_ns(row);
        self.start_ns.saturating_add_signed(amid_ns)
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
mod tests;
