//! The native board: the firmware's pure logic compiled for this machine, with the wires' and the
//! camera's timing kept so that it sees what the emulated board sees, in the same order.

use fake_sensors::camera::Pose;
use link::{Event, Frame, Parser, Refused};
use nav::{LensCalibration, RecordError};
use pilot::{Outbox, Pilot};

use super::camera::{Camera, LAST_LINE};
use super::{Board, BoardError, BoardFigures, CAMERA_LEAD_NS, FirmwareLog, FrameLog};

/// The sensor's clock on the flight board, hertz.
pub const EXTCLK_HZ: u32 = 21_000_000;

/// Silence on the wire after which the firmware gives an unfinished frame up.
const SILENCE_MS: u64 = 20;

/// The pilot on a board without a processor.
pub struct Native {
    pilot: Pilot,
    parser: Parser,
    camera: Camera,
    elapsed_ms: u64,
    /// When the autopilot sent last.
    heard_ms: u64,
    /// Bytes that are on the wire to the firmware.
    inbound: Vec<u8>,
    outbound: Vec<u8>,
    outbox: Outbox,
    log: Vec<FirmwareLog>,
    frames_processed: u64,
}

impl Native {
    /// A board that has just been switched on. `camera` must be streaming since its time zero.
    pub fn new(pilot: Pilot, camera: Camera) -> Self {
        Self {
            pilot,
            parser: Parser::new(),
            camera,
            elapsed_ms: 0,
            heard_ms: 0,
            inbound: Vec::new(),
            outbound: Vec::new(),
            outbox: Outbox::new(),
            log: Vec::new(),
            frames_processed: 0,
        }
    }

    /// Says which lens the pilot has, as the firmware does at boot.
    pub fn log_lens(&mut self, record: &Result<LensCalibration, RecordError>) {
        let (level, text) = match record {
            Ok(lens) => ("info", in_figures(lens)),
            Err(RecordError::Empty) => ("info", "none, the default lens is taken".to_owned()),
            Err(error) => ("warn", format!("{error:?}, the default lens is taken")),
        };
        let text = format!("lens record: {text}");
        self.log.push(FirmwareLog::Line {
            level,
            text,
            origin: None,
        });
    }

    /// Messages of this millisecond. They are through a third of it (28 bytes of a STATE at
    /// 921600 baud are 0.3 ms); the camera's edges of the same millisecond come later, see
    /// [`CAMERA_LEAD_NS`].
    fn hear(&mut self) {
        if !self.inbound.is_empty() {
            self.heard_ms = self.elapsed_ms;
        } else if self.elapsed_ms == self.heard_ms + SILENCE_MS {
            self.parser.give_up();
        }
        let inbound = std::mem::take(&mut self.inbound);
        let mut unread = &inbound[..];
        while let Some(event) = self.parser.next_event(&mut unread) {
            match event {
                Event::Frame(frame) => self.obey(&frame),
                Event::Refused(refused) => self.log.push(dropped(&refused)),
            }
        }
    }

    fn obey(&mut self, frame: &Frame) {
        let now_ms = self.elapsed_ms as u32;
        let events = self
            .pilot
            .on_message(now_ms, &frame.message, &mut self.outbox);
        self.log
            .extend(events.iter().map(|event| FirmwareLog::Line {
                level: "info",
                text: format!("{event:?}"),
                origin: None,
            }));
        self.outbound.extend_from_slice(self.outbox.bytes());
        self.outbox.clear();
    }

    /// Camera edges up to the end of this millisecond.
    fn see(&mut self) {
        let until_ns = (self.elapsed_ms + 1) * 1_000_000 + CAMERA_LEAD_NS;
        while let Some(due_ns) = self
            .camera
            .chip()
            .next_edge()
            .filter(|due_ns| *due_ns < until_ns)
        {
            let edge = self.camera.take_edge(due_ns);
            if edge == Some(LAST_LINE) && self.camera.frames_sent() > self.frames_processed {
                self.process_frame(due_ns);
            }
        }
    }

    fn process_frame(&mut self, now_ns: u64) {
        let report = self.pilot.on_frame(self.camera.frame());
        self.frames_processed += 1;
        if let Some(exposure) = report.exposure {
            self.camera
                .chip()
                .write_exposure(now_ns, exposure.shutter_lines, exposure.gain);
        }
        let wanted = self.pilot.exposure();
        self.log.push(FirmwareLog::Frame(FrameLog {
            cycles: None,
            luma: report.mean_luma,
            lines: wanted.shutter_lines,
            gain: wanted.gain,
        }));
    }
}

/// In the firmware's words.
fn in_figures(lens: &LensCalibration) -> String {
    let ((x, y), horizon) = (lens.centre_px, lens.horizon_radius_px);
    let (inner, outer) = (lens.inner_radius_px, lens.outer_radius_px);
    format!("centre {x:?} {y:?} px, band {inner:?} to {outer:?} px, horizon {horizon:?} px")
}

/// In the firmware's words.
fn dropped(refused: &Refused) -> FirmwareLog {
    FirmwareLog::LinkDrop {
        message: refused.message_name().to_owned(),
        why: refused.why.name().to_owned(),
        origin: None,
    }
}

impl Board for Native {
    fn name(&self) -> &'static str {
        "native"
    }

    fn look_from(&mut self, pose: Pose) {
        let now_ns = self.elapsed_ms * 1_000_000 + CAMERA_LEAD_NS;
        self.camera.look_from(now_ns, pose);
    }

    fn transmit(&mut self, bytes: &[u8]) {
        self.inbound.extend_from_slice(bytes);
    }

    fn advance(&mut self) -> Result<(), BoardError> {
        self.hear();
        self.see();
        self.elapsed_ms += 1;
        Ok(())
    }

    fn receive(&mut self, into: &mut Vec<u8>) {
        into.append(&mut self.outbound);
    }

    fn drain_log(&mut self, into: &mut Vec<FirmwareLog>) {
        into.append(&mut self.log);
    }

    fn finish(&mut self) -> Result<BoardFigures, BoardError> {
        Ok(BoardFigures {
            frames_sent: self.camera.frames_sent(),
            frames_captured: self.frames_processed,
            frames_processed: self.frames_processed,
            ..BoardFigures::default()
        })
    }
}
