//! The description of a rig: a TOML file that says what is connected to what.

use std::path::{Path, PathBuf};

use frames::ImageKind;
use serde::{Deserialize, Serialize};
use toml::Spanned;

use crate::image::{self, Variant};
use crate::live::TcpPort;
use crate::toml_file::{self, FileError, Mistake};

/// What probe-rs calls the chip of both boards.
pub const CHIP: &str = "STM32F407VGTx";
/// The link's rate where the file says none: what the published camera client sets.
const LINK_BAUD: u32 = 921_600;
/// The rate of frames over serial where the file says none.
const FRAMES_BAUD: u32 = frames::DEFAULT_BAUD;
/// Rates that an adapter may do at all (FT2232H data sheet: 12 Mbaud).
const BAUDS: std::ops::RangeInclusive<u32> = 1_200..=12_000_000;

/// A board with all that connects it to this machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rig {
    /// The file's name, without folder and extension.
    pub name: String,
    /// Which board it is.
    pub board: BoardName,
    /// Who flashes it and reads its log.
    pub probe: ProbeKind,
    /// The wire that stands for the autopilot's.
    pub link: Line,
    /// Where the board's frames come from.
    pub camera: Camera,
    /// What switches the board's power off and on again.
    pub power_cycle: Option<Vec<String>>,
    /// For whoever has to wire it again.
    pub wiring: String,
}

/// A board that the firmware has a pin map for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BoardName {
    /// The camera board that flies.
    Flight,
    /// STM32F4DISCOVERY.
    Discovery,
}

/// Who has access to the chip's memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ProbeKind {
    /// A debug probe, driven by probe-rs.
    ProbeRs {
        /// As probe-rs names it.
        chip: String,
        /// VID:PID:SERIAL as `probe-rs list` prints it; none where there is but one.
        selector: Option<String>,
    },
    /// An emulated board (`hil emulate`) at this port.
    Emulated(TcpPort),
}

/// A serial device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// Its path.
    pub device: PathBuf,
    /// Its rate, baud.
    pub baud: u32,
}

/// Where frames come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Camera {
    /// From the sensor on the board.
    Fitted,
    /// From this machine, over this line.
    Serial(Line),
}

/// No rig of that name, or a file that describes none.
#[derive(Debug, thiserror::Error)]
pub enum RigError {
    /// No such file.
    #[error("there is no rig `{name}`: no {}", tried.iter().map(|path| path.display().to_string()).collect::<Vec<_>>().join(", no "))]
    Unknown {
        /// As asked for.
        name: String,
        /// Where it was looked for.
        tried: Vec<PathBuf>,
    },
    /// The file describes no rig.
    #[error(transparent)]
    File(#[from] FileError),
}

/// The file as it stands.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Description {
    board: BoardName,
    camera: Spanned<CameraName>,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    wiring: String,
    probe: Spanned<ProbeTable>,
    link: LineTable,
    #[serde(skip_serializing_if = "Option::is_none")]
    frames: Option<LineTable>,
    #[serde(skip_serializing_if = "Option::is_none")]
    power: Option<PowerTable>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum CameraName {
    Fitted,
    Serial,
}

#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct ProbeTable {
    #[serde(skip_serializing_if = "Option::is_none")]
    chip: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    selector: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    emulated_port: Option<u16>,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct LineTable {
    device: Spanned<PathBuf>,
    #[serde(skip_serializing_if = "Option::is_none")]
    baud: Option<Spanned<u32>>,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct PowerTable {
    cycle: Spanned<Vec<String>>,
}

impl Rig {
    /// Reads a rig by the path of its file, or by its name: `rigs/NAME.toml` in the working directory,
    /// else in the checkout's examples.
    ///
    /// # Errors
    /// [`RigError`] with file and line.
    pub fn open(name: &str) -> Result<Self, RigError> {
        let file = find(name)?;
        let text = toml_file::read(&file)?;
        Self::parse(&file, &text)
    }

    /// Reads the text of a rig's file.
    ///
    /// # Errors
    /// [`RigError::File`].
    pub fn parse(file: &Path, text: &str) -> Result<Self, RigError> {
        let check = |description: Description| description.check(file);
        Ok(toml_file::parse(file, text, check)?)
    }

    /// The image that belongs on its board.
    pub fn variant(&self) -> Variant {
        let (kind, baud) = match &self.camera {
            Camera::Fitted => (ImageKind::Flight, None),
            Camera::Serial(line) => (ImageKind::Rig, Some(line.baud)),
        };
        Variant {
            kind,
            board: self.board.into(),
            baud: baud.filter(|baud| *baud != FRAMES_BAUD),
        }
    }

    /// The text of a file that [describes](Self::parse) this rig.
    ///
    /// # Errors
    /// Where a device's path is no text.
    pub fn to_toml(&self) -> Result<String, toml::ser::Error> {
        let nowhere = |device: &PathBuf| Spanned::new(0..0, device.clone());
        let line = |line: &Line| LineTable {
            device: nowhere(&line.device),
            baud: Some(Spanned::new(0..0, line.baud)),
        };
        let probe = match &self.probe {
            ProbeKind::ProbeRs { chip, selector } => ProbeTable {
                chip: Some(chip.clone()),
                selector: selector.clone(),
                emulated_port: None,
            },
            ProbeKind::Emulated(port) => ProbeTable {
                emulated_port: Some(port.number()),
                ..ProbeTable::default()
            },
        };
        let (camera, frames) = match &self.camera {
            Camera::Fitted => (CameraName::Fitted, None),
            Camera::Serial(frames) => (CameraName::Serial, Some(line(frames))),
        };
        let power = self.power_cycle.as_ref().map(|cycle| PowerTable {
            cycle: Spanned::new(0..0, cycle.clone()),
        });
        toml::to_string(&Description {
            board: self.board,
            camera: Spanned::new(0..0, camera),
            wiring: self.wiring.clone(),
            probe: Spanned::new(0..0, probe),
            link: line(&self.link),
            frames,
            power,
        })
    }
}

impl Description {
    fn check(self, file: &Path) -> Result<Rig, Mistake> {
        let link = self.link.check(LINK_BAUD)?;
        let camera = match (self.camera.get_ref(), self.frames) {
            (CameraName::Fitted, None) => Camera::Fitted,
            (CameraName::Serial, Some(frames)) => {
                let span = frames.device.span();
                let frames = frames.check(FRAMES_BAUD)?;
                if frames.device == link.device {
                    return Err((span, "link and frames are one device".to_owned()));
                }
                Camera::Serial(frames)
            }
            (CameraName::Fitted, Some(frames)) => {
                let reason = "a fitted camera has no [frames]: camera = \"serial\" has";
                return Err((frames.device.span(), reason.to_owned()));
            }
            (CameraName::Serial, None) => {
                let reason = "camera = \"serial\" needs a [frames] table with a device";
                return Err((self.camera.span(), reason.to_owned()));
            }
        };
        let power_cycle = match self.power.map(|power| power.cycle) {
            Some(cycle) if cycle.get_ref().is_empty() => {
                return Err((cycle.span(), "an empty command".to_owned()));
            }
            cycle => cycle.map(Spanned::into_inner),
        };
        let stem = file.file_stem().unwrap_or_default();
        Ok(Rig {
            name: stem.to_string_lossy().into_owned(),
            board: self.board,
            probe: check_probe(self.probe)?,
            link,
            camera,
            power_cycle,
            wiring: self.wiring,
        })
    }
}

fn check_probe(table: Spanned<ProbeTable>) -> Result<ProbeKind, Mistake> {
    let span = table.span();
    match table.into_inner() {
        ProbeTable {
            chip,
            selector,
            emulated_port: None,
        } => Ok(ProbeKind::ProbeRs {
            chip: chip.unwrap_or_else(|| CHIP.to_owned()),
            selector,
        }),
        ProbeTable {
            chip: None,
            selector: None,
            emulated_port: Some(port),
        } => match port.to_string().parse() {
            Ok(port) => Ok(ProbeKind::Emulated(port)),
            Err(error) => Err((span, format!("{error}"))),
        },
        ProbeTable { .. } => Err((
            span,
            "an emulated probe has neither chip nor selector".to_owned(),
        )),
    }
}

impl LineTable {
    fn check(self, default_baud: u32) -> Result<Line, Mistake> {
        let baud = match self.baud {
            Some(baud) if !BAUDS.contains(baud.get_ref()) => {
                let (least, most) = (BAUDS.start(), BAUDS.end());
                return Err((baud.span(), format!("not a rate of {least} to {most} baud")));
            }
            Some(baud) => baud.into_inner(),
            None => default_baud,
        };
        Ok(Line {
            device: self.device.into_inner(),
            baud,
        })
    }
}

/// The file that a name stands for.
fn find(name: &str) -> Result<PathBuf, RigError> {
    let path = Path::new(name);
    let tried = if path.extension().is_some() {
        vec![path.to_owned()]
    } else {
        let file = format!("{name}.toml");
        let examples = image::workspace_root().map(|root| root.join("hil/rigs").join(&file));
        [Path::new("rigs").join(&file)]
            .into_iter()
            .chain(examples.ok())
            .collect()
    };
    tried
        .iter()
        .find(|path| path.exists())
        .cloned()
        .ok_or_else(|| RigError::Unknown {
            name: name.to_owned(),
            tried,
        })
}

impl From<BoardName> for frames::BoardName {
    fn from(board: BoardName) -> Self {
        match board {
            BoardName::Flight => Self::Flight,
            BoardName::Discovery => Self::Discovery,
        }
    }
}

impl From<frames::BoardName> for BoardName {
    fn from(board: frames::BoardName) -> Self {
        match board {
            frames::BoardName::Flight => Self::Flight,
            frames::BoardName::Discovery => Self::Discovery,
        }
    }
}
