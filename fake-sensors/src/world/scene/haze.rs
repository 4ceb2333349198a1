//! What is left of small solids far away: a ball that hides a part of what is behind it.

use nalgebra::Vector3;

use super::Material;
use super::solid::{Form, Solid};

/// Solids in a box, as a pixel sees them that is not much narrower than the box: evenly spread over
/// the ball that fills it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Haze {
    /// Share of the ball's outline that they cover, seen from the side.
    pub cover: f32,
    /// Their mean radiance in full light.
    pub radiance: f32,
    /// Index of the light that they follow.
    pub light: u8,
}

impl Haze {
    /// Sums up `solids` in a box of half lengths `half`. Each covers its own share of the outline,
    /// wherever it stands: shares multiply, as they do where pixels see the solids one by one. `None`
    /// if the solids do not all follow one light, or some shine.
    pub fn of(solids: &[Solid], half: &Vector3<f32>, materials: &[Material]) -> Option<Self> {
        let outline = side(half) * fill(Form::Ball);
        let light = material(solids.first()?, materials)?.light;
        let (mut through, mut area, mut radiance) = (1.0, 0.0, 0.0);
        for solid in solids {
            let material = material(solid, materials)?;
            if material.shines || material.light != light {
                return None;
            }
            let own = side(&solid.half) * fill(solid.form);
            through *= 1.0 - (own / outline).min(1.0);
            area += own;
            radiance += own * material.gain * material.tile.mean();
        }
        Some(Self {
            cover: 1.0 - through,
            radiance: radiance / area,
            light,
        })
    }
}

fn material<'a>(solid: &Solid, materials: &'a [Material]) -> Option<&'a Material> {
    materials.get(usize::from(solid.material))
}

/// Area of a box's outline from the side, between that along x and that along y.
fn side(half: &Vector3<f32>) -> f32 {
    2.0 * (half.x + half.y) * half.z
}

/// Share of its box's outline that a form fills.
fn fill(form: Form) -> f32 {
    match form {
        Form::Block(_) | Form::Column => 1.0,
        Form::Ball => core::f32::consts::FRAC_PI_4,
    }
}
