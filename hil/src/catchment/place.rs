//! Places to look for the way home in: worlds, photographed rooms, folders of pictures.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use fake_sensors::world::{World, WorldError};

use super::grid::Grid;
use super::pictures::{Pictures, PicturesError};
use super::render;

/// Size of the paper's room, along x and y, metres (Gaffin & Brayfield 2016).
pub const ROOM_M: [f32; 2] = [7.3, 6.9];
/// A photographed room's height unless it is told, metres.
pub const ROOM_HEIGHT_M: f32 = 3.0;
/// From where a photographed room is taken to be photographed, metres above the floor.
const TRIPOD_M: f32 = 1.5;
/// How near to the walls of a photographed room there are positions, metres.
const WALL_MARGIN_M: f32 = 0.15;
/// How high above the floor the robot looks round, metres.
pub const EYE_M: f32 = 1.0;
/// The seed of worlds whose name does not say one.
const SEED: u64 = 1;

/// What a place is made of.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// A world by name or file, built from a seed.
    World {
        /// A name of the library's, or a file.
        world: String,
        /// Of its textures.
        seed: u64,
    },
    /// A panorama on the walls, floor and ceiling of a room.
    Panorama {
        /// Equirectangular, HDR or EXR.
        file: PathBuf,
        /// Along x and y, and its height, metres.
        size_m: [f32; 3],
    },
    /// A folder of pictures with a manifest.
    Pictures(PathBuf),
}

/// A name on the command line and what it stands for.
#[derive(Clone, Debug, PartialEq)]
pub struct Named {
    /// As it was written.
    pub name: String,
    /// What it stands for.
    pub source: Source,
}

impl FromStr for Named {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let source = if let Some(rest) = text.strip_prefix("hdri:") {
            let (file, size_m) = match rest.rsplit_once(',') {
                Some((file, size)) => (file, room_size(size)?),
                None => (rest, [ROOM_M[0], ROOM_M[1], ROOM_HEIGHT_M]),
            };
            Source::Panorama {
                file: file.into(),
                size_m,
            }
        } else if let Some(folder) = text.strip_prefix("images:") {
            Source::Pictures(folder.into())
        } else {
            let (world, seed) = match text.rsplit_once('#') {
                Some((world, seed)) => (world, seed.parse().map_err(|_| bad_seed(seed))?),
                None => (text, SEED),
            };
            Source::World {
                world: world.to_owned(),
                seed,
            }
        };
        Ok(Self {
            name: text.to_owned(),
            source,
        })
    }
}

fn bad_seed(seed: &str) -> String {
    format!("`{seed}` is no seed: a whole number stands behind `#`")
}

fn room_size(text: &str) -> Result<[f32; 3], String> {
    let lengths: Result<Vec<f32>, _> = text.split('x').map(str::parse).collect();
    let lengths = lengths.ok().filter(|lengths| {
        let sound = lengths.iter().all(|length| (1.0..=40.0).contains(length));
        sound && matches!(lengths.len(), 2 | 3)
    });
    let lengths =
        lengths.ok_or_else(|| format!("`{text}`: WxL or WxLxH in metres, each from 1 to 40"))?;
    let height_m = lengths.get(2).copied().unwrap_or(ROOM_HEIGHT_M);
    Ok([lengths[0], lengths[1], height_m])
}

/// A place that is open to look round in.
#[derive(Debug)]
pub struct Place {
    /// Its name.
    pub name: String,
    /// The positions.
    pub grid: Grid,
    /// Where views come from.
    pub scenery: Scenery,
    /// What was left out, and why.
    pub complaints: Vec<String>,
}

/// Where views come from.
#[derive(Debug)]
pub enum Scenery {
    /// They are computed.
    World(World),
    /// They were taken.
    Pictures(Pictures),
}

/// A place that cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum PlaceError {
    /// Its world.
    #[error(transparent)]
    World(#[from] WorldError),
    /// Its pictures.
    #[error(transparent)]
    Pictures(#[from] PicturesError),
    /// It has too few positions.
    #[error("{place}: {free} free positions are too few to home between")]
    TooSmall {
        /// Its name.
        place: String,
        /// How many there are.
        free: usize,
    },
}

/// Fewer positions make no area.
const FEWEST_POSITIONS: usize = 9;

impl Place {
    /// Opens a place.
    ///
    /// # Errors
    /// [`PlaceError`]; pictures that are missing or broken are [`complaints`](Self::complaints)
    /// instead.
    pub fn open(named: &Named) -> Result<Self, PlaceError> {
        let mut complaints = Vec::new();
        let (grid, scenery) = match &named.source {
            Source::World { world, seed } => of_world(World::open(world, *seed)?),
            Source::Panorama { file, size_m } => of_panorama(file, *size_m)?,
            Source::Pictures(folder) => {
                let (pictures, found) = Pictures::open(folder)?;
                complaints = found;
                (pictures.grid().clone(), Scenery::Pictures(pictures))
            }
        };
        let free = grid.free_positions().count();
        if free < FEWEST_POSITIONS {
            return Err(PlaceError::TooSmall {
                place: named.name.clone(),
                free,
            });
        }
        Ok(Self {
            name: named.name.clone(),
            grid,
            scenery,
            complaints,
        })
    }

    /// Area of the free positions, m².
    pub fn free_m2(&self) -> f64 {
        self.grid.free_positions().count() as f64 * self.grid.cell_m2()
    }
}

/// The middle of where a drone may fly, as large as the paper's room at most.
fn of_world(world: World) -> (Grid, Scenery) {
    let (low_m, high_m) = match world.free() {
        Some(free) => (free.low_m, free.high_m),
        None => (
            ROOM_M.map(|side| -0.5 * side),
            ROOM_M.map(|side| 0.5 * side),
        ),
    };
    let sides = [0, 1].map(|axis: usize| (high_m[axis] - low_m[axis]).min(ROOM_M[axis]));
    let middle = [0, 1].map(|axis: usize| 0.5 * (low_m[axis] + high_m[axis]));
    let mut grid = Grid::over(
        [0, 1].map(|axis: usize| middle[axis] - 0.5 * sides[axis]),
        [0, 1].map(|axis: usize| middle[axis] + 0.5 * sides[axis]),
    );
    render::close_what_is_occupied(&world, &mut grid, EYE_M);
    (grid, Scenery::World(world))
}

/// A room round the origin with the panorama on all its faces.
fn of_panorama(file: &Path, [x, y, z]: [f32; 3]) -> Result<(Grid, Scenery), WorldError> {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let name = toml::Value::from(name.as_ref());
    let tripod_m = TRIPOD_M.min(0.5 * z);
    let text = format!(
        "[panorama]\nfile = {name}\nmean = 0.24\neye = [0.0, 0.0, {tripod_m:?}]\n\
         [room]\ncorner = [{:?}, {:?}]\nsize = [{x:?}, {y:?}]\nheight = {z:?}\n",
        -0.5 * x,
        -0.5 * y
    );
    let world = World::from_text(&text, file, SEED)?;
    let half = [x, y].map(|side| 0.5 * side - WALL_MARGIN_M);
    let grid = Grid::over(half.map(|side| -side), half);
    Ok((grid, Scenery::World(world)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_a_world_a_photographed_room_or_a_folder() {
        let source = |text: &str| text.parse::<Named>().unwrap().source;
        let world = |world: &str, seed| Source::World {
            world: world.to_owned(),
            seed,
        };
        assert_eq!(source("office"), world("office", 1));
        assert_eq!(source("arena#7"), world("arena", 7));
        assert_eq!(source("images:set"), Source::Pictures("set".into()));
        let room = |size_m| Source::Panorama {
            file: "a,b.hdr".into(),
            size_m,
        };
        assert_eq!(source("hdri:a,b.hdr,10x8x4"), room([10.0, 8.0, 4.0]));
        assert_eq!(source("hdri:a,b.hdr,10x8"), room([10.0, 8.0, 3.0]));
    }

    #[test]
    fn what_is_no_place_is_refused() {
        for bad in [
            "arena#x",
            "hdri:a.hdr,10",
            "hdri:a.hdr,0x5",
            "hdri:a.hdr,1x2x3x4",
        ] {
            assert!(bad.parse::<Named>().is_err(), "{bad}");
        }
    }
}
