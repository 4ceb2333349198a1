//! What grows: trees, bushes, rows of plants.

use std::ops::Range;

use nalgebra::Vector3;
use toml::Spanned;

use super::room::Spot;
use super::{Builder, MAX_SOLIDS};
use crate::random::Normal;
use crate::world::Structure;
use crate::world::description::quantity::{Length, metres};
use crate::world::description::things::{Grove, PlantRow};
use crate::world::error::{Mistake, Reason};
use crate::world::paint::{Painter, between};
use crate::world::scene::solid::{Form, Solid};
use crate::world::scene::{Material, STEADY};

/// Trunks further than this from the start of the routes are not on the plan, in metres.
const PLAN_REACH_M: f32 = 12.0;
/// Nothing grows closer than this to a glade, in metres.
const GLADE_MARGIN_M: f32 = 0.4;
/// How far the outline of a tree's or a bush's foliage strays, as a share of its size.
const RAGGED: f32 = 0.28;
/// The same of a plant, whose leaves are large beside it.
const LEAFY: f32 = 0.6;
/// Share of trees that are conifers, unless the file says otherwise.
const CONIFERS: f32 = 0.5;
/// Reflectance of the `leaves` material, on which brightness is relative.
const LEAVES: f32 = 0.2;
/// Shades of foliage: a plant takes one of them.
const SHADES: [f32; 4] = [0.45, 0.65, 0.85, 1.15];

/// Materials of a grove.
struct Greenery {
    bark: u16,
    leaves: [u16; 4],
}

impl Builder<'_> {
    /// Scatters trees and bushes.
    pub fn grove(&mut self, grove: &Spanned<Grove>) -> Result<(), Mistake> {
        let span = grove.span();
        let grove = grove.get_ref();
        let (from, to) = (metres(grove.from), metres(grove.to));
        let glades: Vec<[Spot; 2]> = grove.glades.iter().map(|glade| glade.map(metres)).collect();
        let greenery = self.greenery(1.0, &span)?;
        let conifers = grove.conifers.map_or(CONIFERS, |share| share.get());
        let mut noise = self.noise();
        for spot in scattered(&mut noise, from, to, grove.tree_area, &glades)
            .ok_or_else(|| Reason::TooManySolids.at(span.clone()))?
        {
            let tree = if (noise.uniform() as f32) < conifers {
                conifer(&mut noise, spot, &greenery)
            } else {
                broadleaf(&mut noise, spot, &greenery)
            };
            self.mark_trunk(spot, tree[0].half.x);
            for solid in tree {
                self.add_solid(solid, span.clone())?;
            }
        }
        let Some(bush_area) = grove.bush_area else {
            return Ok(());
        };
        let mut noise = self.noise();
        for spot in scattered(&mut noise, from, to, bush_area, &glades)
            .ok_or_else(|| Reason::TooManySolids.at(span.clone()))?
        {
            for solid in bush(&mut noise, spot, &greenery) {
                self.add_solid(solid, span.clone())?;
            }
        }
        Ok(())
    }

    /// Plants in a row, and copies of the row.
    pub fn plants(&mut self, row: &Spanned<PlantRow>) -> Result<(), Mistake> {
        let span = row.span();
        let row = row.get_ref();
        let leaves = row.leaves.map_or(LEAVES, |share| share.get()) / LEAVES;
        let greenery = self.greenery(leaves, &span)?;
        let (from, to) = (metres(row.from), metres(row.to));
        let (along, length_m) = super::room::direction(from, to);
        if from == to {
            return Err(Reason::NoLength("a row of plants").at(span));
        }
        let count = (length_m / row.spacing.get()) as usize + 1;
        if count > MAX_SOLIDS {
            return Err(Reason::TooManySolids.at(span));
        }
        let base_m = row.base.map_or(0.0, |base| base.get());
        for shift in self.shifts(row.repeat.as_ref(), &span)? {
            let mut noise = self.noise();
            let start = Vector3::new(from[0], from[1], base_m) + shift;
            for plant in 0..count {
                let foot = start + along * (plant as f32 * row.spacing.get());
                let size = [row.radius.get(), row.height.get()];
                for solid in plant_at(&mut noise, foot, size, &greenery) {
                    self.add_solid(solid, span.clone())?;
                }
            }
            let (start, end) = (start, start + along * length_m);
            self.add_line(Structure::Panel, [start.x, start.y], [end.x, end.y]);
        }
        Ok(())
    }

    fn greenery(&mut self, brightness: f32, span: &Range<usize>) -> Result<Greenery, Mistake> {
        let bark = self.growth(Painter::Bark, 1.0, span)?;
        let mut leaves = [0; 4];
        for (leaf, shade) in leaves.iter_mut().zip(SHADES) {
            *leaf = self.growth(Painter::Leaves, shade * brightness, span)?;
        }
        Ok(Greenery { bark, leaves })
    }

    fn growth(&mut self, painter: Painter, gain: f32, span: &Range<usize>) -> Result<u16, Mistake> {
        let tile = self
            .swatch(painter, None, None)
            .ok_or_else(|| Reason::NotAMaterial(painter.name()).at(span.clone()))?;
        let material = Material {
            tile,
            gain,
            light: STEADY,
            shines: false,
        };
        self.add_material(material, span.clone())
    }

    fn mark_trunk(&mut self, [x, y]: Spot, radius_m: f32) {
        if x * x + y * y < PLAN_REACH_M * PLAN_REACH_M {
            self.add_line(Structure::Panel, [x, y - radius_m], [x, y + radius_m]);
            self.add_line(Structure::Panel, [x - radius_m, y], [x + radius_m, y]);
        }
    }
}

/// One spot somewhere in each square of `area` square metres, but for those in a glade. `None` if
/// they are too many.
fn scattered(
    noise: &mut Normal,
    from: Spot,
    to: Spot,
    area: Length,
    glades: &[[Spot; 2]],
) -> Option<Vec<Spot>> {
    let edge_m = area.get().sqrt();
    let low = [0, 1].map(|axis| from[axis].min(to[axis]));
    let [rows, columns] = [0, 1].map(|axis| ((from[axis] - to[axis]).abs() / edge_m) as usize);
    if rows.saturating_mul(columns) > MAX_SOLIDS {
        return None;
    }
    let spots = (0..rows * columns).map(|index| {
        let mut along =
            |cell: usize, axis: usize| low[axis] + edge_m * (cell as f32 + noise.uniform() as f32);
        [along(index / columns, 0), along(index % columns, 1)]
    });
    let free = |spot: &Spot| !glades.iter().any(|glade| is_within(spot, glade));
    Some(spots.filter(free).collect())
}

fn is_within(spot: &Spot, [one, other]: &[Spot; 2]) -> bool {
    (0..2).all(|axis| {
        let low = one[axis].min(other[axis]) - GLADE_MARGIN_M;
        let high = one[axis].max(other[axis]) + GLADE_MARGIN_M;
        (low..high).contains(&spot[axis])
    })
}

/// A trunk with three tiers of branches, each narrower than the one below.
fn conifer(noise: &mut Normal, spot: Spot, greenery: &Greenery) -> Vec<Solid> {
    const TIERS: usize = 3;
    let height_m = between(noise, 9.0, 20.0);
    let bare_m = between(noise, 0.08, 0.35) * height_m;
    let reach_m = between(noise, 0.12, 0.17) * height_m;
    let leaves = pick(noise, greenery);
    let mut tree = vec![trunk(spot, 0.012 * height_m, 0.9 * height_m, greenery)];
    let tier_m = (height_m - bare_m) / TIERS as f32;
    for tier in 0..TIERS {
        let share = 1.0 - tier as f32 / TIERS as f32;
        let middle_m = bare_m + tier_m * (tier as f32 + 0.5);
        let half = [reach_m * (0.25 + 0.75 * share), 0.75 * tier_m];
        tree.push(foliage([spot[0], spot[1], middle_m], half, leaves));
    }
    tree
}

/// A trunk under a crown of three parts.
fn broadleaf(noise: &mut Normal, spot: Spot, greenery: &Greenery) -> Vec<Solid> {
    let height_m = between(noise, 8.0, 16.0);
    let bare_m = between(noise, 0.25, 0.4) * height_m;
    let radius_m = between(noise, 0.1, 0.24);
    let reach_m = between(noise, 0.16, 0.24) * height_m;
    let leaves = pick(noise, greenery);
    let mut tree = vec![trunk(spot, radius_m, 0.8 * height_m, greenery)];
    for part in 0..3 {
        let share = part as f32 / 2.0;
        let stray = [0, 1].map(|_| between(noise, -0.5, 0.5) * reach_m);
        let middle_m = bare_m + (height_m - bare_m) * (0.3 + 0.5 * share);
        let width_m = reach_m * between(noise, 0.6, 0.9) * (1.1 - 0.4 * share);
        tree.push(foliage(
            [spot[0] + stray[0], spot[1] + stray[1], middle_m],
            [width_m, 0.8 * width_m],
            leaves,
        ));
    }
    tree
}

/// Two or three clumps of leaves on the ground.
fn bush(noise: &mut Normal, spot: Spot, greenery: &Greenery) -> Vec<Solid> {
    let clumps = 2 + (2.0 * noise.uniform()) as usize;
    let leaves = pick(noise, greenery);
    (0..clumps)
        .map(|_| {
            let radius_m = between(noise, 0.25, 0.8);
            let [x, y] = [0, 1].map(|axis| spot[axis] + between(noise, -0.5, 0.5));
            let high_m = radius_m * between(noise, 0.6, 1.1);
            foliage([x, y, 0.6 * high_m], [radius_m, high_m], leaves)
        })
        .collect()
}

/// A plant: broad below, narrower and lighter above.
fn plant_at(
    noise: &mut Normal,
    foot: Vector3<f32>,
    [radius_m, height_m]: [f32; 2],
    greenery: &Greenery,
) -> [Solid; 2] {
    let size = between(noise, 0.75, 1.15);
    let (radius_m, height_m) = (size * radius_m, size * height_m);
    let [x, y] = [foot.x, foot.y].map(|at| at + between(noise, -0.15, 0.15) * radius_m);
    let leaves = pick(noise, greenery);
    let low = foliage(
        [x, y, foot.z + 0.35 * height_m],
        [radius_m, 0.38 * height_m],
        leaves,
    );
    let high = foliage(
        [x, y, foot.z + 0.72 * height_m],
        [0.65 * radius_m, 0.28 * height_m],
        pick(noise, greenery),
    );
    [low, high].map(|part| Solid {
        ragged: LEAFY,
        ..part
    })
}

fn trunk([x, y]: Spot, radius_m: f32, height_m: f32, greenery: &Greenery) -> Solid {
    Solid {
        centre: Vector3::new(x, y, 0.5 * height_m),
        half: Vector3::new(radius_m, radius_m, 0.5 * height_m),
        form: Form::Column,
        ragged: 0.0,
        material: greenery.bark,
    }
}

fn foliage(centre: [f32; 3], [radius_m, half_m]: [f32; 2], material: u16) -> Solid {
    Solid {
        centre: Vector3::from(centre),
        half: Vector3::new(radius_m, radius_m, half_m),
        form: Form::Ball,
        ragged: RAGGED,
        material,
    }
}

fn pick(noise: &mut Normal, greenery: &Greenery) -> u16 {
    // uniform() is below 1.
    greenery.leaves[(4.0 * noise.uniform()) as usize]
}
