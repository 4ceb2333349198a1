//! Walks through a rig and says what is right and what is missing.

use std::fmt;
use std::time::Duration;

use frames::{ImageKind, PROTOCOL};
use serde::Serialize;

use super::file::{BoardName, Camera, Line, Rig};
use super::probe;
use super::voices::{Heard, Voices, listen};

/// How long a board may take to answer; one that runs does at once.
const ANSWER: Duration = Duration::from_millis(1_000);

/// What was found at one place.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// Where.
    pub place: &'static str,
    /// Whether it is as it should be.
    pub right: bool,
    /// What was found, or what to do about it.
    pub text: String,
}

/// The whole walk.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Findings {
    /// The rig's name.
    pub rig: String,
    /// In the order of the walk.
    pub findings: Vec<Finding>,
}

impl Findings {
    /// Whether the rig can be flown.
    pub fn right(&self) -> bool {
        self.findings.iter().all(|finding| finding.right)
    }

    /// What keeps it from being flown, a line each.
    pub fn wrong(&self) -> String {
        let wrong = self.findings.iter().filter(|finding| !finding.right);
        let lines: Vec<_> = wrong
            .map(|finding| format!("{}: {}", finding.place, finding.text))
            .collect();
        lines.join("\n")
    }

    fn add(&mut self, place: &'static str, found: Result<String, String>) {
        let right = found.is_ok();
        let text = found.unwrap_or_else(|text| text);
        self.findings.push(Finding { place, right, text });
    }
}

impl fmt::Display for Findings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for finding in &self.findings {
            let mark = if finding.right { "ok" } else { "MISSING" };
            let text = finding
                .text
                .trim_end()
                .replace('\n', "\n                    ");
            writeln!(f, "{mark:>8}  {:<8}  {text}", finding.place)?;
        }
        let verdict = if self.right() {
            "the rig is ready"
        } else {
            "the rig is NOT ready"
        };
        write!(f, "{verdict}: {}", self.rig)
    }
}

/// Walks through a rig: probe, power switch, link, frames. Takes 3 s where nobody answers.
pub fn check(rig: &Rig) -> Findings {
    let mut findings = Findings {
        rig: rig.name.clone(),
        findings: Vec::new(),
    };
    let probe = probe::of(rig).find().map_err(|error| error.to_string());
    findings.add("probe", probe);
    if let Some(cycle) = &rig.power_cycle {
        findings.add("power", power(cycle));
    }
    lines(rig, &mut findings);
    findings
}

/// Whether the command that switches the power is there; it is not tried.
fn power(cycle: &[String]) -> Result<String, String> {
    let program = cycle.first().map(String::as_str).unwrap_or_default();
    let found = std::env::var_os("PATH").and_then(|path| {
        let mut places = std::env::split_paths(&path).map(|folder| folder.join(program));
        places.find(|place| place.is_file())
    });
    match found {
        Some(place) => Ok(place.display().to_string()),
        None => Err(format!("there is no program `{program}` (power.cycle)")),
    }
}

/// Both lines, of which the second is none where the camera is fitted.
fn lines(rig: &Rig, findings: &mut Findings) {
    let frames = match &rig.camera {
        Camera::Serial(frames) => Some(frames),
        Camera::Fitted => None,
    };
    let link_line = open("link", &rig.link, findings);
    let frames_line = frames.map(|frames| open("frames", frames, findings));
    match (link_line, frames_line) {
        (Some(mut link), None) => {
            listen(&mut [&mut link], ANSWER, |heard| heard[0].link);
            findings.add("link", judge_link(link.heard(), &rig.link));
        }
        (Some(mut link), Some(Some(mut frames))) => {
            let answered = |heard: &[&Heard]| heard.iter().all(|heard| heard.answered());
            listen(&mut [&mut link, &mut frames], ANSWER, answered);
            both(rig, link, frames, findings);
        }
        // The one that is there is not worth a word as long as the other one is not.
        (None, _) | (_, Some(None)) => {}
    }
}

fn open(place: &'static str, line: &Line, findings: &mut Findings) -> Option<Voices> {
    match Voices::open(line) {
        Ok(voices) => Some(voices),
        Err(error) => {
            findings.add(place, Err(format!("{error}: is the adapter plugged in?")));
            None
        }
    }
}

impl Heard {
    fn answered(&self) -> bool {
        self.link || self.identity.is_some()
    }
}

/// Judges a pair of lines that were listened to.
fn both(rig: &Rig, link: Voices, frames: Voices, findings: &mut Findings) {
    let Camera::Serial(frames_line) = &rig.camera else {
        return;
    };
    let mut heard = [link.heard().clone(), frames.heard().clone()];
    drop((link, frames));
    let silent = heard.iter().all(|heard| !heard.answered());
    if silent && rig.link.baud != frames_line.baud {
        // In each other's place they are at each other's rate, too.
        heard = crossed(&rig.link, frames_line).unwrap_or(heard);
    }
    let [link, frames] = &heard;
    if link.identity.is_some() || frames.link {
        let text = |device: &Line, other: &str| {
            let device = device.device.display();
            format!("{device} is the board's {other}: the two devices are swapped")
        };
        findings.add("link", Err(text(&rig.link, "frames port")));
        findings.add("frames", Err(text(frames_line, "link")));
        return;
    }
    findings.add("link", judge_link(link, &rig.link));
    findings.add("frames", judge_frames(frames, frames_line, rig.board));
}

/// What is heard with the rates exchanged.
fn crossed(link: &Line, frames: &Line) -> Option<[Heard; 2]> {
    let at = |line: &Line, baud| Line {
        device: line.device.clone(),
        baud,
    };
    let mut link_line = Voices::open(&at(link, frames.baud)).ok()?;
    let mut frames_line = Voices::open(&at(frames, link.baud)).ok()?;
    listen(&mut [&mut link_line, &mut frames_line], ANSWER, |heard| {
        heard.iter().all(|heard| heard.answered())
    });
    Some([link_line.heard().clone(), frames_line.heard().clone()])
}

fn judge_link(heard: &Heard, line: &Line) -> Result<String, String> {
    if heard.link {
        return Ok(format!(
            "{} answers at {} baud",
            line.device.display(),
            line.baud
        ));
    }
    Err(silence(heard, line, "the board's PA3", "PA2"))
}

fn judge_frames(heard: &Heard, line: &Line, board: BoardName) -> Result<String, String> {
    let Some(identity) = &heard.identity else {
        return Err(silence(heard, line, "the board's PD9", "PD8")
            + "; a flight image never answers here: `hil flash --rig` puts a rig image on it");
    };
    if identity.protocol != PROTOCOL {
        return Err(format!(
            "the image speaks protocol {} and this rig {PROTOCOL}: `hil flash --rig` puts one of this \
             checkout on it",
            identity.protocol
        ));
    }
    if identity.kind != ImageKind::Rig {
        return Err("the image is none for a rig: `hil flash --rig`".to_owned());
    }
    if identity.board != board.into() {
        return Err(format!(
            "the image is for the board `{}`, the rig's file says `{}`",
            identity.board.name(),
            frames::BoardName::from(board).name()
        ));
    }
    Ok(format!(
        "{} answers at {} baud: version {}, rig image for `{}`, frames of {} x {}",
        line.device.display(),
        line.baud,
        identity.version(),
        identity.board.name(),
        identity.shape.width,
        identity.shape.height
    ))
}

/// A line on which nobody answers.
fn silence(heard: &Heard, line: &Line, receive: &str, transmit: &str) -> String {
    let device = line.device.display();
    if let Some(how) = &heard.lost {
        return format!("{device} went away: {how}");
    }
    if heard.echo {
        return format!("{device} hears itself: its TX and RX are connected");
    }
    if heard.bytes > 0 {
        return format!(
            "{} bytes came from {device}, and none of it is the board's: is the rate right ({} baud)?",
            heard.bytes, line.baud
        );
    }
    format!(
        "nobody answers on {device}: is the board powered, and are TX to {receive}, RX to {transmit} \
         and ground connected?"
    )
}
