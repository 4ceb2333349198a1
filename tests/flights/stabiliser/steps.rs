//! Step responses and the hover, held against what the gains predict and against the limits of `budgets.toml`.
//!
//! | step | 10-90 % | predicted | overshoot | within 5 % | fastest | tilt |
//! |---|---|---|---|---|---|---|
//! | x 0.5 m | 0.53 s | 0.55 s | 3.8 % | 1.79 s | 0.90 m/s | 16 deg |
//! | x 1 m | 0.82 s | 0.79 s | 3.1 % | 1.32 s | 1.17 m/s | 18 deg |
//! | x 2 m | 1.57 s | 1.50 s | 2.3 % | 2.19 s | 1.17 m/s | 18 deg |
//! | z 0.3 m | 0.67 s | 0.66 s | 8.2 % | 3.69 s | 0.51 m/s | 0 deg |
//! | yaw 90 deg | 0.30 s | 0.34 s | 4.3 % | 0.47 s | 340 deg/s | 0 deg |

use autopilot::vehicle::VehicleParameters;
use fake_sensors::motion::SensorModel;
use fake_sensors::wind::WindModel;
use hil::steps::{self, Axis, Figures, Hover, Response, STEPS};
use tests::Budgets;

/// All steps, flown.
fn responses() -> Vec<Response> {
    STEPS.into_iter().map(steps::fly).collect()
}

fn flown(response: &Response) -> Figures {
    response
        .flown
        .unwrap_or_else(|| panic!("{:?} is not reached", response.step))
}

/// What the speed limit of 1.0 m/s and a tenth allows.
const SPEED_LIMIT_M_S: f64 = 1.1;

#[test]
fn the_drone_answers_steps_as_its_gains_predict() {
    let budgets = Budgets::load();
    for response in responses() {
        let step = response.step;
        assert!(
            response.is_as_predicted(),
            "{step:?}: {:?} flown, {:?} predicted, {:.3} apart",
            response.flown,
            response.predicted,
            response.distance
        );
        let figures = flown(&response);
        budgets.hold("step_overshoot", figures.overshoot);
        budgets.hold("step_settling_s", figures.settling_s);
        budgets.hold("step_tilt_deg", response.tilt_deg);
        if step.axis != Axis::X {
            assert!(response.tilt_deg < 0.5, "{step:?} leans the drone");
        }
    }
}

#[test]
fn long_steps_are_flown_at_the_speed_limit_and_short_ones_below() {
    for response in responses() {
        let Figures {
            fastest, rise_s, ..
        } = flown(&response);
        match (response.step.axis, response.step.size) {
            // 2.0 /s times the step, before drag and tilt take their part.
            (Axis::X | Axis::Z, size) if 2.0 * size < SPEED_LIMIT_M_S => {
                assert!(fastest < 2.0 * size, "{size} m at {fastest} m/s");
            }
            (Axis::X | Axis::Z, size) => {
                assert!((1.0..1.1).contains(&(fastest / SPEED_LIMIT_M_S)));
                // Eight tenths of the way cannot be faster, and at 2 m little is lost at its ends.
                let least_s = 0.8 * size / fastest;
                assert!(rise_s > least_s, "{size} m in {rise_s} s");
                assert!(
                    size < 2.0 || rise_s < 1.2 * least_s,
                    "{size} m in {rise_s} s"
                );
            }
            (Axis::Yaw, size) => assert!(fastest < 6.0 * size, "{fastest} deg/s"),
        }
    }
}

/// The mean of five hovers of ten seconds with the nominal sensors.
fn hover(drone: VehicleParameters) -> Hover {
    let hovers: Vec<Hover> = (1..=5)
        .map(|seed| {
            let (sensors, air) = (SensorModel::default(), WindModel::calm());
            steps::hover(drone, &sensors, &air, seed, 10.0)
        })
        .collect();
    Hover::over(&hovers)
}

#[test]
fn the_hover_is_as_still_as_the_sensors_allow() {
    let budgets = Budgets::load();
    let hover = hover(VehicleParameters::default());
    budgets.hold("hover_error_m", hover.estimate_rms_m);
    budgets.hold("hover_height_error_m", hover.height_rms_m);
    budgets.hold("hover_tilt_rms_deg", hover.tilt_rms_deg);
    // In truth it strays as dead reckoning does: some 10 cm in the first twenty seconds.
    assert!(hover.position_rms_m < 0.25, "{}", hover.position_rms_m);
    // A hover that does not move at all has forgotten its sensors.
    assert!(hover.estimate_rms_m > 0.005 && hover.tilt_rms_deg > 0.2);
}

#[test]
fn neither_motors_nor_drag_of_other_measurements_change_the_hover() {
    let assumed = hover(VehicleParameters::default());
    // 50 ms and 0.67 1/s are what others state for the Brushless; 80 ms is the slowest fit.
    for (motor_time_constant_s, drag_per_s) in [(0.05, 0.22), (0.08, 0.67)] {
        let measured = hover(VehicleParameters {
            motor_time_constant_s,
            drag_per_s,
            ..VehicleParameters::default()
        });
        for (a, b) in [
            (measured.estimate_rms_m, assumed.estimate_rms_m),
            (measured.height_rms_m, assumed.height_rms_m),
            (measured.tilt_rms_deg, assumed.tilt_rms_deg),
        ] {
            assert!((a / b - 1.0).abs() < 0.2, "{a} against {b}");
        }
    }
}
