//! From a rig's description to a board that flies: everything is there, the image is on it and says
//! that it is the one, and frames are taken from the line.

use std::thread;
use std::time::{Duration, Instant};

use frames::{Identity, ImageKind, Replies, Reply, Request, Shape, Source};

use crate::live::{OpenError, Port, Unsent};

use super::eye::Blind;
use super::file::{Camera, Line, Rig};
use super::probe::{Image, Probe, ProbeError, power_cycle};
use super::voices::{Heard, Voices, listen};

/// For an image to start and to say what it is; it needs some 100 ms.
const BOOT: Duration = Duration::from_secs(3);
/// Between two questions.
const ASK_EVERY: Duration = Duration::from_millis(100);
/// Between two looks.
const LOOK_EVERY: Duration = Duration::from_millis(2);
/// How long a frame may be on its way and still be of use: raw frames take 82 ms at 3 Mbaud, and a
/// camera's frame is 39 ms old when it is complete.
const FRESH_MS: u16 = 250;

/// The board on the desk does not take part.
#[derive(Debug, thiserror::Error)]
pub enum Unready {
    /// The probe, or the chip behind it.
    #[error("probe: {0}")]
    Probe(#[from] ProbeError),
    /// A device that is not there.
    #[error("{place}: {error}: is the adapter plugged in?")]
    NoDevice {
        /// `link` or `frames`.
        place: &'static str,
        /// Which, and why.
        error: OpenError,
    },
    /// Several things at once.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
    Several(Vec<Unready>),
    /// Nobody answers on the link.
    #[error("link: nobody answers on {device}, whose image was just flashed and started{hint}")]
    NoLink {
        /// The link's device.
        device: String,
        /// What else was heard.
        hint: &'static str,
    },
    /// The image does not say who it is.
    #[error("frames: no identification came over {device} within {} s{hint}", BOOT.as_secs())]
    NoIdentity {
        /// The frames' device.
        device: String,
        /// What else was heard.
        hint: &'static str,
    },
    /// Another image than the one that was flashed.
    #[error("frames: the board says that it is {found}; what was flashed is {wanted}")]
    OtherImage {
        /// What runs.
        found: String,
        /// What should.
        wanted: String,
    },
    /// A flight image, or one without any identification.
    #[error("the image is no rig image: it takes no frames over serial (`hil build --kind rig`)")]
    NoRigImage,
    /// A fitted camera, where frames are to be sent.
    #[error("the rig's camera is fitted: there is no line for frames (camera = \"serial\")")]
    NoFramesLine,
    /// The board does not begin.
    #[error("frames: the board did not begin a session within {} s", BOOT.as_secs())]
    NoSession,
    /// The line broke in the flight.
    #[error("frames: {0}")]
    Blind(#[from] Blind),
    /// The link's device is gone.
    #[error("link: the device went away, and did not come back within {seconds} s")]
    LinkLost {
        /// How long was waited.
        seconds: f64,
    },
}

/// A board that is ready for a flight.
pub struct Ready {
    /// The link, open since the board was heard on it: what is said on a line that was closed and
    /// opened in between may be lost.
    pub link: Port,
    /// Where frames go; none where the camera is fitted.
    pub frames: Option<(Port, Shape)>,
}

/// Makes a rig ready: looks whether all is there, flashes, and waits until the image says what it is.
///
/// # Errors
/// [`Unready`]: what is missing, all of it at once as far as it can be known before the image runs.
pub fn make_ready(
    rig: &Rig,
    probe: &mut dyn Probe,
    image: &Image,
    identity: Option<&Identity>,
) -> Result<Ready, Unready> {
    let frames = match &rig.camera {
        Camera::Serial(line) => {
            let rig_image = identity.filter(|identity| identity.kind == ImageKind::Rig);
            Some((line, rig_image.ok_or(Unready::NoRigImage)?))
        }
        Camera::Fitted => None,
    };
    look_round(rig, probe)?;
    flash(rig, probe, image)?;
    let Some((line, wanted)) = frames else {
        let mut link = open("link", &rig.link)?;
        listen(&mut [&mut link], BOOT, |heard| heard[0].link);
        answered(link.heard(), rig)?;
        return Ok(Ready {
            link: link.into_port(),
            frames: None,
        });
    };
    let (mut link, mut frames) = (open("link", &rig.link)?, open("frames", line)?);
    listen(&mut [&mut link, &mut frames], BOOT, |heard| {
        heard[0].link && heard[1].identity.is_some()
    });
    identified(frames.heard(), line, wanted)?;
    answered(link.heard(), rig)?;
    let mut port = frames.into_port();
    begin(&mut port)?;
    Ok(Ready {
        link: link.into_port(),
        frames: Some((port, wanted.shape)),
    })
}

/// Whether probe and devices are there.
fn look_round(rig: &Rig, probe: &mut dyn Probe) -> Result<(), Unready> {
    let mut missing = Vec::new();
    if let Err(error) = probe.find() {
        missing.push(error.into());
    }
    missing.extend(open("link", &rig.link).err());
    if let Camera::Serial(line) = &rig.camera {
        missing.extend(open("frames", line).err());
    }
    match missing.len() {
        0 => Ok(()),
        1 => Err(missing.remove(0)),
        _ => Err(Unready::Several(missing)),
    }
}

/// Flashes; where the chip cannot be got at and the power can be switched, once more after that.
fn flash(rig: &Rig, probe: &mut dyn Probe, image: &Image) -> Result<(), Unready> {
    match (probe.flash(image.elf), &rig.power_cycle) {
        (Err(ProbeError::NoChip { .. } | ProbeError::NoProbe), Some(cycle)) => {
            power_cycle(cycle)?;
            Ok(probe.flash(image.elf)?)
        }
        (flashed, _) => Ok(flashed?),
    }
}

fn open(place: &'static str, line: &Line) -> Result<Voices, Unready> {
    Voices::open(line).map_err(|error| Unready::NoDevice { place, error })
}

fn answered(heard: &Heard, rig: &Rig) -> Result<(), Unready> {
    if heard.link {
        return Ok(());
    }
    Err(Unready::NoLink {
        device: rig.link.device.display().to_string(),
        hint: hint(
            heard,
            "; the frames port answers there: the devices are swapped",
        ),
    })
}

fn identified(heard: &Heard, line: &Line, wanted: &Identity) -> Result<(), Unready> {
    match &heard.identity {
        Some(found) if found == wanted => Ok(()),
        Some(found) => Err(Unready::OtherImage {
            found: in_words(found),
            wanted: in_words(wanted),
        }),
        None => Err(Unready::NoIdentity {
            device: line.device.display().to_string(),
            hint: hint(heard, "; the link answers there: the devices are swapped"),
        }),
    }
}

/// What a silent line may be.
fn hint(heard: &Heard, swapped: &'static str) -> &'static str {
    match heard {
        Heard { echo: true, .. } => "; it hears itself: its TX and RX are connected",
        Heard { link: true, .. }
        | Heard {
            identity: Some(_), ..
        } => swapped,
        Heard { bytes: 1.., .. } => {
            "; bytes come, and none of it is the board's: is the rate right?"
        }
        _ => "; is it wired?",
    }
}

/// An identification, for people.
pub fn in_words(identity: &Identity) -> String {
    format!(
        "version {}, {} image for `{}`, protocol {}, frames of {} x {}",
        identity.version(),
        identity.kind.name(),
        identity.board.name(),
        identity.protocol,
        identity.shape.width,
        identity.shape.height
    )
}

/// From now on the board takes frames from the line.
fn begin(port: &mut Port) -> Result<(), Unready> {
    let started = Instant::now();
    let mut replies = Replies::new();
    let mut asked: Option<Instant> = None;
    while started.elapsed() < BOOT {
        if asked.is_none_or(|asked| asked.elapsed() >= ASK_EVERY) {
            asked = Some(Instant::now());
            let request = Request::Begin { fresh_ms: FRESH_MS };
            // It is asked again.
            let _: Result<(), Unsent> = port.send(&request.encode());
        }
        let mut received = Vec::new();
        port.poll(&mut received);
        let mut unread = &received[..];
        while let Some(reply) = replies.next_reply(&mut unread) {
            if reply == Ok(Reply::Source(Source::Serial)) {
                return Ok(());
            }
        }
        thread::sleep(LOOK_EVERY);
    }
    Err(Unready::NoSession)
}
