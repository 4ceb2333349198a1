//! What a homing correction does to the estimate in flight.

use autopilot::ekf::{Measurement, Position, YawError};
use fake_sensors::motion::SensorModel;
use hil::drift::OpenLoop;
use nalgebra::Vector3;

/// What one homing correction did to the estimate.
#[derive(Clone, Copy, Debug, Default)]
struct Taken {
    /// Shares of the correction of position and yaw.
    position: f32,
    yaw: f32,
    /// Sudden change of the velocity in the world, m/s, and of the pitch, degrees.
    kick_m_s: f32,
    pitch_deg: f32,
}

/// Sends a correction by (+0.20, -0.10) m and 0.10 rad and lets the filter take it.
fn correct(flight: &mut OpenLoop, sd_m: f32, sd_rad: f32) -> Taken {
    let shift = Vector3::new(0.2, -0.1, 0.0);
    let before = flight.ekf.estimate();
    let fix = Position {
        position_m: before.position_m + shift,
        sd_m,
    };
    let turn = YawError {
        error_rad: 0.1,
        sd_rad,
    };
    for measurement in [Measurement::Position(fix), Measurement::YawError(turn)] {
        flight.ekf.enqueue(measurement).expect("room for six");
    }
    flight.step();
    let after = flight.ekf.estimate();
    let moved = after.position_m - before.position_m;
    let pitch_deg = after.legacy_euler().pitch_deg - before.legacy_euler().pitch_deg;
    Taken {
        position: moved.dot(&shift) / shift.norm_squared(),
        yaw: (before.yaw_rad() - after.yaw_rad()) / 0.1,
        kick_m_s: (after.velocity_m_s - before.velocity_m_s).norm(),
        pitch_deg: pitch_deg.abs(),
    }
}

/// Three corrections from 4 s into the leg on, `gap_ms` apart, and what each did: the mean over a few flights.
fn correct_thrice(sd_m: f32, sd_rad: f32, gap_ms: u64) -> [Taken; 3] {
    const FIRST_MS: u64 = 10_005;
    const FLIGHTS: u64 = 6;
    let mut mean = [Taken::default(); 3];
    for seed in 1..=FLIGHTS {
        let mut flight = OpenLoop::new(&SensorModel::default(), seed);
        for (index, mean) in (0..).zip(&mut mean) {
            flight.run_until(FIRST_MS + index * gap_ms);
            let taken = correct(&mut flight, sd_m, sd_rad);
            let share = 1.0 / FLIGHTS as f32;
            mean.position += taken.position * share;
            mean.yaw += taken.yaw * share;
            mean.kick_m_s += taken.kick_m_s * share;
            mean.pitch_deg += taken.pitch_deg * share;
        }
    }
    mean
}

#[track_caller]
fn assert_near(what: &str, found: f32, measured: f32, tolerance: f32) {
    assert!(
        (found - measured).abs() <= tolerance,
        "{what}: {found}, the firmware's {measured}"
    );
}

#[test]
fn hard_corrections_are_taken_whole_unless_they_follow_at_once() {
    // As measured on the firmware's filter, one flight.
    let [first, later, _] = correct_thrice(0.001, 0.002, 5000);
    for (taken, kick_m_s) in [(first, 0.04), (later, 0.06)] {
        assert_near("position", taken.position, 1.0, 0.01);
        assert_near("yaw", taken.yaw, 0.98, 0.01);
        assert_near("kick", taken.kick_m_s, kick_m_s, 0.03);
    }
    let [_, soon, _] = correct_thrice(0.001, 0.002, 1000);
    assert_near("position after 1 s", soon.position, 1.0, 0.01);
    assert_near("yaw after 1 s", soon.yaw, 0.78, 0.03);
    assert_near("kick after 1 s", soon.kick_m_s, 0.31, 0.06);
    // Two contradictory fixes at once leave it to the manoeuvre in between what gives way: the next and the one after
    // it stand on either side of the measured one.
    let [_, next, after] = correct_thrice(0.001, 0.002, 100);
    assert!(
        after.position < 0.85 && 0.78 < next.position,
        "{next:?} {after:?}"
    );
    assert_near("yaw at once", next.yaw, 0.56, 0.03);
    assert!(
        after.kick_m_s < 1.3 && 1.3 < next.kick_m_s,
        "{next:?} {after:?}"
    );
    assert_near("pitch at once", next.pitch_deg, 10.0, 3.0);
}

#[test]
fn soft_corrections_average_and_hardly_touch_the_heading() {
    // As measured on the firmware's filter: shares of position and yaw of the first, the second 5 s later, the third.
    for (sd_m, sd_rad, measured, kick_m_s) in [
        (0.1, 0.2, [(1.0, 0.005), (0.54, 0.03), (0.43, 0.05)], 0.01),
        (
            0.5,
            0.17,
            [(0.998, 0.006), (0.50, 0.009), (0.34, 0.012)],
            0.002,
        ),
    ] {
        let found = correct_thrice(sd_m, sd_rad, 5000);
        for (taken, (position, yaw)) in found.iter().zip(measured) {
            assert_near("position", taken.position, position, 0.02);
            assert_near("yaw", taken.yaw, yaw, 0.1 * yaw + 5e-4);
            assert!(taken.kick_m_s < kick_m_s, "kick {}", taken.kick_m_s);
        }
    }
}
