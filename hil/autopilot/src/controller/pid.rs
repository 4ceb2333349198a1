//! The firmware's PID controller (`pid`).

use core::f32::consts::{PI, SQRT_2};

use super::PidGains;

/// Cut-off of the filter on the derivative.
const DERIVATIVE_CUTOFF_HZ: f32 = 20.0;

/// A PID controller with the derivative taken of the measurement, so that a step of the set-point does not kick.
#[derive(Debug, Clone)]
pub struct Pid {
    gains: PidGains,
    dt_s: f32,
    /// Errors are taken the short way around a circle of this many units.
    circle: Option<f32>,
    integral: f32,
    last_measured: Option<f32>,
    derivative: LowPass,
}

impl Pid {
    /// A controller that runs every `dt_s` seconds.
    pub fn new(gains: &PidGains, dt_s: f32) -> Self {
        Self {
            gains: *gains,
            dt_s,
            circle: None,
            integral: 0.0,
            last_measured: None,
            derivative: LowPass::new(DERIVATIVE_CUTOFF_HZ, 1.0 / dt_s),
        }
    }

    /// The same for an angle in degrees.
    pub fn around_the_circle(self) -> Self {
        Self {
            circle: Some(360.0),
            ..self
        }
    }

    /// One step.
    pub fn update(&mut self, wanted: f32, measured: f32) -> f32 {
        let gains = self.gains;
        let error = self.difference(wanted, measured);
        let step = self.difference(measured, self.last_measured.unwrap_or(measured));
        self.last_measured = Some(measured);
        let slope = self.derivative.tick(-step / self.dt_s);
        self.integral =
            (self.integral + error * self.dt_s).clamp(-gains.integral_limit, gains.integral_limit);
        let output =
            gains.proportional * error + gains.integral * self.integral + gains.derivative * slope;
        output.clamp(-gains.output_limit, gains.output_limit)
    }

    fn difference(&self, a: f32, b: f32) -> f32 {
        let plain = a - b;
        match self.circle {
            Some(circle) => plain - circle * libm::roundf(plain / circle),
            None => plain,
        }
    }
}

/// A second-order Butterworth low-pass (bilinear transform, transposed direct form II).
#[derive(Debug, Clone)]
struct LowPass {
    outer: f32,
    first: f32,
    second: f32,
    memory: [f32; 2],
}

impl LowPass {
    fn new(cutoff_hz: f32, sampling_hz: f32) -> Self {
        let warped = libm::tanf(PI * cutoff_hz / sampling_hz);
        let square = warped * warped;
        let norm = 1.0 + SQRT_2 * warped + square;
        Self {
            outer: square / norm,
            first: -2.0 * (square - 1.0) / norm,
            second: -(1.0 - SQRT_2 * warped + square) / norm,
            memory: [0.0; 2],
        }
    }

    fn tick(&mut self, input: f32) -> f32 {
        let [next, after] = self.memory;
        let output = input * self.outer + next;
        self.memory = [
            input * (2.0 * self.outer) + output * self.first + after,
            input * self.outer + output * self.second,
        ];
        output
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gains() -> PidGains {
        PidGains {
            proportional: 0.0,
            integral: 0.0,
            derivative: 0.0,
            integral_limit: 10.0,
            output_limit: 100.0,
        }
    }

    #[test]
    fn the_integral_stops_at_its_limit_and_the_output_at_its_own() {
        let integrating = PidGains {
            integral: 2.0,
            ..gains()
        };
        let mut pid = Pid::new(&integrating, 0.1);
        assert!((pid.update(5.0, 0.0) - 1.0).abs() < 1e-6);
        for _ in 0..100 {
            pid.update(5.0, 0.0);
        }
        assert!((pid.update(5.0, 0.0) - 20.0).abs() < 1e-6);
        let steep = PidGains {
            proportional: 1000.0,
            ..gains()
        };
        assert_eq!(Pid::new(&steep, 0.1).update(-1.0, 0.0), -100.0);
    }

    #[test]
    fn the_derivative_settles_to_the_slope_of_the_measurement_and_ignores_steps_of_the_set_point() {
        let damping = PidGains {
            derivative: 1.0,
            ..gains()
        };
        let mut pid = Pid::new(&damping, 0.002);
        let settled = (0_u16..200).fold(0.0, |_, k| pid.update(0.0, 0.006 * f32::from(k)));
        assert!((settled + 3.0).abs() < 1e-3, "{settled}");
        let mut pid = Pid::new(&damping, 0.002);
        pid.update(0.0, 1.0);
        assert_eq!(pid.update(50.0, 1.0), 0.0);
    }

    #[test]
    fn an_angle_turns_the_short_way() {
        let turning = PidGains {
            proportional: 1.0,
            ..gains()
        };
        let mut pid = Pid::new(&turning, 0.002).around_the_circle();
        assert!((pid.update(-170.0, 170.0) - 20.0).abs() < 1e-4);
        assert!((pid.update(170.0, -170.0) + 20.0).abs() < 1e-4);
    }
}
