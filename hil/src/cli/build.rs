//! `hil build`: the firmware's images.

use clap::{Args, ValueEnum};
use frames::{BoardName, ImageKind};

use super::Failure;
use super::console::Console;
use crate::image::{self, Variant};

/// Options of `hil build`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
        hil build                               the image that flies\n  \
        hil build --kind rig                    one that takes frames over serial (USART3, PD8 and PD9)\n  \
        hil build --kind rig --board discovery --baud 921600\n\n\
        Prints the image's path. Exit code 0: it is there. 2: it could not be built.")]
pub struct Arguments {
    /// What the image may do
    #[arg(long, value_enum, default_value_t = Kind::Flight)]
    kind: Kind,
    /// Whose pins it uses
    #[arg(long, value_enum, default_value_t = Board::Flight)]
    board: Board,
    /// Rate at which a rig image takes frames, baud [default: 3000000]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=5_250_000))]
    baud: Option<u32>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Kind {
    /// The camera alone gives frames
    Flight,
    /// A host may send frames in the camera's place
    Rig,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Board {
    /// The board that flies
    Flight,
    /// An STM32F4DISCOVERY
    Discovery,
}

impl Arguments {
    fn variant(&self) -> Result<Variant, Failure> {
        let kind = match self.kind {
            Kind::Flight => ImageKind::Flight,
            Kind::Rig => ImageKind::Rig,
        };
        if self.baud.is_some() && kind == ImageKind::Flight {
            return Err("--baud is the rate of a rig image: a flight image takes no frames".into());
        }
        let board = match self.board {
            Board::Flight => BoardName::Flight,
            Board::Discovery => BoardName::Discovery,
        };
        Ok(Variant {
            kind,
            board,
            baud: self.baud,
        })
    }
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let variant = arguments.variant()?;
    let image = image::build_variant(&variant, &|line| console.status("Firmware", line))?;
    console.result(&image.display().to_string())?;
    Ok(true)
}
