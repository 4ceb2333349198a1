//! Why a flight must not go on.

use super::phase::Outcome;
use super::settings::Settings;
use super::signals::Signals;
use crate::ekf::Estimate;

/// What forbids to fly on, checked at the beginning of every cycle; `None` if all is well.
pub fn danger(
    settings: &Settings,
    signals: &Signals,
    dry_run: bool,
    estimate: &Estimate,
) -> Option<Outcome> {
    let position = estimate.position_m;
    if !position.iter().all(|coordinate| coordinate.is_finite()) {
        Some(Outcome::PositionLost)
    } else if !signals.enabled && !dry_run {
        Some(Outcome::LandCommanded)
    } else if libm::hypotf(position.x, position.y) >= settings.max_distance_m {
        Some(Outcome::FenceBreached)
    } else if position.z >= settings.max_height_m {
        Some(Outcome::TooHigh)
    } else {
        unfit(settings, signals)
    }
}

/// What keeps the drone on the ground before take-off, if anything.
pub fn forbids_take_off(settings: &Settings, signals: &Signals) -> bool {
    let wanted = signals.enabled || signals.dry_run;
    !wanted || unfit(settings, signals).is_some()
}

/// What is wrong with the drone itself.
fn unfit(settings: &Settings, signals: &Signals) -> Option<Outcome> {
    if settings.watches_radio && !signals.radio_up {
        Some(Outcome::RadioLost)
    } else if settings.watches_battery && signals.battery_low {
        Some(Outcome::BatteryLow)
    } else {
        None
    }
}
