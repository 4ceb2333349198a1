//! `hil info`: what is on a rig's board.

use clap::Args;
use serde::Serialize;

use super::Failure;
use super::console::Console;
use super::rig::RigArgument;
use crate::rig::info::{Info, info};
use crate::rig::{in_words, probe};

/// Options of `hil info`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil info --rig discovery                what the image in the board's flash says of itself\n  \
    hil info --rig discovery --json\n\n\
    Exit code 0: an image of this project is on the board. 1: another one, or none. 2: nobody knows.")]
pub struct Arguments {
    #[command(flatten)]
    rig: RigArgument,
    /// Ends with one JSON object on stdout: version, kind, board, protocol, lens (all null where the
    /// board has no image of this project), frames (null where nobody counts them)
    #[arg(long)]
    json: bool,
}

/// For scripts.
#[derive(Debug, Serialize)]
struct Json {
    version: Option<String>,
    kind: Option<&'static str>,
    board: Option<&'static str>,
    protocol: Option<u16>,
    lens: Option<String>,
    frames: Option<[u32; 6]>,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let rig = arguments.rig.open()?;
    let mut probe = probe::of(&rig);
    console.status("Probe", &probe.find()?);
    let info = info(&rig, probe.as_mut())?;
    if arguments.json {
        console.result(&serde_json::to_string(&json(&info))?)?;
    } else {
        console.result(&text(&info))?;
    }
    Ok(info.identity.is_some())
}

fn json(info: &Info) -> Json {
    let identity = info.identity.as_ref();
    Json {
        version: identity.map(|identity| identity.version().to_owned()),
        kind: identity.map(|identity| identity.kind.name()),
        board: identity.map(|identity| identity.board.name()),
        protocol: identity.map(|identity| identity.protocol),
        lens: info.lens.clone(),
        frames: info
            .frames
            .map(|c| [c.whole, c.torn, c.late, c.repeated, c.busy, c.corrupt]),
    }
}

fn text(info: &Info) -> String {
    let mut lines = Vec::new();
    let mut row = |name: &str, value: String| lines.push(format!("{name:<14}{value}"));
    match &info.identity {
        None => row("image", "none of this project".to_owned()),
        Some(identity) => row("image", in_words(identity)),
    }
    if let Some(lens) = &info.lens {
        row("lens record", lens.clone());
    }
    if let Some(c) = &info.frames {
        row(
            "frames",
            format!(
                "{} whole, {} torn, {} late, {} repeated, {} without a buffer; {} damaged records",
                c.whole, c.torn, c.late, c.repeated, c.busy, c.corrupt
            ),
        );
    }
    lines.join("\n")
}
