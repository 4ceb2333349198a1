//! The radius of an edge whose centre is known: where the mean over all rays changes most.
//!
//! On one ray a lamp or a beam beside the edge moves the half-way level; in the mean over all rays and
//! pictures the scene is even, and the steepest place of a blurred step is the step itself.

use super::edges::rays;
use super::picture::{Picture, polar};

/// Half of the distance over which the change is taken, pixels: the blur's own size.
const REACH_PX: f64 = 0.75;

/// How far from the first guess the edge may be, pixels.
const SEARCH_PX: f64 = 1.5;

/// Steps of the search, pixels.
const STEP_PX: f64 = 0.1;

/// The radius near `guess_px` at which the mean luma of all rays changes most.
pub fn radius(pictures: &[Picture], centre: [f64; 2], guess_px: f64) -> f64 {
    let steps = (SEARCH_PX / STEP_PX) as i32;
    let at = |step: i32| guess_px + f64::from(step) * STEP_PX;
    let farthest = at(steps + 1) + REACH_PX;
    // Those that leave the picture on the way would come and go with the radius.
    let whole: Vec<(&Picture, f64)> = pictures
        .iter()
        .flat_map(|picture| rays().map(move |angle| (picture, angle)))
        .filter(|(picture, angle)| picture.at(polar(centre, farthest, *angle)).is_some())
        .collect();
    let change = |step: i32| {
        let sides = |(picture, angle): &(&Picture, f64)| {
            let luma = |radius| picture.at(polar(centre, radius, *angle)).unwrap_or(0.0);
            luma(at(step) + REACH_PX) - luma(at(step) - REACH_PX)
        };
        whole.iter().map(sides).sum::<f64>().abs()
    };
    let changes: Vec<f64> = (-steps - 1..=steps + 1).map(change).collect();
    let inside = 1..changes.len() - 1;
    let best = inside.max_by(|a, b| changes[*a].total_cmp(&changes[*b]));
    let best = best.unwrap_or(1);
    let rest = vertex(changes[best - 1], changes[best], changes[best + 1]);
    at(best as i32 - steps - 1) + rest * STEP_PX
}

/// Where the parabola through three values one apart has its vertex, from the middle one; within half a
/// step.
pub fn vertex(before: f64, middle: f64, after: f64) -> f64 {
    let bend = before - 2.0 * middle + after;
    if bend < 0.0 {
        (0.5 * (before - after) / bend).clamp(-0.5, 0.5)
    } else {
        0.0
    }
}
