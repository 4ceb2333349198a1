//! Camera frames a second, with the rolling shutter: each row is seen from a pose of its own.
//!
//!     cargo bench -p fake-sensors --bench render

use std::path::Path;

use criterion::{BenchmarkId, Criterion, Throughput};
use fake_sensors::camera::{
    Exposure, FRAME_BYTES, HEIGHT, Moment, PanoramicCamera, PanoramicLens, Pose,
};
use fake_sensors::world::{WORLD_NAMES, World};
use nalgebra::{UnitQuaternion, Vector3};

/// Worlds of the long routes, beside those of the library.
const LONG: [&str; 2] = ["building.toml", "greenhouse-rows.toml"];
/// From the first row to the last at 25.64 frames a second.
const READOUT_S: f64 = 0.035;
/// Flight speed.
const SPEED_M_S: f64 = 0.5;

const EXPOSURE: Exposure = Exposure {
    lines: 150,
    gain: 1.0,
};

/// The camera on the first leg of the routes, `time_s` into a flight that never ends.
fn pose(time_s: f64) -> Pose {
    let way_m = (time_s * SPEED_M_S) % 5.0;
    let swing = (0.1 * (7.0 * time_s).sin()) as f32;
    Pose {
        position_m: Vector3::new(-way_m as f32, 0.0, 0.5),
        attitude: UnitQuaternion::from_euler_angles(swing, -0.5 * swing, 0.3 * time_s as f32),
    }
}

/// From poses to the bytes of a frame; the rate is frames a second.
fn frame(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("frame");
    group.throughput(Throughput::Elements(1));
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/worlds");
    let library = WORLD_NAMES.map(|name| (name, World::named(name, 1)));
    let library = library.map(|(name, world)| (name, world.expect("a world of the library")));
    let long = LONG.map(|name| (name, World::from_file(&folder.join(name), 1)));
    let long = long.map(|(name, world)| (name, world.expect("a world of the long routes")));
    for (name, world) in library.into_iter().chain(long) {
        let mut camera = PanoramicCamera::new(world, &PanoramicLens::default(), 1);
        let mut number = 0;
        group.bench_function(BenchmarkId::from_parameter(name), |bencher| {
            bencher.iter(|| {
                take(&mut camera, number);
                number += 1;
                camera.frame()[FRAME_BYTES / 2]
            });
        });
    }
    group.finish();
}

/// A frame, row by row.
fn take(camera: &mut PanoramicCamera, number: u32) {
    let start_s = f64::from(number) * 0.039;
    camera.begin_frame(number);
    for row in 0..HEIGHT {
        let time_s = start_s + READOUT_S * row as f64 / HEIGHT as f64;
        let moment = Moment {
            pose: pose(time_s),
            time_s,
        };
        camera.light_row(row, &moment);
    }
    for row in 0..HEIGHT {
        camera.read_row(row, EXPOSURE);
    }
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    frame(&mut criterion);
    criterion.final_summary();
}
