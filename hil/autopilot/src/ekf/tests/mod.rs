//! Claims about the filter from its equations, for what the recorded sequences leave out.

mod against_oracle;
mod models;
mod motion;
mod oracle;
mod replay;
mod task;

use nalgebra::{UnitQuaternion, Vector3};

use super::state::{Covariance, State};
use super::{Ekf, ImuSample, Parameters};

/// A level IMU at rest.
const AT_REST: ImuSample = ImuSample {
    gyro_deg_s: Vector3::new(0.0, 0.0, 0.0),
    acc_g: Vector3::new(0.0, 0.0, 1.0),
};

/// A state with every part non-zero and a dense covariance.
fn busy_state() -> State {
    let mut state = State::initial(&Parameters::default());
    state.position = Vector3::new(1.0, -2.0, 0.6);
    state.velocity = Vector3::new(0.5, -0.3, 0.1);
    state.attitude = UnitQuaternion::from_euler_angles(0.1, -0.15, 0.8);
    state.rotation = state.attitude.to_rotation_matrix().into_inner();
    let root = Covariance::from_fn(|i, j| 0.02 * ((i * 7 + j * 5) % 11) as f32 - 0.09);
    state.covariance = root * root.transpose() + Covariance::identity() * 0.01;
    state
}

/// Runs the filter with a resting IMU from `from_ms` for `ticks` ms.
fn rest(ekf: &mut Ekf, from_ms: u64, ticks: u64, flying: bool) {
    for now_ms in from_ms..from_ms + ticks {
        for measurement in AT_REST.measurements() {
            ekf.enqueue(measurement).expect("an empty queue");
        }
        ekf.tick(now_ms, flying);
    }
}
