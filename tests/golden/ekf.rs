//! The filter against two sequences recorded from the Crazyflie firmware's own filter core.

use std::path::Path;

use autopilot::ekf::Parameters;
use autopilot::ekf::replay::{Limits, Recording, deviation};

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
