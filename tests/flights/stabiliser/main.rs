//! Filter, controller, vehicle and motion sensors together, without camera or link.

mod closed_loop;
mod corrections;
mod drift;
mod listening;

use autopilot::controller::SetPoint;
use autopilot::ekf::{Flow, ImuSample, Measurement, Range};
use autopilot::vehicle::{Truth, Vehicle, VehicleParameters};
use fake_sensors::motion::{MotionReadings, MotionTruth};
use nalgebra::Vector3;

fn sensed(truth: &Truth) -> MotionTruth {
    MotionTruth {
        position_m: truth.position_m,
        velocity_m_s: truth.velocity_m_s,
        attitude: truth.attitude,
        angular_rate_rad_s: truth.angular_rate_rad_s,
        specific_force_m_s2: truth.specific_force_m_s2,
    }
}

fn imu(readings: &MotionReadings) -> ImuSample {
    ImuSample {
        gyro_deg_s: readings.imu.gyro_deg_s,
        acc_g: readings.imu.acc_g,
    }
}

fn measurements(readings: &MotionReadings) -> Vec<Measurement> {
    let flow = readings.flow.map(|flow| {
        Measurement::Flow(Flow {
            counts: flow.counts.map(f32::from),
            dt_s: flow.dt_s,
            sd_counts: flow.sd_counts,
        })
    });
    let range = readings.range.map(|range| {
        Measurement::Range(Range {
            distance_m: range.distance_m,
            sd_m: range.sd_m,
        })
    });
    flow.into_iter().chain(range).collect()
}

fn standing() -> Vehicle {
    Vehicle::standing_at(VehicleParameters::default(), Vector3::zeros(), 0.0)
}

fn hold(x: f64, y: f64, z: f64, yaw_rad: f64) -> SetPoint {
    SetPoint::Hold {
        position_m: Vector3::new(x, y, z).cast(),
        yaw_rad: yaw_rad as f32,
    }
}

/// From zero at `from_s` to one at `to_s`.
fn ramp(t_s: f64, from_s: f64, to_s: f64) -> f64 {
    ((t_s - from_s) / (to_s - from_s)).clamp(0.0, 1.0)
}
