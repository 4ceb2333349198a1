use std::sync::LazyLock;

use super::*;
use crate::parallel;

/// Rendered once for all tests.
static SCENES: LazyLock<Vec<Scene>> = LazyLock::new(|| Scene::all().unwrap());

fn scene(name: &str) -> &'static Scene {
    SCENES.iter().find(|scene| scene.name == name).unwrap()
}

#[test]
fn the_coarse_grid_is_met_everywhere_and_every_condition_has_a_solution() {
    let conditions = Grid::coarse().conditions(&SCENES);
    let outcomes = parallel::map(
        &conditions,
        |condition| expose(condition, scene(condition.scene)).unwrap(),
        |_| (),
    );
    let verdict = Verdict::of(&outcomes);
    let worst = worst(&outcomes, 3);
    assert!(
        verdict.holds() && verdict.unreachable == 0,
        "{verdict:?}: {worst:?}"
    );
    assert_eq!(verdict.conditions, SCENES.len() * 4 * 3 * 3 * 2);
}

#[test]
fn the_grid_spans_three_decades_of_light_and_all_of_shutter_and_gain() {
    let conditions = Grid::whole().conditions(&SCENES);
    let lights = conditions.iter().map(|condition| condition.needs_lines);
    let (low, high) = (
        lights.clone().fold(f64::MAX, f64::min),
        lights.fold(0.0, f64::max),
    );
    assert!((high / low - 1000.0).abs() < 1e-6);
    let starts = |lines, gain| {
        let is = |c: &&Condition| c.initial_lines == lines && c.initial_gain == gain;
        conditions.iter().filter(is).count()
    };
    assert!(starts(1, 1.0) > 0 && starts(525, 16.0) > 0);
}

fn outcome(lumas: Vec<f64>) -> Outcome {
    Outcome {
        condition: Grid::whole().conditions(&SCENES)[0].clone(),
        is_reachable: true,
        lumas,
    }
}

#[test]
fn a_condition_is_met_by_frame_10_and_all_after_it() {
    let held_from = |frame: usize| {
        outcome(
            (1..=30)
                .map(|n| if n < frame { 200.0 } else { 82.9 })
                .collect(),
        )
    };
    assert_eq!(held_from(1).frames(), 1);
    assert_eq!(held_from(10).frames(), 10);
    assert!(Verdict::of(&[held_from(10)]).holds());
    assert!(!Verdict::of(&[held_from(10), held_from(11)]).holds());
    let mut late = held_from(4);
    late.lumas[29] = 83.1;
    assert_eq!(late.frames(), 31);
    assert!((late.error() - 3.1).abs() < 1e-9);
    let dark = Outcome {
        is_reachable: false,
        ..held_from(1)
    };
    assert!(!Verdict::of(&[dark]).holds() && !Verdict::of(&[]).holds());
}

#[test]
fn the_picture_has_a_curve_for_each_of_the_worst() {
    let (late, early) = (outcome(vec![255.0; 30]), outcome(vec![80.0; 30]));
    let outcomes = [early, late.clone()];
    assert_eq!(worst(&outcomes, 1), [&late]);
    let svg = picture(&worst(&outcomes, 6));
    assert_eq!(svg.matches("line curve").count(), 4);
    assert!(svg.contains("holds from frame 31") && !svg.contains("NaN"));
}
