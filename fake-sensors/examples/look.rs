//! Writes what the panoramic camera sees as PNG files: the raw frame, its unrolled ring, and the
//! ring's vertical mean (brightness as height).
//!
//!     cargo run --release -p fake-sensors --example look -- arena-panels 1 -2.5 0 0.5 0 150 look

use std::fs::File;
use std::io::BufWriter;
use std::time::Instant;

use fake_sensors::camera::{
    Exposure, Frame, HEIGHT, PanoramicCamera, PanoramicLens, Pose, View, WIDTH,
};
use fake_sensors::world::World;
use nalgebra::{UnitQuaternion, Vector3};

type Failure = Box<dyn std::error::Error>;

/// Rows of the unrolled picture, and of the curve below it.
const ROWS: usize = 128;
/// Columns of the unrolled picture: bearing pi at the left, forward in the middle.
const COLUMNS: usize = 512;

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [world, seed, x, y, z, yaw_deg, lines, prefix] = &arguments[..] else {
        return Err("usage: look WORLD SEED X Y Z YAW_DEG LINES PREFIX".into());
    };
    let world = World::named(world, seed.parse()?)?;
    let lens = PanoramicLens::default();
    let mut camera = PanoramicCamera::new(world, &lens, 1);
    let yaw = yaw_deg.parse::<f32>()?.to_radians();
    let pose = Pose {
        position_m: Vector3::new(x.parse()?, y.parse()?, z.parse()?),
        attitude: UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw),
    };
    let exposure = Exposure {
        lines: lines.parse()?,
        gain: 1.0,
    };

    let frame = camera.expose(&pose, exposure, 0);
    let raw: Vec<u8> = frame.iter().skip(1).step_by(2).copied().collect();
    save(&format!("{prefix}-raw.png"), WIDTH, HEIGHT, &raw)?;
    let unrolled = unroll(&lens, frame);
    let means = column_means(&unrolled);
    let picture = [unrolled, curve(&means)].concat();
    save(
        &format!("{prefix}-unrolled.png"),
        COLUMNS,
        2 * ROWS,
        &picture,
    )?;
    println!("mean luma of the ring: {:.1}", mean(&means));
    println!(
        "luma amplitude of the harmonics 1..8: {:.1?}",
        harmonics(&means)
    );
    println!(
        "{:.3} ms per frame",
        time_per_frame_ms(&mut camera, &pose, exposure)
    );
    Ok(())
}

fn unroll(lens: &PanoramicLens, frame: &Frame) -> Vec<u8> {
    let luma = |index: usize| {
        let view = View {
            bearing_rad: (0.5 - (index % COLUMNS) as f32 / COLUMNS as f32) * std::f32::consts::TAU,
            elevation_rad: (1.0 - 2.0 * (index / COLUMNS) as f32 / ROWS as f32)
                * lens.half_field_rad,
        };
        let [x, y] = lens.project(view).map(|coordinate| coordinate as usize);
        frame[2 * (y * WIDTH + x) + 1]
    };
    (0..COLUMNS * ROWS).map(luma).collect()
}

fn column_means(picture: &[u8]) -> Vec<f32> {
    let column = |u| picture.iter().skip(u).step_by(COLUMNS);
    (0..COLUMNS)
        .map(|u| column(u).map(|&luma| f32::from(luma)).sum::<f32>() / ROWS as f32)
        .collect()
}

/// A bar chart: full height is luma 255.
fn curve(means: &[f32]) -> Vec<u8> {
    let bar = |index: usize| {
        let height = 255.0 * (1.0 - (index / COLUMNS) as f32 / ROWS as f32);
        if means[index % COLUMNS] > height {
            255
        } else {
            0
        }
    };
    (0..COLUMNS * ROWS).map(bar).collect()
}

fn mean(values: &[f32]) -> f32 {
    values.iter().sum::<f32>() / values.len() as f32
}

fn harmonics(means: &[f32]) -> Vec<f32> {
    let amplitude = |k: usize| {
        let (mut re, mut im) = (0.0, 0.0);
        for (n, value) in means.iter().enumerate() {
            let angle = std::f32::consts::TAU * (k * n) as f32 / COLUMNS as f32;
            re += value * angle.cos();
            im += value * angle.sin();
        }
        2.0 * f32::hypot(re, im) / COLUMNS as f32
    };
    (1..=8).map(amplitude).collect()
}

fn time_per_frame_ms(camera: &mut PanoramicCamera, pose: &Pose, exposure: Exposure) -> f64 {
    const FRAMES: u32 = 1_000;
    let start = Instant::now();
    for number in 0..FRAMES {
        camera.expose(pose, exposure, number);
    }
    start.elapsed().as_secs_f64() * 1e3 / f64::from(FRAMES)
}

fn save(path: &str, width: usize, height: usize, grey: &[u8]) -> Result<(), Failure> {
    let file = BufWriter::new(File::create(path)?);
    let mut encoder = png::Encoder::new(file, u32::try_from(width)?, u32::try_from(height)?);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.write_header()?.write_image_data(grey)?;
    Ok(())
}
