//! Optical flow of the ground (`mm_flow`).

use nalgebra::Vector3;

use crate::ekf::parameters::FlowParameters;
use crate::ekf::state::{POSITION, State, VELOCITY};
use crate::ekf::update::Sensitivity;

/// Counts of the flow sensor over one interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flow {
    /// Counts along the body's x and y axes, in the signs of the flow deck's driver.
    pub counts: [f32; 2],
    /// Length of the interval, s.
    pub dt_s: f32,
    /// Standard deviation of a count: the driver states 2.0.
    pub sd_counts: f32,
}

impl Flow {
    /// Two updates, x then y. The second predicts with the state the first has corrected, but with the velocity and
    /// height read before it. The attitude is left out of both Jacobians.
    pub(in crate::ekf) fn correct(
        &self,
        state: &mut State,
        angular_rate: &Vector3<f32>,
        geometry: &FlowParameters,
    ) {
        let cos_tilt = state.rotation[(2, 2)];
        let height = state.position.z.max(geometry.min_height_m);
        let velocity = state.velocity;
        let pixels_per_rad = self.dt_s * geometry.pixels / geometry.field_of_view_rad;
        // Translation along +x and pitching about +y move the image in opposite senses, +y and roll in the same.
        let turning = [-angular_rate.y, angular_rate.x];

        for axis in 0..2 {
            let moving = velocity[axis] * cos_tilt / height;
            let predicted = pixels_per_rad * (moving + turning[axis]);
            let measured = self.counts[axis] * geometry.pixels_per_count;
            let row = [
                Sensitivity {
                    state: POSITION + 2,
                    slope: -pixels_per_rad * moving / height,
                },
                Sensitivity {
                    state: VELOCITY + axis,
                    slope: pixels_per_rad * cos_tilt / height,
                },
            ];
            let sd = self.sd_counts * geometry.pixels_per_count;
            state.scalar_update(&row, measured - predicted, sd);
        }
    }
}
