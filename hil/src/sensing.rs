//! Between the truth, the fake motion sensors and the filter: the same quantities under each room's own names.

use autopilot::ekf::{Flow, ImuSample, Measurement, Range};
use autopilot::vehicle::Truth;
use fake_sensors::motion::{MotionReadings, MotionTruth};

/// What the sensors are to see.
pub fn motion_truth(truth: &Truth) -> MotionTruth {
    MotionTruth {
        position_m: truth.position_m,
        velocity_m_s: truth.velocity_m_s,
        attitude: truth.attitude,
        angular_rate_rad_s: truth.angular_rate_rad_s,
        specific_force_m_s2: truth.specific_force_m_s2,
    }
}

/// What the IMU has for the filter.
pub fn imu_sample(readings: &MotionReadings) -> ImuSample {
    ImuSample {
        gyro_deg_s: readings.imu.gyro_deg_s,
        acc_g: readings.imu.acc_g,
    }
}

/// What the deck's sensors have for the filter: flow, then range.
pub fn deck_measurements(readings: &MotionReadings) -> impl Iterator<Item = Measurement> {
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
    flow.into_iter().chain(range)
}
