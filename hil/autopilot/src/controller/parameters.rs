//! Gains and limits. The defaults are those of the Crazyflie 2.1 Brushless (`platform_defaults_cf21bl`, unchanged
//! from commit b2756664 of June 2023 to 2a18fc29).

/// The least command of a turning motor (`DEFAULT_IDLE_THRUST`). Above it the drone counts as flying.
pub const IDLE_THRUST: u16 = 7000;

/// One PID controller's numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PidGains {
    /// Output per unit of error.
    pub proportional: f32,
    /// Output per unit of error and second.
    pub integral: f32,
    /// Output per unit of error per second.
    pub derivative: f32,
    /// The integral of the error stays within plus and minus this.
    pub integral_limit: f32,
    /// The output stays within plus and minus this.
    pub output_limit: f32,
}

impl PidGains {
    const fn new(proportional: f32, integral: f32, derivative: f32) -> Self {
        Self {
            proportional,
            integral,
            derivative,
            // `DEFAULT_PID_INTEGRATION_LIMIT`: never reached in flight.
            integral_limit: 5000.0,
            output_limit: f32::INFINITY,
        }
    }

    const fn integral_within(self, integral_limit: f32) -> Self {
        Self {
            integral_limit,
            ..self
        }
    }

    const fn output_within(self, output_limit: f32) -> Self {
        Self {
            output_limit,
            ..self
        }
    }
}

/// Gains about roll, pitch and yaw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axes {
    /// Roll and pitch.
    pub tilt: PidGains,
    /// Yaw.
    pub yaw: PidGains,
}

/// Everything a platform changes about the cascade.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ControllerParameters {
    /// Position to velocity, x and y: m to m/s.
    pub position_xy: PidGains,
    /// Height to climb rate: m to m/s.
    pub position_z: PidGains,
    /// Velocity to tilt, x and y: m/s to degrees.
    pub velocity_xy: PidGains,
    /// Climb rate to thrust: m/s to thousands of command counts.
    pub velocity_z: PidGains,
    /// Tilts asked for stay within plus and minus this, degrees.
    pub tilt_limit_deg: f32,
    /// Attitude to rate: degrees to deg/s.
    pub attitude: Axes,
    /// Rate to torque: deg/s to command counts.
    pub rate: Axes,
    /// The command that should carry the drone.
    pub base_thrust: f32,
    /// The least command asked for in flight.
    pub min_thrust: f32,
}

impl Default for ControllerParameters {
    fn default() -> Self {
        // Velocity limit 1.0 m/s with the firmware's overhead of a tenth.
        const MAX_SPEED_M_S: f32 = 1.1;
        Self {
            position_xy: PidGains::new(2.0, 0.0, 0.0).output_within(MAX_SPEED_M_S),
            position_z: PidGains::new(2.0, 0.5, 0.0).output_within(MAX_SPEED_M_S),
            velocity_xy: PidGains::new(25.0, 1.0, 0.0).output_within(22.0),
            velocity_z: PidGains::new(25.0, 15.0, 0.0).output_within(32.767),
            tilt_limit_deg: 20.0,
            attitude: Axes {
                tilt: PidGains::new(6.0, 3.0, 0.0).integral_within(20.0),
                yaw: PidGains::new(6.0, 1.0, 0.35).integral_within(360.0),
            },
            rate: Axes {
                tilt: PidGains::new(200.0, 400.0, 2.5).integral_within(33.3),
                yaw: PidGains::new(120.0, 16.7, 0.0).integral_within(166.7),
            },
            base_thrust: 30_000.0,
            min_thrust: 20_000.0,
        }
    }
}
