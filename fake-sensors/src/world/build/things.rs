//! What stands, hangs and walks.

use std::f32::consts::PI;
use std::ops::Range;

use nalgebra::Vector3;
use toml::Spanned;

use super::Builder;
use super::room::{Spot, direction};
use crate::world::Structure;
use crate::world::description::Description;
use crate::world::description::quantity::{Coordinate, Degrees, metres};
use crate::world::description::things::{Ball, Block, Column, Lamp, Panel, Person, Repeat, Route};
use crate::world::error::{Mistake, Reason};
use crate::world::paint::Painter;
use crate::world::scene::motion::Path;
use crate::world::scene::solid::{Form, Solid};
use crate::world::scene::surface::Surface;
use crate::world::scene::{Material, Mover};

/// How tall people are, in metres.
const TALL_M: f32 = 1.75;
/// Reflectance of a jacket and of trousers.
const CLOTHES: [f32; 2] = [0.25, 0.1];
/// Reflectance of a face.
const SKIN: f32 = 0.35;
/// Reflectance of the `plain` material, on which brightness is relative.
const PLAIN: f32 = 0.3;
/// Thickness of a flat lamp in metres.
const LAMP_M: f32 = 0.04;

impl Builder<'_> {
    /// Panels, boxes, columns, balls, people and lamps.
    pub fn things(&mut self, description: &Description) -> Result<(), Mistake> {
        for panel in &description.panel {
            self.panels(panel)?;
        }
        for block in &description.block {
            self.block(block)?;
        }
        for column in &description.column {
            self.column(column)?;
        }
        for ball in &description.ball {
            self.ball(ball)?;
        }
        for person in &description.person {
            self.person(person)?;
        }
        for lamp in &description.lamp {
            self.lamp(lamp)?;
        }
        Ok(())
    }

    fn panels(&mut self, panel: &Spanned<Panel>) -> Result<(), Mistake> {
        let span = panel.span();
        let panel = panel.get_ref();
        let height_m = panel.height.get();
        let base_m = height(panel.base);
        let light = self.follow(panel.paint.follows.as_ref())?;
        if panel.through.len() < 2 {
            return Err(Reason::WrongCount {
                what: "ends of panels",
                needed: "two at least",
                found: panel.through.len(),
            }
            .at(span));
        }
        for ends in panel.through.windows(2) {
            let (from, to) = (metres(ends[0]), metres(ends[1]));
            if from == to {
                return Err(Reason::NoLength("a panel").at(span));
            }
            for (from, to) in [(from, to), (to, from)] {
                let (along, width_m) = direction(from, to);
                let skin = self.skin(&panel.paint, 1.0, [width_m, height_m])?;
                let corner = Vector3::new(from[0], from[1], base_m);
                let up = (Vector3::z(), height_m);
                self.surfaces
                    .push(Surface::new(corner, (along, width_m), up, skin, light));
            }
            self.add_line(Structure::Panel, from, to);
        }
        Ok(())
    }

    fn block(&mut self, block: &Spanned<Block>) -> Result<(), Mistake> {
        let span = block.span();
        let block = block.get_ref();
        let half = Vector3::from(block.size.map(|length| 0.5 * length.get()));
        let turn = turn(block.turn_deg);
        let form = Form::Block(turn);
        let base_m = height(block.base);
        let (material, ragged) = self.material(&block.paint)?;
        let [x, y] = metres(block.at);
        let solid = Solid {
            centre: Vector3::new(x, y, base_m + half.z),
            half,
            form,
            ragged,
            material,
        };
        self.copies(solid, block.repeat.as_ref(), block.route.as_ref(), &span)
    }

    fn column(&mut self, column: &Spanned<Column>) -> Result<(), Mistake> {
        let span = column.span();
        let column = column.get_ref();
        let (radius_m, half_m) = (column.radius.get(), 0.5 * column.height.get());
        let (material, ragged) = self.material(&column.paint)?;
        let [x, y] = metres(column.at);
        let solid = Solid {
            centre: Vector3::new(x, y, height(column.base) + half_m),
            half: Vector3::new(radius_m, radius_m, half_m),
            form: Form::Column,
            ragged,
            material,
        };
        self.copies(solid, column.repeat.as_ref(), column.route.as_ref(), &span)
    }

    fn ball(&mut self, ball: &Spanned<Ball>) -> Result<(), Mistake> {
        let span = ball.span();
        let ball = ball.get_ref();
        let [radius_m, half_m] = ball.radii.map(|length| length.get());
        let (material, ragged) = self.material(&ball.paint)?;
        let solid = Solid {
            centre: Vector3::from(metres(ball.at)),
            half: Vector3::new(radius_m, radius_m, half_m),
            form: Form::Ball,
            ragged,
            material,
        };
        self.copies(solid, ball.repeat.as_ref(), ball.route.as_ref(), &span)
    }

    /// A lamp shines on its own: its radiance is the same from all sides.
    fn lamp(&mut self, lamp: &Spanned<Lamp>) -> Result<(), Mistake> {
        let span = lamp.span();
        let lamp = lamp.get_ref();
        let (half, form) = match (lamp.size, lamp.radius) {
            (Some(size), None) => {
                let [x, y] = size.map(|length| 0.5 * length.get());
                (Vector3::new(x, y, 0.5 * LAMP_M), Form::Block([1.0, 0.0]))
            }
            (None, Some(radius)) => (Vector3::repeat(radius.get()), Form::Ball),
            _ => {
                let reason = Reason::Missing("a lamp has either a `size` or a `radius`");
                return Err(reason.at(span));
            }
        };
        let light = self.follow(lamp.follows.as_ref())?;
        let material = self.plain(lamp.radiance.get(), light, true, &span)?;
        let solid = Solid {
            centre: Vector3::from(metres(lamp.at)),
            half,
            form,
            ragged: 0.0,
            material,
        };
        self.copies(solid, lamp.repeat.as_ref(), None, &span)
    }

    /// Two legs, a trunk with two arms, and a head.
    fn person(&mut self, person: &Spanned<Person>) -> Result<(), Mistake> {
        let span = person.span();
        let person = person.get_ref();
        let scale = person.height.map_or(TALL_M, |height| height.get()) / TALL_M;
        let clothes = person
            .clothes
            .map_or(CLOTHES, |both| both.map(|share| share.get()));
        let steady = crate::world::scene::STEADY;
        let jacket = self.plain(clothes[0] / PLAIN, steady, false, &span)?;
        let trousers = self.plain(clothes[1] / PLAIN, steady, false, &span)?;
        let skin = self.plain(SKIN / PLAIN, steady, false, &span)?;
        let [x, y] = metres(person.at);
        let part = |form, at: [f32; 3], half: [f32; 3], material| Solid {
            centre: Vector3::new(x, y, 0.0) + scale * Vector3::from(at),
            half: scale * Vector3::from(half),
            form,
            ragged: 0.0,
            material,
        };
        let leg = [0.085, 0.085, 0.43];
        let arm = [0.055, 0.055, 0.32];
        let solids = vec![
            part(Form::Column, [0.1, 0.06, 0.43], leg, trousers),
            part(Form::Column, [-0.1, -0.06, 0.43], leg, trousers),
            part(Form::Ball, [0.0, 0.0, 1.15], [0.23, 0.23, 0.38], jacket),
            part(Form::Column, [0.16, 0.2, 1.1], arm, jacket),
            part(Form::Column, [-0.16, -0.2, 1.1], arm, jacket),
            part(Form::Ball, [0.0, 0.0, 1.62], [0.105, 0.105, 0.14], skin),
        ];
        self.place(solids, [x, y], person.route.as_ref(), &span)
    }

    /// A material without a description: even, of `gain` times the reflectance of `plain`.
    pub fn plain(
        &mut self,
        gain: f32,
        light: u8,
        shines: bool,
        span: &Range<usize>,
    ) -> Result<u16, Mistake> {
        let tile = self
            .swatch(Painter::Plain, None, None)
            .ok_or_else(|| Reason::NotAMaterial("plain").at(span.clone()))?;
        let material = Material {
            tile,
            gain,
            light,
            shines,
        };
        self.add_material(material, span.clone())
    }

    /// Places a solid and its copies.
    fn copies(
        &mut self,
        solid: Solid,
        repeat: Option<&Repeat>,
        route: Option<&Route>,
        span: &Range<usize>,
    ) -> Result<(), Mistake> {
        for shift in self.shifts(repeat, span)? {
            let centre = solid.centre + shift;
            let copy = Solid { centre, ..solid };
            self.outline(&copy);
            self.place(vec![copy], [centre.x, centre.y], route, span)?;
        }
        Ok(())
    }

    /// How far each copy is from the first.
    pub fn shifts(
        &mut self,
        repeat: Option<&Repeat>,
        span: &Range<usize>,
    ) -> Result<Vec<Vector3<f32>>, Mistake> {
        let Some(repeat) = repeat else {
            return Ok(vec![Vector3::zeros()]);
        };
        let axes = repeat.count.len();
        if axes != repeat.step.len() || !(1..=3).contains(&axes) {
            return Err(Reason::WrongCount {
                what: "numbers of a grid's `count` and of its `step`",
                needed: "the same, one to three",
                found: axes,
            }
            .at(span.clone()));
        }
        let counts: [usize; 3] =
            [0, 1, 2].map(|axis| repeat.count.get(axis).map_or(1, |count| count.get().into()));
        let steps: [f32; 3] =
            [0, 1, 2].map(|axis| repeat.step.get(axis).map_or(0.0, |step| step.get()));
        let total = counts.iter().product::<usize>();
        if total > super::MAX_SOLIDS {
            return Err(Reason::TooManySolids.at(span.clone()));
        }
        let jitter_m = repeat.jitter.map_or(0.0, |jitter| jitter.get());
        let mut noise = self.noise();
        let mut stray = || jitter_m * (2.0 * noise.uniform() as f32 - 1.0);
        Ok((0..total)
            .map(|index| {
                let x = index % counts[0];
                let y = index / counts[0] % counts[1];
                let z = index / (counts[0] * counts[1]);
                Vector3::new(
                    x as f32 * steps[0] + stray(),
                    y as f32 * steps[1] + stray(),
                    z as f32 * steps[2],
                )
            })
            .collect())
    }

    /// Places solids that stay together: where they are, or along a route from `start`.
    fn place(
        &mut self,
        solids: Vec<Solid>,
        start: Spot,
        route: Option<&Route>,
        span: &Range<usize>,
    ) -> Result<(), Mistake> {
        let Some(route) = route else {
            for solid in solids {
                self.add_solid(solid, span.clone())?;
            }
            return Ok(());
        };
        let places: Vec<Spot> = route
            .through
            .iter()
            .map(|place| {
                let [x, y] = metres(*place);
                [x - start[0], y - start[1]]
            })
            .collect();
        let ahead_s = route.ahead_s.map_or(0.0, |ahead| ahead.get());
        let path = Path::new(&places, route.speed.get(), ahead_s)
            .ok_or_else(|| Reason::NoLength("a route").at(span.clone()))?;
        if self.movers.len() >= super::MAX_MOVERS {
            return Err(Reason::TooManyMovers.at(span.clone()));
        }
        self.movers.push(Mover { path, solids });
        Ok(())
    }

    /// Draws what stands on the floor on the plan.
    fn outline(&mut self, solid: &Solid) {
        if solid.centre.z - solid.half.z > FLIGHT_M {
            return;
        }
        let (x, y) = (solid.half.x, solid.half.y);
        let corners = match solid.form {
            Form::Block(_) => [[x, y], [-x, y], [-x, -y], [x, -y]],
            Form::Column | Form::Ball => [[x, 0.0], [0.0, y], [-x, 0.0], [0.0, -y]],
        };
        let [cos, sin] = match solid.form {
            Form::Block(turn) => turn,
            Form::Column | Form::Ball => [1.0, 0.0],
        };
        let corners = corners.map(|[u, v]| {
            [
                solid.centre.x + cos * u - sin * v,
                solid.centre.y + sin * u + cos * v,
            ]
        });
        for side in 0..4 {
            self.add_line(Structure::Panel, corners[side], corners[(side + 1) % 4]);
        }
    }
}

/// What begins higher than this above the floor, in metres, is no obstacle on the plan.
const FLIGHT_M: f32 = 1.5;

fn height(base: Option<Coordinate>) -> f32 {
    base.map_or(0.0, Coordinate::get)
}

/// Cosine and sine of a turn.
fn turn(degrees: Option<Degrees>) -> [f32; 2] {
    degrees.map_or([1.0, 0.0], |turn| {
        let (sin, cos) = libm::sincosf(turn.get() * (PI / 180.0));
        [cos, sin]
    })
}
