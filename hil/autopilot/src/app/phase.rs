//! Where a flight is, and how it ended.

/// What the app is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// Motors off, before take-off. The link is silent.
    Ground,
    /// From the reset of the filter to the hover. The link is silent.
    TakeOff,
    /// Flying the script up to where the camera leads.
    Recording,
    /// Flying where the camera leads.
    Following,
    /// On the way down. The link is silent.
    Landing,
    /// Motors off, for good.
    Landed(Outcome),
}

/// Why a flight ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The script was flown to its end.
    Completed,
    /// Following, or the whole flight, took longer than its limit.
    TimedOut,
    /// The camera did not echo a command within the limit.
    NoEcho,
    /// The estimated position was too far from the origin.
    FenceBreached,
    /// The estimated height was above the ceiling.
    TooHigh,
    /// The filter's position was no number.
    PositionLost,
    /// The camera sent a target or a correction that is no number or beyond all reason.
    /// ([`Quirks::unchecked_values`](super::Quirks): the published app hands it on to controller and
    /// filter.)
    BrokenMessage,
    /// The radio link to the operator was down.
    RadioLost,
    /// The battery was low.
    BatteryLow,
    /// The operator asked to land.
    LandCommanded,
    /// The operator stopped the motors.
    Killed,
}
