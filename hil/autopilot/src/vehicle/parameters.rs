//! The drone's body and motors.

use nalgebra::Vector3;

/// Gravity as the firmware rounds it, m/s²: the filter, the sensors and the vehicle agree.
pub const GRAVITY_M_S2: f64 = 9.81;
/// Take-off mass with camera board, lens and flow deck in the paper this project follows, kg.
pub const PAPER_MASS_KG: f64 = 0.056;
/// Mass of the Crazyflie 2.1 Brushless as sold, kg (`CF_MASS` of its platform).
pub const STOCK_MASS_KG: f64 = 0.0393;

/// Mass the inertia below was identified at, kg.
const IDENTIFIED_MASS_KG: f64 = 0.043_38;
/// Moments of inertia of a Crazyflie 2.1 Brushless, kg m² (University of Toronto Learning Systems and Robotics Lab,
/// `drone-models`, `cf21B_500`).
const IDENTIFIED_INERTIA_KG_M2: Vector3<f64> = Vector3::new(25e-6, 28e-6, 49e-6);
/// Reaction torque per thrust, m (same source; the firmware's platform file has 0.005 69).
const TORQUE_PER_THRUST_M: f64 = 0.005_94;
/// Distance of the motors from the body's axes, m: arms of 50 mm at 45°.
const MOTOR_OFFSET_M: f64 = 0.035_355;
/// Time constant of the thrust, s. Assumed: what is published for the Brushless is no motor alone and scatters, 50 ms
/// (RotorPy's `crazyfliebrushless_params`, after Gräfe et al. 2026) and 80 ms (`drone-models`, from whole flights);
/// brushed Crazyflies are simulated with 5 to 30 ms.
const MOTOR_TIME_CONSTANT_S: f64 = 0.025;
/// Linear drag over mass, 1/s: the order of Förster's rotor drag (ETH Zürich 2015: 9.2e-7 kg times the rotors' speeds,
/// 0.23 1/s for a brushed Crazyflie in hover). A Brushless may feel more: 0.50 1/s and a quadratic part
/// (`drone-models`), and 0.67 1/s at 56 g with propeller guards (RotorPy's `crazyfliebrushless_params`, after Folk
/// 2026). Drag of the body, quadratic in the wind, is left out.
const DRAG_PER_S: f64 = 0.22;
/// The controller's command in hover, as a share of the full command (`DEFAULT_BASE_THRUST` 30000 of 65535).
const HOVER_SHARE: f64 = 30_000.0 / 65_535.0;

/// What distinguishes one drone from another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VehicleParameters {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Moments of inertia about the body's axes, kg m².
    pub inertia_kg_m2: Vector3<f64>,
    /// Distance of each motor from the body's x and y axes, m.
    pub motor_offset_m: f64,
    /// Thrust of one motor at full command, N. Thrust is linear in the command: the firmware linearises it.
    pub full_thrust_n: f64,
    /// Reaction torque per thrust, m.
    pub torque_per_thrust_m: f64,
    /// Time constant of the thrust, s.
    pub motor_time_constant_s: f64,
    /// Linear drag over mass, 1/s.
    pub drag_per_s: f64,
}

impl VehicleParameters {
    /// A Crazyflie Brushless of the given mass: inertia grows with it, and the motors are chosen so that the
    /// controller's base thrust carries it (0.21 N at full command at 39.3 g, 0.30 N at 56 g).
    #[must_use]
    pub fn crazyflie_brushless(mass_kg: f64) -> Self {
        Self {
            mass_kg,
            inertia_kg_m2: IDENTIFIED_INERTIA_KG_M2 * (mass_kg / IDENTIFIED_MASS_KG),
            motor_offset_m: MOTOR_OFFSET_M,
            full_thrust_n: mass_kg * GRAVITY_M_S2 / (4.0 * HOVER_SHARE),
            torque_per_thrust_m: TORQUE_PER_THRUST_M,
            motor_time_constant_s: MOTOR_TIME_CONSTANT_S,
            drag_per_s: DRAG_PER_S,
        }
    }
}

impl Default for VehicleParameters {
    /// The paper's drone.
    fn default() -> Self {
        Self::crazyflie_brushless(PAPER_MASS_KG)
    }
}
