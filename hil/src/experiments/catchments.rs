//! Fig. 3C again, claims 20 to 23: a survey as `hil catchment` makes it, small enough for a minute.
//!
//! Noise-free and aligned, each method tuned on the room itself, as in the paper. There are two rooms: the
//! photographed lounge at the size of the paper's room, and the open office.

use nav::methods::Slope;

use super::claims::what;
use super::computed::Order;
use super::{ExperimentError, Row, measured, rooms};
use crate::catchment::crossing::{Crossing, crossings};
use crate::catchment::{
    self, Condition, Method, Place, Settings, Survey, Task, evaluate, measure, tune, tune_among,
};

/// Snapshots of each room: where nothing is said, and at most. With more, the standard error falls by less than
/// the rooms differ.
const SNAPSHOTS: [u64; 2] = [9, 25];
/// Bytes of a snapshot: both sides of the paper's 32.
const SIZES: [u8; 8] = [4, 6, 8, 10, 16, 24, 32, 48];
/// The methods of the paper.
const METHODS: [Method; 3] = [Method::Fourier, Method::Search, Method::Mfdid];
/// Below this size Fourier homing has the largest area in the paper, above it Search, bytes.
const PAPER_CROSSING: u8 = 32;
/// The five lowest components, bytes (Stürzl & Mallot 2006, as the paper cites them).
const COMPACT: u8 = 10;
/// Areas that differ by no more than this share count as alike. The standard error of the paper's means is not
/// known; that of the means here is of this order.
const ALIKE: f64 = 0.1;

/// The areas by which the claims are judged.
#[derive(Debug, Default)]
struct Found {
    /// Of the paper's methods, each tuned over all that it can vary.
    tuned: Vec<catchment::Row>,
    /// Of MFDID, tuned without Newton's step.
    descent: Vec<catchment::Row>,
}

/// The rows of claims 20 to 23.
pub fn rows(order: &mut Order<'_>) -> Result<Vec<Row>, ExperimentError> {
    let [usual, most] = SNAPSHOTS;
    let snapshots = order.seeds.unwrap_or(usual).clamp(usual, most);
    let places = [rooms::lounge(rooms::PAPER_ROOM_M)?, rooms::office()?];
    let mut found = Found::default();
    for (number, place) in places.iter().enumerate() {
        let share = |of_place: f64| (number as f64 + of_place) / places.len() as f64;
        found.survey(place, snapshots as usize, |of_place| {
            (order.progress)(share(of_place));
        })?;
    }
    Ok(found.judged())
}

impl Found {
    /// Adds the areas in a place.
    fn survey(
        &mut self,
        place: &Place,
        snapshots: usize,
        mut progress: impl FnMut(f64),
    ) -> Result<(), ExperimentError> {
        let survey = Survey::take(place, Condition::None, snapshots, |_| ())?;
        let tasks = tasks(&METHODS);
        // Tuning takes nearly all of the time.
        let tries = measure::tries(&tasks) as f64;
        let settings = tune(&[&survey], &tasks, |done| progress(done as f64 / tries));
        self.tuned
            .extend(evaluate(&survey, &tasks, &settings, &place.name, |_| ()));

        let tasks = self::tasks(&[Method::Mfdid]);
        let choices: Vec<_> = tasks.iter().map(descents).collect();
        let settings = tune_among(&[&survey], &choices, |_| ());
        self.descent
            .extend(evaluate(&survey, &tasks, &settings, &place.name, |_| ()));
        Ok(())
    }

    fn judged(&self) -> Vec<Row> {
        let mut rows = vec![
            self.crossing(),
            self.per_byte(),
            self.newton(),
            self.compact(),
        ];
        for row in &mut rows {
            row.seeds = self.snapshots();
        }
        rows
    }

    /// Claim 20: which method has the largest area, and where that changes.
    fn crossing(&self) -> Row {
        let leads = |bytes: u8, leader: Method| {
            let area = area_m2(&self.tuned, leader, bytes);
            METHODS
                .iter()
                .all(|method| area >= area_m2(&self.tuned, *method, bytes))
        };
        let kept = SIZES.iter().all(|bytes| match *bytes {
            bytes if bytes < PAPER_CROSSING => leads(bytes, Method::Fourier),
            bytes if bytes > PAPER_CROSSING => leads(bytes, Method::Search),
            _ => true,
        });
        let all = crossings(&self.tuned);
        let of_search = |crossing: &&Crossing| crossing.method == Method::Search;
        let ours = all.iter().rev().find(of_search).map(|crossing| {
            let largest = SIZES.iter().filter(|bytes| leads(**bytes, Method::Fourier));
            let sizes: Vec<_> = largest.map(u8::to_string).collect();
            format!("Fourier largest at {} B; {crossing}", sizes.join(", "))
        });
        Row {
            kept: Some(kept),
            ..Row::of(
                what(20),
                "Fourier below 32 B, Search above",
                ours.unwrap_or_default(),
            )
            .about(20)
        }
    }

    /// Claim 21: who has the most area for a byte.
    fn per_byte(&self) -> Row {
        let all = METHODS
            .iter()
            .flat_map(|method| SIZES.map(|bytes| (*method, bytes)));
        let per_byte =
            |(method, bytes): (Method, u8)| area_m2(&self.tuned, method, bytes) / f64::from(bytes);
        let best = all.max_by(|a, b| per_byte(*a).total_cmp(&per_byte(*b)));
        let (method, bytes) = best.unwrap_or((Method::Fourier, COMPACT));
        let ours = format!(
            "{method}: {:.1} m² a byte at {bytes} B; Fourier at {COMPACT} B {:.1}, at 32 B {:.1}",
            per_byte((method, bytes)),
            per_byte((Method::Fourier, COMPACT)),
            per_byte((Method::Fourier, PAPER_CROSSING)),
        );
        Row {
            kept: Some(method == Method::Fourier && bytes <= COMPACT),
            ..Row::of(what(21), "Fourier, at small sizes", ours).about(21)
        }
    }

    /// Claim 22: what Newton's step in the search for MFDID's parameters changes.
    fn newton(&self) -> Row {
        let mean_m2 = |rows: &[catchment::Row]| {
            let areas = SIZES.map(|bytes| area_m2(rows, Method::Mfdid, bytes));
            areas.iter().sum::<f64>() / SIZES.len() as f64
        };
        let (with, without) = (mean_m2(&self.tuned), mean_m2(&self.descent));
        let change = with / without - 1.0;
        let ours = format!(
            "{:+.0} % area (≤ ±10 %): {with:.1} m² with it among the parameters, {without:.1} without, mean of {} sizes",
            100.0 * change,
            SIZES.len()
        );
        measured(
            22,
            "little difference",
            (change, ours),
            &(-ALIKE..=ALIKE),
            0,
        )
    }

    /// Claim 23: what more than five components gain.
    fn compact(&self) -> Row {
        let area = |bytes| area_m2(&self.tuned, Method::Fourier, bytes);
        let larger = SIZES.iter().filter(|bytes| **bytes > COMPACT);
        let largest = larger.map(|bytes| area(*bytes)).fold(0.0, f64::max);
        let share = area(COMPACT) / largest;
        let ours = format!(
            "{:.1} m² at 10 B, {:.0} % of the largest at more (≥ 90 %); {:.1} at 6 B, {:.1} at 32 B",
            area(COMPACT),
            100.0 * share,
            area(6),
            area(PAPER_CROSSING)
        );
        measured(
            23,
            "10 B: five components",
            (share, ours),
            &(1.0 - ALIKE..=f64::INFINITY),
            0,
        )
    }

    /// Snapshots of all rooms.
    fn snapshots(&self) -> usize {
        let of_fourier = |row: &&catchment::Row| (row.method, row.bytes) == (METHODS[0], SIZES[0]);
        let rows = self.tuned.iter().filter(of_fourier);
        rows.map(|row| row.snapshots).sum()
    }
}

fn tasks(methods: &[Method]) -> Vec<Task> {
    let of_size = |bytes: u8| {
        methods.iter().map(move |method| Task {
            method: *method,
            bytes,
            heading_deg: 0.0,
        })
    };
    SIZES.iter().flat_map(|bytes| of_size(*bytes)).collect()
}

/// The settings of a task among which there is no Newton's step: plain descent alone.
fn descents(task: &Task) -> Vec<Settings> {
    let mut all = task.method.candidates(task.bytes, task.heading_deg);
    all.retain(|settings| match settings {
        Settings::Mfdid(parameters) => parameters.slope == Slope::Descent,
        _ => true,
    });
    all
}

/// Mean catchment area of a method and size over the rooms, m²; zero where it was not measured.
fn area_m2(rows: &[catchment::Row], method: Method, bytes: u8) -> f64 {
    let alike = rows
        .iter()
        .filter(|row| row.method == method && row.bytes == bytes);
    let (sum, count) = alike.fold((0.0, 0_u32), |(sum, count), row| {
        (sum + row.area_m2, count + 1)
    });
    sum / f64::from(count.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catchment::measure::row_of;

    /// A survey of one room in which the areas are these, by size.
    fn found(area_m2: impl Fn(Method, u8) -> f64, descent_m2: f64) -> Found {
        let all = tasks(&METHODS).into_iter();
        let tuned = all.map(|task| {
            let area_m2 = area_m2(task.method, task.bytes);
            row_of("room", task.method, task.bytes, [area_m2, 1.0])
        });
        let descent = SIZES.map(|bytes| row_of("room", Method::Mfdid, bytes, [descent_m2, 1.0]));
        Found {
            tuned: tuned.collect(),
            descent: descent.into(),
        }
    }

    /// As in the paper: Search passes Fourier between 24 and 48 bytes, MFDID is never ahead.
    fn as_in_the_paper(method: Method, bytes: u8) -> f64 {
        match method {
            Method::Fourier => 36.0,
            Method::Search => 30.0 + 0.2 * f64::from(bytes),
            _ => 20.0,
        }
    }

    /// As in the paper, but for one method at one size.
    fn paper_but(other: Method, at_bytes: u8, area_m2: f64) -> impl Fn(Method, u8) -> f64 {
        move |method, bytes| {
            if (method, bytes) == (other, at_bytes) {
                area_m2
            } else {
                as_in_the_paper(method, bytes)
            }
        }
    }

    fn kept(found: &Found) -> Vec<Option<bool>> {
        found.judged().iter().map(|row| row.kept).collect()
    }

    #[test]
    fn areas_as_in_the_paper_keep_all_four_claims() {
        let found = found(as_in_the_paper, 19.0);
        assert_eq!(kept(&found), [Some(true); 4]);
        let rows = found.judged();
        assert!(
            rows[0].ours.contains("at 4, 6, 8, 10, 16, 24 B"),
            "{rows:?}"
        );
        assert!(rows[0].ours.contains("30.0 bytes"), "{rows:?}");
        assert!(
            rows[1].ours.contains("fourier: 9.0 m² a byte at 4 B"),
            "{rows:?}"
        );
        assert!(rows[2].ours.contains("+5 %"), "{rows:?}");
        // One room of nine snapshots.
        assert!(rows.iter().all(|row| row.seeds == 9));
    }

    #[test]
    fn a_search_that_is_ahead_at_16_bytes_breaks_the_claim_of_32() {
        let ahead = paper_but(Method::Search, 16, 36.1);
        assert_eq!(kept(&found(ahead, 19.0))[0], Some(false));
        let behind = paper_but(Method::Search, 48, 35.9);
        assert_eq!(kept(&found(behind, 19.0))[0], Some(false));
    }

    #[test]
    fn another_method_with_more_area_a_byte_breaks_the_claim_of_fourier() {
        let other = paper_but(Method::Mfdid, 4, 36.1);
        assert_eq!(kept(&found(other, 19.0))[1], Some(false));
    }

    #[test]
    fn a_newton_that_gains_an_eighth_makes_a_difference() {
        assert_eq!(kept(&found(as_in_the_paper, 17.5))[2], Some(false));
    }

    #[test]
    fn components_beyond_the_fifth_that_gain_an_eighth_break_the_claim_of_five() {
        let grows = paper_but(Method::Fourier, 48, 41.0);
        assert_eq!(kept(&found(grows, 19.0))[3], Some(false));
    }

    #[test]
    fn without_newtons_step_only_the_gradient_is_left() {
        let task = tasks(&[Method::Mfdid])[4];
        let all = task.method.candidates(task.bytes, 0.0).len();
        assert_eq!(3 * descents(&task).len(), all);
    }
}
