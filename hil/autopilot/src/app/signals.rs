//! What the app knows of the operator's switches and of the drone, besides the estimate.

/// The operator's switches and the drone's health.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Signals {
    /// The operator's enable switch (`vh.SW_ENABLE`): without it the drone does not take off, or lands.
    pub enabled: bool,
    /// The app runs and talks to the camera, the motors stand still (`db_dryrun`): for a drone that
    /// is carried by hand. Counts at the moment in which the drone would take off; needs no enable
    /// switch.
    pub dry_run: bool,
    /// Whether the radio link to the operator is up.
    pub radio_up: bool,
    /// Whether the battery is low.
    pub battery_low: bool,
}

impl Default for Signals {
    /// All is well, and the operator wants to fly.
    fn default() -> Self {
        Self {
            enabled: true,
            dry_run: false,
            radio_up: true,
            battery_low: false,
        }
    }
}
