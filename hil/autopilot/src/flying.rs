//! Whether the propellers carry the drone (`supervisor`).

use crate::controller::{IDLE_THRUST, MotorCommands};

/// How long the drone counts as flying after its motors were last above idle, ms.
const HYSTERESIS_MS: u64 = 2000;

/// Remembers when the motors last turned faster than idle.
#[derive(Debug, Clone, Default)]
pub struct FlyingDetector {
    last_thrust_ms: Option<u64>,
}

impl FlyingDetector {
    /// Takes the newest motor commands; tells whether the drone flies.
    pub fn update(&mut self, now_ms: u64, commands: &MotorCommands) -> bool {
        if commands.largest() > IDLE_THRUST {
            self.last_thrust_ms = Some(now_ms);
        }
        self.last_thrust_ms
            .is_some_and(|last| now_ms.saturating_sub(last) < HYSTERESIS_MS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drone_flies_from_the_first_thrust_above_idle_until_two_seconds_after_the_last() {
        let mut detector = FlyingDetector::default();
        assert!(!detector.update(0, &MotorCommands([IDLE_THRUST; 4])));
        assert!(detector.update(10, &MotorCommands([0, 0, 0, IDLE_THRUST + 1])));
        assert!(detector.update(2009, &MotorCommands::STOPPED));
        assert!(!detector.update(2010, &MotorCommands::STOPPED));
    }
}
