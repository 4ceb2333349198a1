//! What is on a board: what its image says of itself, its lens, and how its frames fared.

use std::time::{Duration, Instant};

use frames::{Counts, Identity, Replies, Reply, Request};
use nav::RecordError;
use nav::calibration::record::{self, RECORD_BYTES};

use crate::live::{Endpoint, Port};

use super::file::{Camera, Line, Rig};
use super::probe::{Probe, ProbeError};

/// Where the chip's flash begins.
const FLASH: u32 = 0x0800_0000;
/// How far an image reaches at most: its budget, 128 KiB.
const IMAGE_BYTES: usize = 128 << 10;
/// So much is read at a time.
const PIECE_BYTES: usize = 16 << 10;
/// How an identification begins, at an address that four divides.
const MAGIC: &[u8; 4] = b"CATA";
/// For an answer on the frames' line.
const ANSWER: Duration = Duration::from_millis(500);

/// What is known of a board.
#[derive(Clone, Debug, PartialEq)]
pub struct Info {
    /// What its image is; none where it is none of this project.
    pub identity: Option<Identity>,
    /// The lens record of its flash, for people.
    pub lens: Option<String>,
    /// What has become of frames over serial; none where nobody answers.
    pub frames: Option<Counts>,
}

/// Asks the chip's memory, and on a rig image the frames' line.
///
/// # Errors
/// [`ProbeError`].
pub fn info(rig: &Rig, probe: &mut dyn Probe) -> Result<Info, ProbeError> {
    let identity = find_identity(probe)?;
    let lens = match &identity {
        Some(identity) => {
            let page = probe.read(identity.lens_page, RECORD_BYTES)?;
            Some(lens_in_words(&page, identity))
        }
        None => None,
    };
    let frames = match &rig.camera {
        Camera::Serial(line) if identity.is_some() => counts(line),
        _ => None,
    };
    Ok(Info {
        identity,
        lens,
        frames,
    })
}

/// Looks for an identification in the flash.
fn find_identity(probe: &mut dyn Probe) -> Result<Option<Identity>, ProbeError> {
    let mut flash = Vec::new();
    for at in (0..IMAGE_BYTES).step_by(PIECE_BYTES) {
        flash.extend(probe.read(FLASH + at as u32, PIECE_BYTES)?);
        // One that reaches into the next piece is found with that.
        if let Some(identity) = identity_in(&flash) {
            return Ok(Some(identity));
        }
    }
    Ok(None)
}

fn identity_in(flash: &[u8]) -> Option<Identity> {
    let places = (0..flash.len()).step_by(MAGIC.len());
    places
        .filter(|at| flash[*at..].starts_with(MAGIC))
        .find_map(|at| Identity::decode(flash[at..].first_chunk()?))
}

fn lens_in_words(page: &[u8], identity: &Identity) -> String {
    let layout = nav::FrameLayout {
        width: identity.shape.width,
        height: identity.shape.height,
        ..pilot::FRAME_LAYOUT
    };
    match record::decode(page, &layout) {
        Ok(lens) => format!(
            "centre {:.1} {:.1} px, radii {:.1} to {:.1} px",
            lens.centre_px.0, lens.centre_px.1, lens.inner_radius_px, lens.outer_radius_px
        ),
        Err(RecordError::Empty) => "none: the firmware takes its default".to_owned(),
        Err(error) => format!("unusable: {error}"),
    }
}

fn counts(line: &Line) -> Option<Counts> {
    let mut port = Port::open(&Endpoint::Tty(line.device.clone()), line.baud).ok()?;
    let mut replies = Replies::new();
    let started = Instant::now();
    let mut asked = false;
    while started.elapsed() < ANSWER {
        let mut received = Vec::new();
        port.poll(&mut received);
        asked = asked || port.send(&Request::Count.encode()).is_ok();
        let mut unread = &received[..];
        while let Some(reply) = replies.next_reply(&mut unread) {
            if let Ok(Reply::Counts(counts)) = reply {
                return Some(counts);
            }
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    None
}
