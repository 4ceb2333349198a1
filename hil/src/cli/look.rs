//! `hil look`: one look of the camera as a picture.

use std::fs;
use std::path::PathBuf;

use clap::Args;
use fake_sensors::camera::{Moment, Pose};
use fake_sensors::world::World;
use nalgebra::{UnitQuaternion, Vector3};

use super::Failure;
use super::console::Console;
use super::world;
use crate::look::{self, Observer};

/// Options of `hil look`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil look                                 the worlds there are\n  \
    hil look office\n  \
    hil look forest --at -10,2,1.5,90\n  \
    hil look my.toml --at 0,0,0.5,0,15,0 --shutter 60 --out tilted.svg\n\n\
    The picture shows the ring as it comes from the sensor, the panorama unrolled from it, the horizon\n\
    with what the 16 bytes of a snapshot keep of it, and its spectrum.")]
pub struct Arguments {
    /// A name or a file; without, the list of names
    #[arg(value_parser = world::parse)]
    world: Option<String>,
    /// x, y, z in metres (north, west, up), yaw, roll and pitch in degrees; what is missing is 0, the height 0.5
    #[arg(long, default_value = "-2.5,0,0.5", value_parser = parse_pose, allow_hyphen_values = true, value_name = "X,Y,Z,YAW,ROLL,PITCH")]
    at: Pose,
    /// Seconds of flight: where things move and light changes
    #[arg(long, default_value_t = 0.0)]
    time: f64,
    /// Seed of world and noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Shutter, lines; without, the firmware's autoexposure
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=525), value_name = "LINES")]
    shutter: Option<u16>,
    /// The picture [default: look-WORLD.svg]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

fn parse_pose(text: &str) -> Result<Pose, String> {
    let values: Result<Vec<f32>, _> = text.split(',').map(|word| word.trim().parse()).collect();
    let values = values.map_err(|_| "numbers with commas between them".to_owned())?;
    if values.is_empty() || values.len() > 6 || !values.iter().all(|value| value.is_finite()) {
        return Err("one to six finite numbers".to_owned());
    }
    let value = |index: usize, otherwise| values.get(index).copied().unwrap_or(otherwise);
    let angle = |index| value(index, 0.0).to_radians();
    Ok(Pose {
        position_m: Vector3::new(value(0, 0.0), value(1, 0.0), value(2, 0.5)),
        attitude: UnitQuaternion::from_euler_angles(angle(4), angle(5), angle(3)),
    })
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let Some(world) = &arguments.world else {
        console.result(&list()?)?;
        return Ok(true);
    };
    let moment = Moment {
        pose: arguments.at,
        time_s: arguments.time,
    };
    let glance = Observer::new(world, arguments.seed)?.look(&moment, arguments.shutter);
    let name = look::short_name(world);
    let out = arguments
        .out
        .clone()
        .unwrap_or_else(|| format!("look-{name}.svg").into());
    fs::write(&out, look::picture(&name, &glance))
        .map_err(|error| format!("{}: {error}", out.display()))?;
    console.status("Picture", &out.display().to_string());
    console.result(&format!(
        "mean luma {:.1}, shutter {} lines, gain {:.2}",
        glance.mean_luma(),
        glance.exposure.lines,
        glance.exposure.gain
    ))?;
    Ok(true)
}

fn list() -> Result<String, Failure> {
    let mut lines = Vec::new();
    for name in World::names() {
        lines.push(format!("{name:<16}{}", World::named(name, 1)?.about()));
    }
    Ok(lines.join("\n"))
}
