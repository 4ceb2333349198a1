//! Estimator and controller in the firmware's 1 kHz loop.

use crate::controller::{Controller, ControllerParameters, MotorCommands, SetPoint};
use crate::ekf::{Ekf, Estimate, ImuSample, Measurement, Parameters};
use crate::flying::FlyingDetector;

/// The flight stack below the app: sensors and a set-point in, motor commands out.
#[derive(Debug, Clone)]
pub struct Stabiliser {
    ekf: Ekf,
    controller: Controller,
    flying: FlyingDetector,
    motors: MotorCommands,
    lost: u64,
}

impl Stabiliser {
    /// A stabiliser on the ground whose first tick is at `now_ms`.
    #[must_use]
    pub fn new(filter: Parameters, controller: &ControllerParameters, now_ms: u64) -> Self {
        Self {
            ekf: Ekf::new(filter, now_ms),
            controller: Controller::new(controller),
            flying: FlyingDetector::default(),
            motors: MotorCommands::STOPPED,
            lost: 0,
        }
    }

    /// One millisecond at `now_ms`: the IMU sample and the measurements enter the filter's queue in this order, the
    /// filter makes its pass, the controller acts on the new estimate.
    ///
    /// The queue holds 20 entries, two of them the IMU's. Measurements beyond are lost, as in the firmware, and
    /// counted in [`Stabiliser::measurements_lost`].
    pub fn tick(
        &mut self,
        now_ms: u64,
        imu: &ImuSample,
        measurements: &[Measurement],
        set_point: &SetPoint,
    ) -> MotorCommands {
        for measurement in imu.measurements().iter().chain(measurements) {
            self.lost += u64::from(self.ekf.enqueue(*measurement).is_err());
        }
        let flying = self.flying.update(now_ms, &self.motors);
        self.ekf.tick(now_ms, flying);
        let estimate = self.ekf.estimate();
        self.motors = self
            .controller
            .tick(now_ms, &estimate, &imu.gyro_deg_s, set_point);
        self.motors
    }

    /// The filter's estimate after the last tick.
    #[must_use]
    pub fn estimate(&self) -> Estimate {
        self.ekf.estimate()
    }

    /// The filter, to read its covariance or count its resets.
    #[must_use]
    pub fn ekf(&self) -> &Ekf {
        &self.ekf
    }

    /// Asks for a reset of the filter at the next tick.
    pub fn request_filter_reset(&mut self) {
        self.ekf.request_reset();
    }

    /// Measurements that found the filter's queue full.
    #[must_use]
    pub fn measurements_lost(&self) -> u64 {
        self.lost
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::ekf::Position;

    const AT_REST: ImuSample = ImuSample {
        gyro_deg_s: Vector3::new(0.0, 0.0, 0.0),
        acc_g: Vector3::new(0.0, 0.0, 1.0),
    };

    fn stabiliser() -> Stabiliser {
        Stabiliser::new(Parameters::default(), &ControllerParameters::default(), 0)
    }

    #[test]
    fn motors_stand_still_until_a_set_point_holds_a_position() {
        let mut stabiliser = stabiliser();
        let off = stabiliser.tick(0, &AT_REST, &[], &SetPoint::MotorsOff);
        assert_eq!(off, MotorCommands::STOPPED);
        let hold = SetPoint::Hold {
            position_m: Vector3::new(0.0, 0.0, 0.5),
            yaw_rad: 0.0,
        };
        let on = (1..=10).fold(off, |_, now_ms| {
            stabiliser.tick(now_ms, &AT_REST, &[], &hold)
        });
        assert!(on.largest() > 30_000);
    }

    #[test]
    fn measurements_beyond_the_queue_are_lost_and_counted() {
        let mut stabiliser = stabiliser();
        let fix = Measurement::Position(Position {
            position_m: Vector3::zeros(),
            sd_m: 0.1,
        });
        stabiliser.tick(0, &AT_REST, &[fix; 18], &SetPoint::MotorsOff);
        assert_eq!(stabiliser.measurements_lost(), 0);
        stabiliser.tick(1, &AT_REST, &[fix; 19], &SetPoint::MotorsOff);
        assert_eq!(stabiliser.measurements_lost(), 1);
    }

    #[test]
    fn a_reset_takes_the_estimate_back_to_the_origin() {
        let mut stabiliser = stabiliser();
        let fix = Measurement::Position(Position {
            position_m: Vector3::new(2.0, -1.0, 0.0),
            sd_m: 0.01,
        });
        stabiliser.tick(0, &AT_REST, &[fix], &SetPoint::MotorsOff);
        assert!(stabiliser.estimate().position_m.x > 1.99);
        stabiliser.request_filter_reset();
        stabiliser.tick(1, &AT_REST, &[], &SetPoint::MotorsOff);
        assert_eq!(stabiliser.estimate().position_m, Vector3::zeros());
        assert_eq!(stabiliser.ekf().resets(), 1);
    }
}
