//! The filter against two sequences recorded from the Crazyflie firmware's own filter core.

use std::path::Path;

use autopilot::ekf::replay::{Action, Event, Limits, Recording, deviation, replay};
use autopilot::ekf::{Estimate, Measurement, Parameters};

/// The firmware exports its angles in degrees: the attitude's limit in that unit.
const LEGACY_ANGLE_LIMIT_DEG: f32 = Limits::FIRMWARE.attitude_rad * 180.0 / core::f32::consts::PI;
/// Four covariances were recorded beside the nine variances: the same limit, as a share of the deviations' product.
const CORRELATION_LIMIT: f32 = Limits::FIRMWARE.variance_share;

fn recording(name: &str) -> Recording {
    let prefix = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("golden/data/ekf")
        .join(name);
    Recording::load(&prefix).unwrap_or_else(|error| panic!("{error}"))
}

fn assert_follows(name: &str, seconds: usize) {
    let found =
        deviation(&recording(name), Parameters::default()).expect("the events fit the queue");
    assert_eq!(found.compared, 100 * seconds, "one state every 10 ms");
    assert!(found.within(&Limits::FIRMWARE), "{name}: {found:?}");
    assert!(
        found.legacy_angle_deg.value <= LEGACY_ANGLE_LIMIT_DEG
            && found.correlation.value <= CORRELATION_LIMIT,
        "{name}: {found:?}"
    );
}

#[test]
fn the_filter_follows_the_firmware_through_a_hover_with_range_outliers() {
    assert_follows("g1_hover", 20);
}

#[test]
fn the_filter_follows_the_firmware_through_a_line_with_a_homing_correction() {
    assert_follows("g2_line_corr", 16);
}

#[test]
fn a_filter_with_another_initial_yaw_does_not_follow() {
    let turned = Parameters {
        initial_yaw_rad: 0.01,
        ..Parameters::default()
    };
    let found = deviation(&recording("g2_line_corr"), turned).expect("the events fit the queue");
    assert!(!found.within(&Limits::FIRMWARE));
    assert!(found.attitude_rad.value > 0.009);
}

/// The filter's estimates through a recording, one a millisecond.
fn estimates(recording: &Recording) -> Vec<Estimate> {
    let mut estimates = Vec::new();
    replay(recording, Parameters::default(), |_, ekf| {
        estimates.push(ekf.estimate());
    })
    .expect("the events fit the queue");
    estimates
}

/// The ticks at which the hover's range sensor read so far.
fn ranges_of(recording: &Recording, distance_m: f32) -> Vec<usize> {
    let ranges = recording.events.iter().filter(|event| {
        matches!(event.action, Action::Measure(Measurement::Range(range)) if (range.distance_m - distance_m).abs() < 1e-3)
    });
    ranges.map(|event| event.tick_ms as usize).collect()
}

#[test]
fn a_single_range_of_two_metres_throws_the_estimate_up_for_a_third_of_a_second() {
    let hover = recording("g1_hover");
    let [tick] = ranges_of(&hover, 2.0)[..] else {
        panic!("one range of 2 m")
    };
    let estimates = estimates(&hover);
    let jump = |of: fn(&Estimate) -> f32| of(&estimates[tick]) - of(&estimates[tick - 1]);
    let [z, vz] = [jump(|e| e.position_m.z), jump(|e| e.velocity_m_s.z)];
    assert!((z - 0.33).abs() < 0.02, "height by {z} m");
    assert!((vz - 2.0).abs() < 0.2, "climb rate by {vz} m/s");
    let back = &estimates[tick + 300].position_m;
    assert!((back.z - 0.5).abs() < 0.05, "then at {} m", back.z);
}

#[test]
fn a_range_beyond_the_sensors_trust_hardly_moves_the_estimate() {
    let hover = recording("g1_hover");
    let [tick] = ranges_of(&hover, 4.2)[..] else {
        panic!("one range of 4.2 m")
    };
    let estimates = estimates(&hover);
    let moved = estimates[tick].position_m.z - estimates[tick - 1].position_m.z;
    assert!(moved > 0.0 && moved < 0.001, "{moved} m");
}

#[test]
fn three_short_ranges_pull_the_estimate_down_step_by_step() {
    let hover = recording("g1_hover");
    let mut ticks = ranges_of(&hover, 0.1);
    ticks.retain(|tick| *tick > 14_000);
    let estimates = estimates(&hover);
    let heights: Vec<f32> = ticks
        .iter()
        .map(|tick| estimates[*tick].position_m.z)
        .collect();
    assert_eq!(heights.len(), 3);
    // The recorded filter up to 3 ms later: it falls on at 0.7 to 1.5 m/s.
    for (height, recorded) in heights.iter().zip([0.391, 0.287, 0.205]) {
        assert!((height - recorded).abs() < 0.005, "{heights:?}");
    }
}

#[test]
fn a_reset_in_flight_sends_the_height_below_the_ground_until_the_next_ranges() {
    // The height starts at zero with a variance of one and the velocity with one of 1e-4: flow of a moving drone turns
    // into height first. The last range was 1 ms ago, the next comes 30 ms later.
    let mut line = recording("g2_line_corr");
    const RESET_MS: usize = 7006;
    let place = line
        .events
        .partition_point(|event| event.tick_ms < RESET_MS as u64);
    line.events.insert(
        place,
        Event {
            tick_ms: RESET_MS as u64,
            action: Action::Reset,
        },
    );
    let heights: Vec<f32> = estimates(&line)[RESET_MS..]
        .iter()
        .map(|estimate| estimate.position_m.z)
        .collect();
    let lowest = heights.iter().copied().fold(f32::MAX, f32::min);
    let below_ms = heights.iter().filter(|z| **z < 0.0).count();
    assert!((lowest + 2.0).abs() < 0.5, "{lowest} m");
    // At most until the next range.
    assert!((10..=30).contains(&below_ms), "{below_ms} ms");
    assert!(heights[29] < 0.0 && heights[30] > 0.4, "{heights:?}");
}
