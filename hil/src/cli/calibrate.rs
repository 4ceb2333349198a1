//! `hil calibrate`: the lens record of a unit from its own pictures.

use std::fs;
use std::path::PathBuf;

use clap::Args;
use nav::{BearingDirection, LensCalibration};
use serde_json::{Value, json};

use super::Failure;
use super::console::Console;
use crate::calibrate::{
    Calibrated, LENS_PAGE, Named, Order, Picture, RESIDUAL_LIMIT_PX, Settings, Spin, calibrate,
    drawing,
};
use crate::scenario::LensPage;

/// Options of `hil calibrate`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil calibrate bucket.png                 a white bucket over the lens: centre and radii\n  \
    hil calibrate spin-*.png --out lens.bin  a spin: the check as well, and the direction\n  \
    hil calibrate frame.yuv --zero-bearing 90 --horizon 31.5 --plot lens.svg\n\n\
    Pictures are PNG, JPEG or PGM of 128 x 96 pixels, or raw frames (U Y V Y, 24576 bytes). The ring's\n\
    dark middle and its outer edge must be visible nearly all round, and not overexposed.\n\
    For the check stand the drone in a room with some pattern and turn it about its own vertical, by\n\
    less than half a turn between two pictures, counter-clockwise seen from above.\n\
    The band that is unwrapped lies 1.5 px inside the visible edges.\n\n\
    Exit code 0: found, and the spin leaves at most 0.75 px. 1: it leaves more; the record is written\n\
    all the same. 2: no calibration; the error names the file.")]
pub struct Arguments {
    /// Pictures of one unit
    #[arg(required = true, value_name = "IMAGE")]
    images: Vec<PathBuf>,
    /// The record
    #[arg(long, value_name = "FILE", default_value = "lens.bin")]
    out: PathBuf,
    /// Where the nose appears in the picture: degrees from the right towards the bottom
    #[arg(long, value_name = "DEG", default_value_t = -90.0, allow_negative_numbers = true)]
    zero_bearing: f32,
    /// Radius at which things at the lens's height appear, pixels [default: the middle of the band]
    #[arg(long, value_name = "PX")]
    horizon: Option<f32>,
    /// Angle of view between the band's edges, degrees
    #[arg(long, value_name = "DEG", default_value_t = 90.0)]
    field: f32,
    /// The outer edge looks up: a plain convex mirror
    #[arg(long)]
    outer_is_up: bool,
    /// In which order the pictures of a spin were taken
    #[arg(long, value_enum, default_value_t)]
    order: Order,
    /// Ends with one JSON object: lens, edges, spin, holds, record
    #[arg(long)]
    json: bool,
    /// A drawing of the edges and the band
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let pictures: Vec<Named> = arguments
        .images
        .iter()
        .map(|path| {
            Ok(Named {
                path: path.clone(),
                picture: Picture::read(path)?,
            })
        })
        .collect::<Result<_, Failure>>()?;
    let settings = Settings {
        zero_bearing_rad: arguments.zero_bearing.to_radians(),
        horizon_radius_px: arguments.horizon,
        vertical_field_rad: arguments.field.to_radians(),
        inner_is_up: !arguments.outer_is_up,
        order: arguments.order,
    };
    let found = calibrate(&pictures, &settings)?;
    let page = LensPage::of(&found.lens);
    let write = |path: &PathBuf, bytes: &[u8]| {
        fs::write(path, bytes).map_err(|error| format!("{}: {error}", path.display()))
    };
    write(&arguments.out, page.bytes())?;
    if let Some(plot) = &arguments.plot {
        write(plot, drawing(&found).as_bytes())?;
    }
    warn(arguments, &found, console);
    if arguments.json {
        let record = arguments.out.display().to_string();
        console.result(&in_json(&found, &page, &record).to_string())?;
    } else {
        console.result(&in_words(&found))?;
    }
    let out = arguments.out.display();
    console.status("Record", &out.to_string());
    console.status(
        "Flash it",
        &format!(
            "probe-rs download --chip STM32F407VGTx --binary-format bin --base-address {LENS_PAGE:#010X} {out}"
        ),
    );
    console.status("Fly it", &format!("hil fly --lens {out}"));
    Ok(found.holds())
}

/// What the user may want to do better.
fn warn(arguments: &Arguments, found: &Calibrated, console: &Console) {
    if found.spin.is_none() {
        console.warning(if arguments.images.len() > 1 {
            "no pattern to compare the pictures by: the check by a spin was not made"
        } else {
            "one picture: the check by a spin was not made"
        });
    }
    if found.direction.is_none() {
        console.warning(
            "no spin in a known order: bearings are taken to run clockwise in the picture, as for a \
             camera that looks up",
        );
    }
}

fn in_json(found: &Calibrated, page: &LensPage, record: &str) -> Value {
    let ring = |index: usize| {
        let ring = &found.edges.rings[index];
        json!({ "radius_px": ring.radius_px, "points": ring.points, "rms_px": ring.rms_px })
    };
    json!({
        "lens": page,
        "edges": { "inner": ring(0), "outer": ring(1), "scatter_px": found.scatter_px },
        "spin": found.spin,
        "direction_found": found.direction.is_some(),
        "holds": found.holds(),
        "record": record,
    })
}

/// The calibration for people, without a newline at the end.
fn in_words(found: &Calibrated) -> String {
    let LensCalibration {
        centre_px: (x, y),
        inner_radius_px,
        outer_radius_px,
        horizon_radius_px,
        ..
    } = found.lens;
    let verdict = match &found.spin {
        Some(_) if found.holds() => "calibrated, and the spin agrees",
        Some(_) => "DOUBTFUL: the horizon does more than shift",
        None => "calibrated, not checked",
    };
    let mut lines = vec![verdict.to_owned()];
    let mut row = |name: &str, value: String| lines.push(format!("  {name:<22}{value}"));
    row("centre", format!("{x:.2}, {y:.2} px"));
    row(
        "band",
        format!(
            "{inner_radius_px:.2} to {outer_radius_px:.2} px, horizon at {horizon_radius_px:.2} px"
        ),
    );
    let edge = |index: usize| {
        let ring = &found.edges.rings[index];
        format!(
            "{:.2} px ({} points, {:.2} px rms)",
            ring.radius_px, ring.points, ring.rms_px
        )
    };
    row("inner edge", edge(0));
    row("outer edge", edge(1));
    row(
        "direction",
        match found.direction {
            Some(BearingDirection::Clockwise) => "clockwise in the picture",
            Some(BearingDirection::CounterClockwise) => "counter-clockwise in the picture",
            None => "clockwise, not measured",
        }
        .to_owned(),
    );
    if let Some(spin) = &found.spin {
        row("turns", in_degrees(spin));
        row(
            "spin leaves",
            format!(
                "{:.2} px, {:.2} deg rms of {} octants (limit {RESIDUAL_LIMIT_PX} px)",
                spin.residual_px, spin.residual_deg, spin.octants
            ),
        );
    }
    lines.join("\n")
}

fn in_degrees(spin: &Spin) -> String {
    let turns = spin.turns_deg.iter().map(|turn| format!("{turn:.1}"));
    turns.collect::<Vec<_>>().join(", ") + " deg, clockwise in the picture"
}
