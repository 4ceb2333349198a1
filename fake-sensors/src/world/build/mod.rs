//! From a description to a scene.

mod grove;
mod room;
mod things;

use std::ops::Range;
use std::path::Path as FilePath;
use std::sync::Arc;

use toml::Spanned;

use super::description::Description;
use super::description::paint::Paint;
use super::description::things::Light;
use super::error::{Mistake, Reason};
use super::paint::{Painter, Tile};
use super::scene::bvh::Bvh;
use super::scene::haze::Haze;
use super::scene::light::Curve;
use super::scene::solid::Solid;
use super::scene::surface::Surface;
use super::scene::{Dome, MAX_LIGHTS, Material, Mover, STEADY, Scene};
use super::{PlanLine, Structure};
use crate::random::Normal;

/// Texels of all pictures of a world at most: 100 MB with their pyramids.
pub const MAX_TEXELS: u64 = 16_000_000;
/// Solids of a world at most: a square kilometre of forest.
pub const MAX_SOLIDS: usize = 200_000;
/// Things that move at most: each is asked for every ray.
pub const MAX_MOVERS: usize = 32;

/// Stream of the seed before the first that a texture is painted from: "pain" in ASCII, clear of the
/// streams that sensors take from the same seed.
const FIRST_STREAM: u64 = u64::from_be_bytes(*b"pain\0\0\0\0");

/// Where the files are that a description names.
#[derive(Clone, Copy, Debug)]
pub enum Files<'a> {
    /// In a folder.
    Folder(&'a FilePath),
    /// In this crate.
    BuiltIn,
}

/// A scene and its plan.
#[derive(Debug)]
pub struct Built {
    pub scene: Scene,
    pub plan: Vec<PlanLine>,
}

/// Builds what `description` says; `seed` fixes everything that it leaves open.
///
/// # Errors
/// The first [`Mistake`].
pub fn build(description: &Description, files: Files<'_>, seed: u64) -> Result<Built, Mistake> {
    let mut builder = Builder::new(description, seed)?;
    // The order decides which stream of the seed each thing is painted from.
    builder.enclosure(description, files)?;
    builder.things(description)?;
    for grove in &description.grove {
        builder.grove(grove)?;
    }
    for row in &description.plants {
        builder.plants(row)?;
    }
    Ok(builder.finish())
}

/// A material that has been painted.
#[derive(Debug)]
struct Swatch {
    painter: Painter,
    contrast: Option<f32>,
    edge_m: Option<f32>,
    tile: Arc<Tile>,
}

#[derive(Debug)]
struct Builder<'a> {
    seed: u64,
    stream: u64,
    texels: u64,
    light_names: Vec<&'a str>,
    lights: Vec<Curve>,
    swatches: Vec<Swatch>,
    materials: Vec<Material>,
    surfaces: Vec<Surface>,
    solids: Vec<Solid>,
    movers: Vec<Mover>,
    dome: Dome,
    plan: Vec<PlanLine>,
    sunlight: Option<super::scene::Sunlight>,
}

impl<'a> Builder<'a> {
    fn new(description: &'a Description, seed: u64) -> Result<Self, Mistake> {
        let mut builder = Self {
            seed,
            stream: FIRST_STREAM,
            texels: 0,
            light_names: Vec::new(),
            lights: Vec::new(),
            swatches: Vec::new(),
            materials: Vec::new(),
            surfaces: Vec::new(),
            solids: Vec::new(),
            movers: Vec::new(),
            dome: Dome::Nothing,
            plan: Vec::new(),
            sunlight: None,
        };
        for light in &description.light {
            builder.light(light)?;
        }
        Ok(builder)
    }

    fn finish(self) -> Built {
        let solids = Bvh::new(self.solids, |solids, half| {
            Haze::of(solids, half, &self.materials)
        });
        Built {
            scene: Scene {
                surfaces: self.surfaces,
                solids,
                movers: self.movers,
                materials: self.materials,
                dome: self.dome,
                sunlight: self.sunlight,
                lights: self.lights,
            },
            plan: self.plan,
        }
    }

    /// The next stream of the seed.
    fn noise(&mut self) -> Normal {
        self.stream += 1;
        Normal::new(self.seed, self.stream)
    }

    fn light(&mut self, light: &'a Light) -> Result<(), Mistake> {
        let name = light.name.get_ref().as_str();
        // One index is the steady light's.
        if self.light_names.contains(&name) || self.light_names.len() + 2 > MAX_LIGHTS {
            return Err(Reason::TooManyLights(name.to_owned()).at(light.name.span()));
        }
        let points = light.levels.get_ref().iter();
        let points = points.map(|(at, level)| (f64::from(at.get()), level.get()));
        let period_s = light.period_s.map(|period| f64::from(period.get()));
        let curve = Curve::new(points.collect(), period_s)
            .ok_or_else(|| Reason::TimesDoNotAscend.at(light.levels.span()))?;
        self.light_names.push(name);
        self.lights.push(curve);
        Ok(())
    }

    /// Index of the light `name`; of the steady one without a name.
    fn follow(&self, name: Option<&Spanned<String>>) -> Result<u8, Mistake> {
        let Some(name) = name else {
            return Ok(STEADY);
        };
        let place = self
            .light_names
            .iter()
            .position(|known| known == name.get_ref());
        // At most MAX_LIGHTS names: the index fits.
        place
            .map(|place| 1 + place as u8)
            .ok_or_else(|| Reason::UnknownLight(name.get_ref().clone()).at(name.span()))
    }

    /// Counts texels that are about to be painted.
    fn reserve_texels(&mut self, texels: u64, span: Range<usize>) -> Result<(), Mistake> {
        self.texels = self.texels.saturating_add(texels);
        if self.texels > MAX_TEXELS {
            return Err(Reason::TooManyTexels { texels }.at(span));
        }
        Ok(())
    }

    /// The tile of a material, painted once for all that look alike.
    fn tile(&mut self, paint: &Paint) -> Result<Arc<Tile>, Mistake> {
        let painter = *paint.painter.get_ref();
        let contrast = paint.contrast.map(|contrast| contrast.get());
        let edge_m = paint.tile_m.map(|edge| edge.get());
        self.swatch(painter, contrast, edge_m)
            .ok_or_else(|| Reason::NotAMaterial(painter.name()).at(paint.painter.span()))
    }

    /// The same by its parts; `None` from a painter of pictures.
    fn swatch(
        &mut self,
        painter: Painter,
        contrast: Option<f32>,
        edge_m: Option<f32>,
    ) -> Option<Arc<Tile>> {
        let alike = |swatch: &&Swatch| {
            (swatch.painter, swatch.contrast, swatch.edge_m) == (painter, contrast, edge_m)
        };
        if let Some(swatch) = self.swatches.iter().find(alike) {
            return Some(swatch.tile.clone());
        }
        let tile = Arc::new(painter.material(&mut self.noise(), contrast, edge_m)?);
        self.swatches.push(Swatch {
            painter,
            contrast,
            edge_m,
            tile: tile.clone(),
        });
        Some(tile)
    }

    /// Index of what `paint` makes of a solid, and how ragged that is.
    fn material(&mut self, paint: &Paint) -> Result<(u16, f32), Mistake> {
        let tile = self.tile(paint)?;
        let light = self.follow(paint.follows.as_ref())?;
        let material = Material {
            tile,
            gain: gain(paint),
            light,
            shines: false,
        };
        let ragged = paint.ragged.map_or(0.0, |ragged| ragged.get());
        let index = self.add_material(material, paint.painter.span())?;
        Ok((index, ragged))
    }

    fn add_material(&mut self, material: Material, span: Range<usize>) -> Result<u16, Mistake> {
        let index = u16::try_from(self.materials.len());
        self.materials.push(material);
        index.map_err(|_| Reason::TooManySolids.at(span))
    }

    fn add_solid(&mut self, solid: Solid, span: Range<usize>) -> Result<(), Mistake> {
        if self.solids.len() >= MAX_SOLIDS {
            return Err(Reason::TooManySolids.at(span));
        }
        self.solids.push(solid);
        Ok(())
    }

    fn add_line(&mut self, structure: Structure, from_m: [f32; 2], to_m: [f32; 2]) {
        self.plan.push(PlanLine {
            structure,
            from_m,
            to_m,
        });
    }
}

/// Factor on a material's reflectance: light and brightness.
fn gain(paint: &Paint) -> f32 {
    let factor =
        |level: Option<super::description::quantity::Level>| level.map_or(1.0, |x| x.get());
    factor(paint.light) * factor(paint.brightness)
}
