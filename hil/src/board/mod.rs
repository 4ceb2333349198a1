//! The boards that the same firmware logic flies on, behind one trait: advance time, exchange link
//! bytes, look at the world, read the log.

pub mod camera;
pub mod emulated;
pub(crate) mod firmware_log;
pub mod native;
pub mod observer;
pub mod origin;
mod poses;
pub mod probe;
mod rows;
pub(crate) mod rtt;
pub mod sabotage;
pub mod serial_frames;
pub mod timing;

use fake_sensors::camera::Pose;

use origin::Origin;

/// How long before the flight's time zero the first camera frame starts, nanoseconds.
///
/// The frame period is 39.000 ms (525 lines of 780 pixel clocks at 21 MHz / 2), so the camera's
/// edges keep their place within the flight loop's millisecond for a whole flight. A frame's last line
/// ends 35.236 ms after its start; this lead puts that at 0.65 of a millisecond. What the autopilot
/// sends is through in the first half. So a STATE and a frame never race for the processor, and a board
/// with a processor sees them in the same order as one without. None of the camera's edges is nearer
/// than 10 us to the border of a millisecond, where the pose changes. In the world the two clocks
/// are independent, and any phase is as good as another.
pub const CAMERA_LEAD_NS: u64 = 584_000;

/// Something that runs the firmware's logic, stepped a millisecond at a time.
///
/// In each step the flight loop says what the camera sees, puts bytes on the wire and advances;
/// what the firmware sent in that time is then there to be received.
pub trait Board {
    /// `emulator` or `native`.
    fn name(&self) -> &'static str;

    /// Where the camera is from now on, in the world's frame.
    fn look_from(&mut self, pose: Pose);

    /// Puts bytes on the firmware's receive line now, at the line's rate.
    fn transmit(&mut self, bytes: &[u8]);

    /// Advances by one millisecond.
    fn advance(&mut self) -> Result<(), BoardError>;

    /// Appends what the firmware sent since the last call.
    fn receive(&mut self, into: &mut Vec<u8>);

    /// Appends what the firmware logged since the last call.
    fn drain_log(&mut self, into: &mut Vec<FirmwareLog>);

    /// Ends the flight: its figures. A frame that was captured this very moment is still looked at,
    /// and logged.
    fn finish(&mut self) -> Result<BoardFigures, BoardError>;
}

/// The board cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum BoardError {
    /// The emulated chip stopped: a fault, a breakpoint or something that is not modelled.
    #[error(transparent)]
    Chip(#[from] emulator::machine::Fault),
    /// The image cannot be loaded.
    #[error("the image cannot be loaded: {0}")]
    Image(#[from] emulator::image::ImageError),
    /// The image logs in no format that this rig knows.
    #[error("the image has no usable defmt log table: {0}")]
    LogTable(String),
    /// The log is not what the image's table describes.
    #[error("the firmware's log cannot be decoded")]
    Log,
    /// Records of the firmware's log are missing: its cycle counts cannot be told apart any more.
    #[error(
        "the firmware looked at {processed} frames and logged {logged}: log records were lost, or \
             the image was built without debug lines (DEFMT_LOG)"
    )]
    LogLost {
        /// Calls of the function that looks at a frame.
        processed: usize,
        /// Records of frames in the log.
        logged: usize,
    },
    /// The image lacks a symbol that the rig needs.
    #[error("the image has no symbol `{0}`: is it this project's firmware?")]
    NoSymbol(&'static str),
    /// The image's debug information cannot be read.
    #[error("the image's debug information cannot be read: {0}")]
    DebugInformation(String),
    /// The firmware never started its camera.
    #[error(
        "the camera did not send a frame within {seconds} s of power-on; the firmware's log:\n{log}"
    )]
    NoFrame {
        /// How long the rig waited.
        seconds: f64,
        /// What the firmware had to say.
        log: String,
    },
    /// The calibration of the lens is no calibration.
    #[error("the lens calibration is impossible: {0:?}")]
    Calibration(nav::CalibrationError),
}

/// One record of the firmware's log.
#[derive(Clone, Debug, PartialEq)]
pub enum FirmwareLog {
    /// A processed frame.
    Frame(FrameLog),
    /// A frame of the link that the firmware dropped.
    LinkDrop {
        /// The message that its header names; `?` where it could not be read.
        message: String,
        /// Why.
        why: String,
        /// When and where it was logged; none where no image did.
        origin: Option<Origin>,
    },
    /// A fault of the camera's signal or of its way into memory. At most one a second of a name.
    CaptureFault {
        /// `no signal`, `short line` and so on.
        name: String,
        /// When and where it was logged; none where no image did.
        origin: Option<Origin>,
    },
    /// Anything else, for people.
    Line {
        /// error, warn, info, debug or trace.
        level: &'static str,
        /// What was said.
        text: String,
        /// When and where it was logged; none where no image did.
        origin: Option<Origin>,
    },
}

/// What the firmware says of each frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameLog {
    /// Processor cycles from frame to spectrum; none where no processor was emulated.
    pub cycles: Option<u32>,
    /// Mean luma of the horizon.
    pub luma: f32,
    /// Shutter asked for, lines.
    pub lines: u16,
    /// Gain asked for, 1 = 0 dB.
    pub gain: f32,
}

/// Counters and figures of a board.
#[derive(Clone, Debug, Default)]
pub struct BoardFigures {
    /// Frames that the camera sent whole, without the first few that show nothing yet.
    pub frames_sent: u64,
    /// Frames of these captured whole.
    pub frames_captured: u64,
    /// Frames that the firmware looked at.
    pub frames_processed: u64,
    /// Cycles per frame by the emulator's counter, in the order of the frames.
    pub traced_cycles: Vec<u32>,
    /// Share of cycles in which the processor was awake; none where none was emulated.
    pub cpu_load: Option<f64>,
    /// Deepest stack, bytes.
    pub stack_peak_bytes: Option<u32>,
}
