//! Writes what the panoramic camera sees as PNG files: the raw frame, its unrolled ring, and below it
//! the world itself, unrolled at high resolution; or a sheet of all worlds.
//!
//!     cargo run --release -p fake-sensors --example look -- office 1 -2.5 0 0.5 0 150 look
//!     cargo run --release -p fake-sensors --example look -- forest.toml 1 -2.5 0 0.5 0 150 look
//!     cargo run --release -p fake-sensors --example look -- sheet 1 sheet.png

use std::f32::consts::TAU;
use std::fs::File;
use std::io::BufWriter;

use fake_sensors::camera::{
    Exposure, Frame, HEIGHT, Moment, PanoramicCamera, PanoramicLens, Pose, View, WIDTH,
};
use fake_sensors::world::{Aperture, World};
use nalgebra::{UnitQuaternion, Vector3};

type Failure = Box<dyn std::error::Error>;

/// Columns of an unrolled picture: bearing pi at the left, forward in the middle.
const COLUMNS: usize = 1024;
/// Rows of an unrolled picture: a quarter of the columns are the 90 degrees of the optic.
const ROWS: usize = COLUMNS / 4;
/// Rays along each edge of a pixel of the high resolution.
const RAYS: usize = 2;
/// Luma of white paper in the high resolution at the shutter for which a grey room is 80.
const WHITE: f32 = 255.0;
/// Lines of shutter on the sheet.
const USUAL_LINES: u16 = 150;

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match &arguments[..] {
        [verb, seed, file] if verb == "sheet" => sheet(seed.parse()?, file),
        [world, seed, x, y, z, yaw_deg, lines, prefix] => {
            let pose = pose([x.parse()?, y.parse()?, z.parse()?], yaw_deg.parse()?);
            look(world, seed.parse()?, &pose, lines.parse()?, prefix)
        }
        _ => Err(
            "usage: look WORLD SEED X Y Z YAW_DEG LINES PREFIX, or: look sheet SEED FILE".into(),
        ),
    }
}

fn pose([x, y, z]: [f32; 3], yaw_deg: f32) -> Pose {
    Pose {
        position_m: Vector3::new(x, y, z),
        attitude: UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw_deg.to_radians()),
    }
}

fn still(pose: Pose) -> Moment {
    Moment { pose, time_s: 0.0 }
}

fn look(name: &str, seed: u64, pose: &Pose, lines: u16, prefix: &str) -> Result<(), Failure> {
    let world = World::open(name, seed)?;
    let lens = PanoramicLens::default();
    let fine = unrolled_world(&world, &lens, pose, lines);
    let mut camera = PanoramicCamera::new(world, &lens, 1);
    let frame = camera.expose(&still(*pose), Exposure { lines, gain: 1.0 }, 0);
    let raw: Vec<u8> = frame.iter().skip(1).step_by(2).copied().collect();
    save(&format!("{prefix}-raw.png"), WIDTH, HEIGHT, &raw)?;
    let coarse = unrolled_frame(&lens, frame);
    println!("mean luma of the ring: {:.1}", mean(&coarse));
    let picture = [fine, coarse].concat();
    save(
        &format!("{prefix}-unrolled.png"),
        COLUMNS,
        2 * ROWS,
        &picture,
    )
}

/// Every world from the middle of the first leg of the routes, above what the camera sees of it.
fn sheet(seed: u64, file: &str) -> Result<(), Failure> {
    let lens = PanoramicLens::default();
    let pose = pose([-2.5, 0.0, 0.6], 0.0);
    let mut picture = Vec::new();
    for name in World::names() {
        let world = World::named(name, seed)?;
        picture.extend(unrolled_world(&world, &lens, &pose, USUAL_LINES));
        let mut camera = PanoramicCamera::new(world, &lens, 1);
        let exposure = Exposure {
            lines: USUAL_LINES,
            gain: 1.0,
        };
        let coarse = unrolled_frame(&lens, camera.expose(&still(pose), exposure, 0));
        println!("{name}: mean luma {:.1}", mean(&coarse));
        picture.extend(coarse);
    }
    save(file, COLUMNS, picture.len() / COLUMNS, &picture)
}

/// Bearing and elevation of a place in an unrolled picture.
fn view(lens: &PanoramicLens, column: f32, row: f32) -> View {
    View {
        bearing_rad: (0.5 - column / COLUMNS as f32) * TAU,
        elevation_rad: (1.0 - 2.0 * row / ROWS as f32) * lens.half_field_rad,
    }
}

/// What the camera's frame shows.
fn unrolled_frame(lens: &PanoramicLens, frame: &Frame) -> Vec<u8> {
    let luma = |index: usize| {
        let [x, y] = lens
            .project(view(
                lens,
                (index % COLUMNS) as f32,
                (index / COLUMNS) as f32,
            ))
            .map(|coordinate| coordinate as usize);
        frame[2 * (y * WIDTH + x) + 1]
    };
    (0..COLUMNS * ROWS).map(luma).collect()
}

/// What there is to be seen.
fn unrolled_world(world: &World, lens: &PanoramicLens, pose: &Pose, lines: u16) -> Vec<u8> {
    let seen = world.seen_from(pose.position_m, 0.0);
    let aperture = Aperture::new(
        TAU / (COLUMNS * RAYS) as f32,
        2.0 * lens.half_field_rad / (ROWS * RAYS) as f32,
    );
    let radiance = |column: usize, row: usize| {
        let at = |index: usize, ray: usize| index as f32 + (ray as f32 + 0.5) / RAYS as f32;
        let rays = (0..RAYS * RAYS).map(|ray| {
            let view = view(lens, at(column, ray % RAYS), at(row, ray / RAYS));
            let (sin, cos) = view.elevation_rad.sin_cos();
            let way = Vector3::new(
                cos * view.bearing_rad.cos(),
                cos * view.bearing_rad.sin(),
                sin,
            );
            seen.radiance(pose.attitude * way, &aperture)
        });
        rays.sum::<f32>() / (RAYS * RAYS) as f32
    };
    let scale = WHITE * f32::from(lines) / f32::from(USUAL_LINES);
    (0..COLUMNS * ROWS)
        .map(|index| {
            let linear = radiance(index % COLUMNS, index / COLUMNS) * scale / 255.0;
            // As a screen shows it: what the camera sends is linear.
            (255.0 * linear.min(1.0).powf(1.0 / 2.2)) as u8
        })
        .collect()
}

fn mean(luma: &[u8]) -> f32 {
    luma.iter().map(|&luma| f32::from(luma)).sum::<f32>() / luma.len() as f32
}

fn save(path: &str, width: usize, height: usize, grey: &[u8]) -> Result<(), Failure> {
    let file = BufWriter::new(File::create(path)?);
    let mut encoder = png::Encoder::new(file, u32::try_from(width)?, u32::try_from(height)?);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.write_header()?.write_image_data(grey)?;
    Ok(())
}
