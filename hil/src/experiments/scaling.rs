//! Claim 35: catchment areas scale with the distance of the walls.
//!
//! The photographed lounge is put on the faces of rooms of half, the same and double the size of the paper's. What
//! belongs to the robot stays as it is: its height, the grid, the half metre that counts as home, and its settings,
//! which are tuned at the paper's size alone.

use super::claims::what;
use super::computed::Order;
use super::{ExperimentError, Row, rooms};
use crate::catchment::{Condition, Method, Settings, Survey, Task, evaluate, tune};

/// Factors on the room's size; the settings are tuned at 1.
const SCALES: [f32; 3] = [0.5, 1.0, 2.0];
/// Snapshots of each room: where nothing is said, and at most.
const SNAPSHOTS: [u64; 2] = [16, 36];
/// The paper's method and snapshot (Fig. 8).
const TASK: Task = Task {
    method: Method::Fourier,
    bytes: 16,
    heading_deg: 0.0,
};
/// Bounds of the slope of log √area over log size, which is 1 where they are proportional. Over sizes that differ by
/// a factor of four √area then grows by a factor of 3 to 5.3.
const SLOPE: [f64; 2] = [0.8, 1.2];

/// What was found in the room of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Scaled {
    scale: f32,
    /// The mean catchment area.
    area_m2: f64,
    /// The area of all free positions, which bounds it.
    free_m2: f64,
}

/// The row of claim 35.
pub fn rows(order: &mut Order<'_>) -> Result<Vec<Row>, ExperimentError> {
    let [usual, most] = SNAPSHOTS;
    let snapshots = order.seeds.unwrap_or(usual).clamp(usual, most) as usize;
    let mut surveys = Vec::new();
    for (number, scale) in (1..).zip(SCALES) {
        let place = rooms::lounge(rooms::PAPER_ROOM_M.map(|side_m| scale * side_m))?;
        surveys.push(Survey::take(&place, Condition::None, snapshots, |_| ())?);
        (order.progress)(f64::from(number) / (1 + SCALES.len()) as f64);
    }
    let settings = of_paper_size(&surveys);
    let found: Vec<Scaled> = SCALES
        .iter()
        .zip(&surveys)
        .flat_map(|(scale, survey)| {
            let rows = evaluate(survey, &[TASK], &settings, &survey.place, |_| ());
            rows.into_iter().map(|row| Scaled {
                scale: *scale,
                area_m2: row.area_m2,
                free_m2: row.free_m2,
            })
        })
        .collect();
    let goals = surveys.iter().map(|survey| survey.goals.len());
    Ok(vec![Row {
        seeds: goals.sum(),
        ..judged(&found)
    }])
}

/// The settings that are best in the room of the paper's size.
fn of_paper_size(surveys: &[Survey]) -> Vec<Settings> {
    let middle: Vec<&Survey> = surveys.iter().skip(1).take(1).collect();
    tune(&middle, &[TASK], |_| ())
}

fn judged(found: &[Scaled]) -> Row {
    let slope = slope(found);
    let rooms: Vec<_> = found
        .iter()
        .map(|room| {
            let share = 100.0 * room.area_m2 / room.free_m2;
            format!(
                "{:.1} m² ({share:.0} % of the floor) at ×{}",
                room.area_m2, room.scale
            )
        })
        .collect();
    let [least, most] = SLOPE;
    Row {
        kept: Some((least..=most).contains(&slope)),
        ..Row::of(
            what(35),
            "proportional to the distance of the walls",
            format!(
                "√area grows with the size to the power of {slope:.2} ({least} to {most}): {}",
                rooms.join(", ")
            ),
        )
        .about(35)
    }
}

/// The slope of the straight line through log √area over log size, by least squares.
fn slope(found: &[Scaled]) -> f64 {
    let points: Vec<[f64; 2]> = found
        .iter()
        .map(|room| [libm::log(room.scale.into()), 0.5 * libm::log(room.area_m2)])
        .collect();
    let count = points.len() as f64;
    let middle = [0, 1].map(|axis: usize| {
        let sum: f64 = points.iter().map(|point| point[axis]).sum();
        sum / count
    });
    let [mut spread, mut along] = [0.0; 2];
    for [size, length] in points {
        spread += (size - middle[0]) * (size - middle[0]);
        along += (size - middle[0]) * (length - middle[1]);
    }
    along / spread
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rooms whose catchment areas are these.
    fn rooms(areas_m2: [f64; 3]) -> Vec<Scaled> {
        let room = |(scale, area_m2): (f32, f64)| Scaled {
            scale,
            area_m2,
            free_m2: 47.0 * f64::from(scale * scale),
        };
        SCALES.into_iter().zip(areas_m2).map(room).collect()
    }

    #[test]
    fn an_area_that_grows_with_the_square_of_the_size_is_proportional() {
        let found = rooms([9.0, 36.0, 144.0]);
        assert!((slope(&found) - 1.0).abs() < 1e-12);
        let row = judged(&found);
        assert_eq!(row.kept, Some(true));
        assert!(
            row.ours.contains("36.0 m² (77 % of the floor) at ×1"),
            "{row:?}"
        );
    }

    #[test]
    fn an_area_that_grows_with_the_size_itself_or_not_at_all_is_not_proportional() {
        assert!((slope(&rooms([18.0, 36.0, 72.0])) - 0.5).abs() < 1e-12);
        for areas_m2 in [[18.0, 36.0, 72.0], [36.0; 3], [3.0, 36.0, 432.0]] {
            assert_eq!(judged(&rooms(areas_m2)).kept, Some(false), "{areas_m2:?}");
        }
    }
}
