//! What can be wrong with a world.

use std::ops::Range;
use std::path::PathBuf;

use super::WORLD_NAMES;

/// No world has this name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no world named `{0}`; there are: {known}", known = WORLD_NAMES.join(", "))]
pub struct UnknownWorld(pub String);

/// A world that cannot be built.
#[derive(Debug, thiserror::Error)]
pub enum WorldError {
    /// There is no such world.
    #[error(transparent)]
    Unknown(#[from] UnknownWorld),
    /// The file cannot be read.
    #[error("{file}: cannot be read", file = .file.display())]
    Unreadable {
        /// The file.
        file: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The file says something that no world can be built from.
    #[error("{file}:{line}: {reason}", file = .file.display())]
    Bad {
        /// The file.
        file: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong there.
        reason: Reason,
    },
}

/// What is wrong with a line of a world's file.
#[derive(Debug, thiserror::Error)]
pub enum Reason {
    /// It is not TOML, or a key, a type or a number is not one that is known there.
    #[error("{0}")]
    Syntax(String),
    /// A surface, lamp or sky follows a light that is not there.
    #[error("there is no [[light]] named `{0}`")]
    UnknownLight(String),
    /// A light's times do not ascend.
    #[error("the times of a light must ascend, and there must be one at least")]
    TimesDoNotAscend,
    /// Two lights have one name, or there are too many.
    #[error("a [[light]] named `{0}` is there already, or there are more than {max}", max = super::scene::MAX_LIGHTS)]
    TooManyLights(String),
    /// A painter of pictures on something that has no flat face.
    #[error("`{0}` paints pictures for walls: a box, column or ball needs a material: {materials}", materials = super::paint::Painter::materials())]
    NotAMaterial(&'static str),
    /// A picture or material that is too large.
    #[error("a picture of {texels} texels: {max} at most; a larger `texel_m` makes it smaller", max = super::build::MAX_TEXELS)]
    TooManyTexels {
        /// As described.
        texels: u64,
    },
    /// More solids than a scene holds.
    #[error("more than {max} things", max = super::build::MAX_SOLIDS)]
    TooManySolids,
    /// More things that move than a scene holds.
    #[error("more than {max} things that move", max = super::build::MAX_MOVERS)]
    TooManyMovers,
    /// A list has too few or too many entries.
    #[error("{what}: {needed}, not {found}")]
    WrongCount {
        /// Of what.
        what: &'static str,
        /// How many there must be.
        needed: &'static str,
        /// How many there are.
        found: usize,
    },
    /// Two things in one place, or none where one is needed.
    #[error("{0}")]
    Missing(&'static str),
    /// A direction or a panel without length.
    #[error("{0} has no length")]
    NoLength(&'static str),
    /// A panorama that cannot be read or decoded.
    #[error("panorama {file}: {source}", file = .file.display())]
    Panorama {
        /// The picture's file.
        file: PathBuf,
        /// Why.
        source: image::ImageError,
    },
    /// A panorama without light within 45 degrees of the horizon.
    #[error("the panorama is black, or has a pixel that is no number")]
    DarkPanorama,
}

/// A reason and the bytes of the text that it is about.
#[derive(Debug)]
pub struct Mistake {
    /// From the text's start.
    pub span: Range<usize>,
    /// What is wrong there.
    pub reason: Reason,
}

impl Reason {
    /// This reason, about `span`.
    pub fn at(self, span: Range<usize>) -> Mistake {
        Mistake { span, reason: self }
    }
}
