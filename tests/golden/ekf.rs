//! The filter against two sequences recorded from the Crazyflie firmware's own filter core.

use std::path::Path;

use autopilot::ekf::Parameters;
use autopilot::ekf::replay::{Deviation, Recording, deviation};

/// Limits for an implementation in other arithmetic: the firmware's table of sines alone costs 2e-5 rad.
const LIMITS: Deviation = Deviation {
    compared: 0,
    position_m: 5e-4,
    velocity_m_s: 2e-4,
    attitude_rad: 1e-4,
    // The attitude limit in degrees, the unit of the exported angles.
    legacy_angle_deg: 1e-4 * 180.0 / core::f32::consts::PI,
    variance_share: 1e-3,
    correlation: 1e-3,
};

fn assert_follows(name: &str, seconds: usize) {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden/data/ekf");
    let recording = Recording::load(&directory, name).unwrap_or_else(|error| panic!("{error}"));
    let found = deviation(&recording, Parameters::default()).expect("the events fit the queue");
    assert_eq!(found.compared, 100 * seconds, "one state every 10 ms");
    for (what, value, limit) in [
        ("position [m]", found.position_m, LIMITS.position_m),
        ("velocity [m/s]", found.velocity_m_s, LIMITS.velocity_m_s),
        ("attitude [rad]", found.attitude_rad, LIMITS.attitude_rad),
        (
            "legacy angles [deg]",
            found.legacy_angle_deg,
            LIMITS.legacy_angle_deg,
        ),
        ("variances", found.variance_share, LIMITS.variance_share),
        ("covariances", found.correlation, LIMITS.correlation),
    ] {
        assert!(
            value <= limit,
            "{name}: {what} off by {value}, limit {limit}"
        );
    }
}

#[test]
fn the_filter_follows_the_firmware_through_a_hover_with_range_outliers() {
    assert_follows("g1_hover", 20);
}

#[test]
fn the_filter_follows_the_firmware_through_a_line_with_a_homing_correction() {
    assert_follows("g2_line_corr", 16);
}
