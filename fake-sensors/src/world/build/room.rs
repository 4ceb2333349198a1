//! What encloses a world: room, ground, sky, panorama.

use std::f32::consts::PI;
use std::ops::Range;
use std::sync::Arc;

use nalgebra::Vector3;
use toml::Spanned;

use super::{Builder, Files, gain};
use crate::world::Structure;
use crate::world::description::Description;
use crate::world::description::paint::{Paint, SunPatch};
use crate::world::description::quantity::metres;
use crate::world::description::room::{Ground, Panorama, Room, Sky, Sun};
use crate::world::error::{Mistake, Reason};
use crate::world::library;
use crate::world::paint::{Area, Look, Painter, Patch, Sheet, TEXEL_M};
use crate::world::scene::panorama::Projection;
use crate::world::scene::surface::{Skin, Surface};
use crate::world::scene::{Dome, Sunlight, panorama, sky};

/// Half the edge of ground without end, in metres.
const GROUND_REACH_M: f32 = 5_000.0;
/// Mean radiance of a panorama near the horizon, unless the file says otherwise: a grey room, for
/// which the camera's usual shutter is made.
const GREY_ROOM: f32 = 0.22;
/// Reflectance-like radiance of a skyline unless the file says otherwise.
const FAR: f32 = 0.15;

/// A point on the floor: x north, y west, in metres.
pub type Spot = [f32; 2];

impl Builder<'_> {
    /// Room, ground, sky, panorama and sun.
    pub fn enclosure(
        &mut self,
        description: &Description,
        files: Files<'_>,
    ) -> Result<(), Mistake> {
        if let Some(sun) = &description.sun {
            self.sunlight = Some(sunlight(sun)?);
        }
        let mut projection = None;
        if let Some(panorama) = &description.panorama {
            projection = self.panorama(panorama, files)?;
        }
        if let Some(room) = &description.room {
            self.room(room, projection)?;
        }
        if let Some(ground) = &description.ground {
            self.ground(ground)?;
        }
        if let Some(sky) = &description.sky {
            self.sky(sky)?;
        }
        Ok(())
    }

    fn room(
        &mut self,
        room: &Spanned<Room>,
        projection: Option<(Arc<Projection>, u8)>,
    ) -> Result<(), Mistake> {
        let span = room.span();
        let room = room.get_ref();
        let corner = metres(room.corner);
        let size = room.size.map(|length| length.get());
        let height_m = room.height.get();
        let [floor, ceiling] = [(&room.floor, 0.0), (&room.ceiling, height_m)]
            .map(|(paint, at_m)| (paint.as_ref(), Vector3::new(corner[0], corner[1], at_m)));
        let (x, y) = (Vector3::x(), Vector3::y());
        let shell = Shell { projection, span };
        self.side(floor.0, 1.0, floor.1, (x, size[0]), (y, size[1]), &shell)?;
        self.side(
            ceiling.0,
            1.0,
            ceiling.1,
            (y, size[1]),
            (x, size[0]),
            &shell,
        )?;

        let paints = match &room.walls[..] {
            [] => [None; 4],
            [all] => [Some(all); 4],
            [north, east, south, west] => [north, east, south, west].map(Some),
            others => {
                return Err(Reason::WrongCount {
                    what: "walls of a room",
                    needed: "one for all, or north, east, south and west",
                    found: others.len(),
                }
                .at(shell.span));
            }
        };
        let daylight = room.daylight.map(|sides| sides.map(|level| level.get()));
        let daylight_from = daylight.map_or(0, |_| (4.0 * self.noise().uniform()) as usize);
        for (side, (from, to)) in walls(corner, size).into_iter().enumerate() {
            let light = daylight.map_or(1.0, |daylight| daylight[(side + daylight_from) % 4]);
            let (along, width_m) = direction(from, to);
            let foot = Vector3::new(from[0], from[1], 0.0);
            let up = (Vector3::z(), height_m);
            self.side(paints[side], light, foot, (along, width_m), up, &shell)?;
            self.add_line(Structure::Wall, from, to);
        }
        Ok(())
    }

    /// One side of a room: painted, or with the panorama on it.
    fn side(
        &mut self,
        paint: Option<&Paint>,
        light: f32,
        corner: Vector3<f32>,
        u: (Vector3<f32>, f32),
        v: (Vector3<f32>, f32),
        shell: &Shell,
    ) -> Result<(), Mistake> {
        let (skin, light) = match (paint, &shell.projection) {
            (Some(paint), _) => (
                self.skin(paint, light, [u.1, v.1])?,
                self.follow(paint.follows.as_ref())?,
            ),
            (None, Some((projection, light))) => (Skin::Projected(projection.clone()), *light),
            (None, None) => {
                return Err(Reason::Missing(
                    "a room needs floor, ceiling and walls, or a [panorama] with an `eye`",
                )
                .at(shell.span.clone()));
            }
        };
        self.surfaces.push(Surface::new(corner, u, v, skin, light));
        Ok(())
    }

    /// What `paint` makes of a rectangle of `size` metres under `light`.
    pub fn skin(&mut self, paint: &Paint, light: f32, size: [f32; 2]) -> Result<Skin, Mistake> {
        let painter: Painter = *paint.painter.get_ref();
        if painter.is_material() {
            return Ok(Skin::Material(self.tile(paint)?, light * gain(paint)));
        }
        let sheet = Sheet {
            width_m: size[0],
            height_m: size[1],
            texel_m: paint.texel_m.map_or(TEXEL_M, |edge| edge.get()),
        };
        let span = paint.painter.span();
        let texels = sheet.texels().map(|count| count as u64);
        self.reserve_texels(texels[0].saturating_mul(texels[1]), span.clone())?;
        let look = Look {
            light: light * paint.light.map_or(1.0, |level| level.get()),
            brightness: paint.brightness.map_or(1.0, |level| level.get()),
            contrast: paint.contrast.map(|contrast| contrast.get()),
        };
        let sun: Vec<Patch> = paint.sun.iter().map(patch).collect();
        let picture = painter.picture(&mut self.noise(), &sheet, &look, &sun);
        // Every painter that paints no material paints pictures.
        picture
            .map(Skin::Picture)
            .ok_or_else(|| Reason::NotAMaterial(painter.name()).at(span))
    }

    fn ground(&mut self, ground: &Ground) -> Result<(), Mistake> {
        let paint = &ground.paint;
        let skin = Skin::Material(self.tile(paint)?, gain(paint));
        let light = self.follow(paint.follows.as_ref())?;
        let corner = Vector3::new(-GROUND_REACH_M, -GROUND_REACH_M, 0.0);
        let edge_m = 2.0 * GROUND_REACH_M;
        let (u, v) = ((Vector3::x(), edge_m), (Vector3::y(), edge_m));
        self.surfaces.push(Surface::new(corner, u, v, skin, light));
        Ok(())
    }

    fn sky(&mut self, sky: &Spanned<Sky>) -> Result<(), Mistake> {
        if !matches!(self.dome, Dome::Nothing) {
            return Err(Reason::Missing("a [sky] and a distant [panorama] at once").at(sky.span()));
        }
        let sky = sky.get_ref();
        let light = self.follow(sky.follows.as_ref())?;
        let cover = sky.clouds.map_or(0.0, |share| share.get());
        let clouds = (cover > 0.0).then(|| Arc::new(Painter::clouds(&mut self.noise(), cover)));
        let far = Arc::new(Painter::skyline(
            &mut self.noise(),
            sky.far.map_or(FAR, |level| level.get()),
        ));
        let towards = self.sunlight.map(|sun| sun.towards);
        let painted = sky::Sky {
            zenith: sky.zenith.get(),
            horizon: sky.horizon.get(),
            clouds,
            sun: towards.zip(sky.sun.map(|level| level.get())),
            skyline: sky.skyline.map_or(0.0, |share| share.get()),
            far,
        };
        self.dome = Dome::Sky(painted, light);
        Ok(())
    }

    /// Loads a panorama: the dome, or what a room shows.
    fn panorama(
        &mut self,
        panorama: &Spanned<Panorama>,
        files: Files<'_>,
    ) -> Result<Option<(Arc<Projection>, u8)>, Mistake> {
        let panorama = panorama.get_ref();
        let span = panorama.file.span();
        let name = panorama.file.get_ref();
        let picture = library::picture(files, name).map_err(|reason| reason.at(span.clone()))?;
        self.reserve_texels(2 * picture.texels.len() as u64, span.clone())?;
        let mean = panorama.mean.map_or(GREY_ROOM, |level| level.get());
        let texels = picture
            .scaled_to(mean)
            .ok_or_else(|| Reason::DarkPanorama.at(span))?;
        let turn_rad = panorama
            .turn_deg
            .map_or(0.0, |turn| turn.get() * (PI / 180.0));
        let light = self.follow(panorama.follows.as_ref())?;
        let loaded = Arc::new(panorama::Panorama::new(picture.width, &texels, turn_rad));
        self.dome = Dome::Panorama(loaded.clone(), light);
        Ok(panorama.eye.map(|eye| {
            let eye = Vector3::from(metres(eye));
            let panorama = loaded;
            (Arc::new(Projection { panorama, eye }), light)
        }))
    }
}

/// What the sides of a room fall back on, and where the room is described.
struct Shell {
    projection: Option<(Arc<Projection>, u8)>,
    span: Range<usize>,
}

/// The four sides, clockwise from above, so that the room lies to the right of each.
fn walls([south, east]: Spot, [length, width]: [f32; 2]) -> [(Spot, Spot); 4] {
    let (north, west) = (south + length, east + width);
    [
        ([north, west], [north, east]),
        ([north, east], [south, east]),
        ([south, east], [south, west]),
        ([south, west], [north, west]),
    ]
}

/// Unit vector and distance from one point of the floor to another.
pub fn direction(from: Spot, to: Spot) -> (Vector3<f32>, f32) {
    let (x, y) = (to[0] - from[0], to[1] - from[1]);
    let length_m = (x * x + y * y).sqrt();
    (Vector3::new(x, y, 0.0) / length_m, length_m)
}

fn patch(sun: &SunPatch) -> Patch {
    let [u, v] = metres(sun.at);
    let [width, height] = sun.size.map(|length| length.get());
    Patch {
        area: Area {
            u,
            v,
            width,
            height,
        },
        slant_m: sun.slant_m.map_or(0.0, |slant| slant.get()),
        times: sun.times.get(),
    }
}

fn sunlight(sun: &Spanned<Sun>) -> Result<Sunlight, Mistake> {
    let towards = Vector3::from(metres(sun.get_ref().towards));
    let length = towards.norm();
    if length > 0.0 {
        Ok(Sunlight {
            towards: towards / length,
            share: sun.get_ref().share.get(),
        })
    } else {
        Err(Reason::NoLength("the direction to the sun").at(sun.span()))
    }
}
