use nav::methods::{Resolution, Search, SearchParameters, presets};

use super::condition::TABLE;
use super::grid::Grid;
use super::*;

/// The photographed lounge as a room of the paper's size.
fn lounge() -> Place {
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../fake-sensors/assets/lounge.hdr"
    );
    let named = format!("hdri:{file},7.3x6.9").parse().unwrap();
    thinned(Place::open(&named).unwrap(), 4)
}

/// A place with every so manieth position along both axes.
fn thinned(place: Place, stride: usize) -> Place {
    let fine = &place.grid;
    let [columns, rows] = [fine.columns, fine.rows].map(|count| count.div_ceil(stride));
    let free = |index: usize| {
        let [column, row] = [index % columns, index / columns].map(|n| n * stride);
        fine.free[row * fine.columns + column]
    };
    let grid = Grid {
        spacing_m: fine.spacing_m * stride as f32,
        columns,
        rows,
        free: (0..columns * rows).map(free).collect(),
        ..fine.clone()
    };
    Place { grid, ..place }
}

fn areas_m2(survey: &Survey, methods: &[Method], bytes: u8) -> Vec<f64> {
    let tasks: Vec<Task> = methods
        .iter()
        .map(|method| Task {
            method: *method,
            bytes,
            heading_deg: 0.0,
        })
        .collect();
    let settings = tune(&[survey], &tasks, |_| ());
    let rows = evaluate(survey, &tasks, &settings, "here", |_| ());
    rows.iter().map(|row| row.area_m2).collect()
}

#[test]
fn fourier_homes_from_farther_at_few_bytes_and_search_at_many() {
    let survey = Survey::take(&lounge(), Condition::None, 9, |_| ()).unwrap();
    let methods = [Method::Fourier, Method::Search, Method::Mfdid];
    let [fourier, search, mfdid] = areas_m2(&survey, &methods, 6)[..] else {
        panic!("a row for each method");
    };
    assert!(fourier > 1.3 * search, "6 bytes: {fourier}, {search}");
    assert!(fourier > 1.3 * mfdid, "6 bytes: {fourier}, {mfdid}");
    let [fourier, search] = areas_m2(&survey, &methods[..2], 32)[..] else {
        panic!("a row for each method");
    };
    assert!(search > fourier, "32 bytes: {fourier}, {search}");
}

#[test]
fn a_condition_changes_what_is_seen_and_not_what_is_remembered() {
    let place = thinned(lounge(), 3);
    let clean = Survey::take(&place, Condition::None, 4, |_| ()).unwrap();
    for condition in TABLE {
        let survey = Survey::take(&place, condition, 4, |_| ()).unwrap();
        let remembers_alike = clean
            .goals
            .iter()
            .zip(&survey.goals)
            .all(|(a, b)| a.view == b.view);
        // The furniture stands elsewhere at either time.
        assert_eq!(
            remembers_alike,
            condition != Condition::Furniture,
            "{condition}"
        );
        let currents = clean.currents.iter().zip(&survey.currents);
        let pairs: Vec<_> = currents
            .filter_map(|(a, b)| Some((a.as_ref()?, b.as_ref()?)))
            .collect();
        let changed = pairs.iter().filter(|(a, b)| a.view != b.view).count();
        if condition == Condition::None {
            assert_eq!(changed, 0);
        } else {
            assert!(changed > pairs.len() / 2, "{condition}: {changed}");
        }
        let farthest = pairs
            .iter()
            .map(|(_, b)| b.turn_rad.abs())
            .fold(0.0, f32::max);
        let bound = condition.heading_deg().to_radians();
        assert!(
            farthest <= bound && farthest >= 0.7 * bound,
            "{condition}: {farthest}"
        );
    }
}

#[test]
fn what_ships_is_not_tuned_and_what_is_tuned_says_where() {
    let survey = Survey::take(&thinned(lounge(), 3), Condition::None, 4, |_| ()).unwrap();
    let tasks = [Method::Default, Method::Fourier].map(|method| Task {
        method,
        bytes: 6,
        heading_deg: 0.0,
    });
    let settings = tune(&[&survey], &tasks, |_| ());
    assert_eq!(settings[0], Settings::Warp(settings::shipped(6, 0.0)));
    let rows = evaluate(&survey, &tasks, &settings, "the lounge", |_| ());
    let tuned_on: Vec<_> = rows.iter().map(|row| row.tuned_on.as_str()).collect();
    assert_eq!(tuned_on, ["shipped", "the lounge"]);
}

#[test]
fn the_searches_of_all_views_at_once_find_what_each_finds_alone() {
    let place = thinned(lounge(), 3);
    let survey = Survey::take(&place, Condition::Heading(30.0), 4, |_| ()).unwrap();
    for resolution in [Resolution::Memory, Resolution::Full] {
        let parameters = SearchParameters {
            rotations: 2,
            ..presets::search(10, resolution)
        };
        let alone = measure::vectors(&survey, &Search::new(parameters));
        let at_once = measure::vectors_with(&survey, &Settings::Search(parameters));
        assert!(at_once[0].moves.iter().any(Option::is_some));
        assert_eq!(at_once, alone, "{resolution:?}");
    }
}
