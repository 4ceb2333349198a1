//! Painters: named ways to draw textures from a seed.
//!
//! A *picture* is drawn for one surface, edge to edge; a *material* is a square that repeats, for
//! solids, grounds and plain walls. Nothing is photographed, so nothing has a licence.

mod arena;
mod canvas;
mod halls;
mod materials;
mod rooms;
mod texture;
mod tile;

use serde::Deserialize;

pub use canvas::{Area, Patch, Sheet, TEXEL_M};
pub use texture::Texture;
pub use tile::Tile;

use crate::random::Normal;
use canvas::Canvas;

/// A painter's name in a world's file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Painter {
    /// Picture: a side of the flight arena: canvases with landscapes, doors, windows above.
    ArenaWall,
    /// Picture: artificial grass.
    ArenaGrass,
    /// Picture: a dark roof with rows of lamps.
    ArenaRoof,
    /// Picture: a landscape printed on canvas.
    Canvas,
    /// Picture: a corridor's wall with doors, notices and a skirting.
    Doors,
    /// Picture: a bare plastered wall.
    Plaster,
    /// Picture: an office's inner wall: a door, shelves, posters, a white board.
    OfficeWall,
    /// Picture: a wall of windows with a view, blinds and radiators.
    Windows,
    /// Picture: a suspended ceiling with square lamps.
    OfficeCeiling,
    /// Picture: a ceiling with one row of long lamps.
    CorridorCeiling,
    /// Picture: a factory hall's wall: columns, gates, windows above, goods.
    HallWall,
    /// Picture: a hall's roof with trusses, skylights and lamps.
    HallRoof,
    /// Picture: a greenhouse's glass: frames, sky and what stands outside.
    GlassWall,
    /// Picture: a greenhouse's roof of glass.
    GlassRoof,
    /// Material: even, with a little noise.
    Plain,
    /// Material: carpet.
    Carpet,
    /// Material: concrete with joints and stains.
    Concrete,
    /// Material: boards.
    Wood,
    /// Material: bark.
    Bark,
    /// Material: leaves, light and dark.
    Leaves,
    /// Material: the floor of a forest, with light that falls through the leaves.
    ForestFloor,
    /// Material: soil and gravel.
    Soil,
    /// Material: cardboard boxes, stacked.
    Boxes,
}

/// How a painter is to paint.
#[derive(Clone, Debug)]
pub struct Look {
    /// Light on the surface, relative to the world's usual light.
    pub light: f32,
    /// Factor on the painter's own reflectance.
    pub brightness: f32,
    /// Log-contrast per octave; the painter's own without it.
    pub contrast: Option<f32>,
}

impl Painter {
    /// All painters of pictures, by name.
    const PICTURES: [(Self, &'static str); 14] = [
        (Self::ArenaWall, "arena-wall"),
        (Self::ArenaGrass, "arena-grass"),
        (Self::ArenaRoof, "arena-roof"),
        (Self::Canvas, "canvas"),
        (Self::Doors, "doors"),
        (Self::Plaster, "plaster"),
        (Self::OfficeWall, "office-wall"),
        (Self::Windows, "windows"),
        (Self::OfficeCeiling, "office-ceiling"),
        (Self::CorridorCeiling, "corridor-ceiling"),
        (Self::HallWall, "hall-wall"),
        (Self::HallRoof, "hall-roof"),
        (Self::GlassWall, "glass-wall"),
        (Self::GlassRoof, "glass-roof"),
    ];

    /// All painters of materials, by name.
    const MATERIALS: [(Self, &'static str); 9] = [
        (Self::Plain, "plain"),
        (Self::Carpet, "carpet"),
        (Self::Concrete, "concrete"),
        (Self::Wood, "wood"),
        (Self::Bark, "bark"),
        (Self::Leaves, "leaves"),
        (Self::ForestFloor, "forest-floor"),
        (Self::Soil, "soil"),
        (Self::Boxes, "boxes"),
    ];

    /// The names of the materials, for a message.
    pub fn materials() -> String {
        Self::MATERIALS.map(|(_, name)| name).join(", ")
    }

    /// Whether it paints a material.
    pub fn is_material(self) -> bool {
        Self::MATERIALS.iter().any(|(painter, _)| *painter == self)
    }

    /// A picture; `None` from a painter of materials.
    pub fn picture(
        self,
        noise: &mut Normal,
        sheet: &Sheet,
        look: &Look,
        sun: &[Patch],
    ) -> Option<Texture> {
        let paint: fn(&mut Normal, &Sheet, Option<f32>) -> Canvas = match self {
            Self::ArenaWall => arena::wall,
            Self::ArenaGrass => arena::grass,
            Self::ArenaRoof => arena::roof,
            Self::Canvas => arena::screen,
            Self::Doors => rooms::doors,
            Self::Plaster => rooms::plaster,
            Self::OfficeWall => rooms::office_wall,
            Self::Windows => rooms::windows,
            Self::OfficeCeiling => rooms::office_ceiling,
            Self::CorridorCeiling => rooms::corridor_ceiling,
            Self::HallWall => halls::wall,
            Self::HallRoof => halls::roof,
            Self::GlassWall => halls::glass_wall,
            Self::GlassRoof => halls::glass_roof,
            Self::Plain
            | Self::Carpet
            | Self::Concrete
            | Self::Wood
            | Self::Bark
            | Self::Leaves
            | Self::ForestFloor
            | Self::Soil
            | Self::Boxes => return None,
        };
        let canvas = paint(noise, sheet, look.contrast);
        Some(canvas.lit_by(look.light, look.brightness, sun))
    }

    /// A material that repeats after `edge_m` (the painter's own size without it); `None` from a
    /// painter of pictures.
    pub fn material(
        self,
        noise: &mut Normal,
        contrast: Option<f32>,
        edge_m: Option<f32>,
    ) -> Option<Tile> {
        let paint: fn(&mut Normal, Option<f32>) -> materials::Swatch = match self {
            Self::Plain => materials::plain,
            Self::Carpet => materials::carpet,
            Self::Concrete => materials::concrete,
            Self::Wood => materials::wood,
            Self::Bark => materials::bark,
            Self::Leaves => materials::leaves,
            Self::ForestFloor => materials::forest_floor,
            Self::Soil => materials::soil,
            Self::Boxes => materials::boxes,
            _ => return None,
        };
        Some(paint(noise, contrast).tile(edge_m))
    }

    /// Its name in a world's file.
    pub fn name(self) -> &'static str {
        let mut known = Self::PICTURES.iter().chain(&Self::MATERIALS);
        let known = known.find(|(painter, _)| *painter == self);
        known.map_or("", |(_, name)| name)
    }

    /// How far a sky is covered by clouds, 0..1: `share` of it by more than half.
    pub fn clouds(noise: &mut Normal, share: f32) -> Tile {
        materials::clouds(noise, share)
    }

    /// The outline of what stands on the horizon, as a factor on its height, times `radiance`.
    pub fn skyline(noise: &mut Normal, radiance: f32) -> Tile {
        materials::skyline(noise, radiance)
    }
}

/// A number in `low..high`.
pub fn between(noise: &mut Normal, low: f32, high: f32) -> f32 {
    low + (high - low) * noise.uniform() as f32
}
