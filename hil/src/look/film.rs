//! Looks along a route, one after the other, in an SVG that moves by its style sheet alone.

use autopilot::app::Route;
use fake_sensors::camera::{Moment, Pose};
use maud::html;
use nalgebra::{UnitQuaternion, Vector3};

use super::Glance;
use super::figure::{drawing, page};

/// Height of the flights, metres.
const HEIGHT_M: f32 = 0.5;

/// `count` moments (two at least) evenly along a route that is flown at `speed_m_s`, nose north.
pub fn along(route: &Route, speed_m_s: f32, count: usize) -> Vec<Moment> {
    let places: Vec<Vector3<f32>> = route
        .waypoints
        .iter()
        .map(|waypoint| Vector3::new(waypoint.place.x, waypoint.place.y, HEIGHT_M))
        .collect();
    let step_m = route.length_m() / count.saturating_sub(1).max(1) as f32;
    (0..count)
        .map(|index| {
            let way_m = step_m * index as f32;
            Moment {
                pose: Pose {
                    position_m: after(&places, way_m),
                    attitude: UnitQuaternion::identity(),
                },
                time_s: f64::from(way_m / speed_m_s),
            }
        })
        .collect()
}

/// The place `way_m` along the polyline; its end where that is shorter.
fn after(places: &[Vector3<f32>], mut way_m: f32) -> Vector3<f32> {
    for leg in places.windows(2) {
        let length_m = (leg[1] - leg[0]).norm();
        if way_m < length_m {
            return leg[0].lerp(&leg[1], way_m / length_m);
        }
        way_m -= length_m;
    }
    places.last().copied().unwrap_or_default()
}

/// Looks as a film: each is shown for `shot_s` seconds, again and again. A viewer that knows no
/// animation shows the first.
pub fn film(world: &str, glances: &[Glance], shot_s: f64) -> String {
    let count = glances.len().max(1) as f64;
    let css = format!(
        ".shot{{visibility:hidden;animation:shot {:.2}s step-end infinite}}\
         .shot:first-of-type{{visibility:visible}}\
         @keyframes shot{{0%{{visibility:visible}}{:.2}%{{visibility:hidden}}}}",
        count * shot_s,
        100.0 / count
    );
    let shots = html! {
        @for (index, glance) in glances.iter().enumerate() {
            g class="shot" style=(format!("animation-delay:{:.2}s", index as f64 * shot_s)) { (drawing(world, glance)) }
        }
    };
    page(&css, &shots).into_string()
}
