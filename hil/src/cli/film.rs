//! `hil film`: what the camera sees along a route.

use std::fs;
use std::path::PathBuf;

use clap::Args;

use super::Failure;
use super::console::Console;
use super::world;
use crate::look::{self, Observer};
use crate::scenario::Route;

/// Speed of the flights, m/s.
const SPEED_M_S: f32 = 0.5;

/// Options of `hil film`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil film office\n  \
    hil film corridor-doors --route line --shots 40 --out corridor.svg\n\n\
    The film is an SVG that moves in any browser. Its times are those of a flight at 0.5 m/s.")]
pub struct Arguments {
    /// A name or a file
    #[arg(value_parser = world::parse)]
    world: String,
    /// The way
    #[arg(long, value_enum, default_value_t)]
    route: Route,
    /// Looks along it
    #[arg(long, default_value_t = 60, value_parser = clap::value_parser!(u16).range(2..=1_000))]
    shots: u16,
    /// Seconds that each is shown
    #[arg(long, default_value_t = 0.2, value_parser = parse_seconds, value_name = "SECONDS")]
    shot_time: f64,
    /// Seed of world and noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The film [default: film-WORLD.svg]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

fn parse_seconds(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|seconds| (0.02..=10.0).contains(seconds))
        .ok_or_else(|| "0.02 to 10 seconds".to_owned())
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let mut observer = Observer::new(&arguments.world, arguments.seed)?;
    let route = arguments.route.waypoints();
    let moments = look::along(&route, SPEED_M_S, arguments.shots.into());
    let mut progress = console.progress("Filming", moments.len() as u64);
    let mut glances = Vec::new();
    for moment in &moments {
        glances.push(observer.look(moment, None));
        progress.set(glances.len() as u64, || {
            format!("{} of {} shots", glances.len(), moments.len())
        });
    }
    progress.finish();
    let name = look::short_name(&arguments.world);
    let out = arguments
        .out
        .clone()
        .unwrap_or_else(|| format!("film-{name}.svg").into());
    fs::write(&out, look::film(&name, &glances, arguments.shot_time))
        .map_err(|error| format!("{}: {error}", out.display()))?;
    console.status("Film", &out.display().to_string());
    Ok(true)
}
