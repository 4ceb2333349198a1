//! What a flight is up against: faults, the autopilot's ways, and the weather.

use std::ops::RangeInclusive;

use autopilot::app::{CorrectionSd, Quirks};
use clap::ValueEnum;
use fake_sensors::motion::ScaleSwing;
use serde::{Deserialize, Serialize, Serializer};

use super::{CameraTrouble, LensPage};

/// The wind of the strongest gale, m/s (Beaufort 12 begins at 32.7 m/s).
pub const STRONGEST_WIND_M_S: f64 = 32.0;
/// The lamps' strengths that a flight may have, over that of the world's own: the range that the sensor's
/// exposure spans about the first one.
pub const LIGHTS: RangeInclusive<f32> = 0.001..=1_000.0;

/// Largest share of the flow sensor's scale by which it may swing in time.
pub const LARGEST_SWING: f64 = 0.5;
/// Periods of that swing, s: from what a drone flies by in a moment to a long flight.
pub const SWING_PERIODS_S: RangeInclusive<f64> = 1.0..=10_000.0;

/// Nothing out of the ordinary, by default.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Conditions {
    /// Share of the link's bytes, both ways, that arrive as another byte, 0..=1.
    pub corrupted_share: f64,
    /// When the autopilot restarts, seconds of flight.
    pub restart_s: Option<f64>,
    /// The flight app's peculiarities on the link; in a summary, the names of those it has.
    #[serde(serialize_with = "names")]
    pub quirks: Quirks,
    /// How firmly the autopilot's filter believes the camera.
    pub correction: Correction,
    /// The wind; none for still air.
    pub wind: Option<Wind>,
    /// All lamps' strength over that of the world's own, which the firmware's first exposure suits.
    pub light: f32,
    /// What the flow sensor's scale does in time, besides the constant error that each seed draws.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "swing")]
    pub flow_scale: Option<ScaleSwing>,
    /// Whether a pilot who sees the drone leads it on the way out; else it flies the route as its odometry has it, and
    /// after a hundred metres far beside the places that the route names.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub piloted: bool,
    /// Something wrong with the camera's wires for a while; an emulated board has wires.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub camera: Option<CameraTrouble>,
    /// What the flash page of the lens record holds; none where it is erased.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lens: Option<LensPage>,
}

impl Default for Conditions {
    fn default() -> Self {
        Self {
            corrupted_share: 0.0,
            restart_s: None,
            quirks: Quirks::default(),
            correction: Correction::default(),
            wind: None,
            light: 1.0,
            flow_scale: None,
            piloted: false,
            camera: None,
            lens: None,
        }
    }
}

/// How firmly the autopilot's filter is told to believe a correction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Correction {
    /// All but overwrites the estimate: 0.001 m, 0.002 rad (the published app since May 2023)
    #[default]
    Overwrite,
    /// Averages positions and hardly touches the heading: 0.5 m, 0.17 rad (August 2022)
    Soft,
}

impl Correction {
    /// The standard deviations that the app gives its filter.
    pub fn sd(self) -> CorrectionSd {
        match self {
            Self::Overwrite => CorrectionSd::OVERWRITE,
            Self::Soft => CorrectionSd::SOFT,
        }
    }
}

/// A horizontal wind from a direction that the flight's seed draws.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Wind {
    /// Mean speed, m/s.
    pub mean_m_s: f64,
    /// Turbulence intensity: standard deviation of the horizontal components over the mean speed.
    pub turbulence: f64,
}

impl Wind {
    /// `None` unless the mean is from 0 to [`STRONGEST_WIND_M_S`] and the turbulence from 0 to 1.
    pub fn new(mean_m_s: f64, turbulence: f64) -> Option<Self> {
        let blows = (0.0..=STRONGEST_WIND_M_S).contains(&mean_m_s);
        (blows && (0.0..=1.0).contains(&turbulence)).then_some(Self {
            mean_m_s,
            turbulence,
        })
    }
}

/// `None` unless the amplitude is from 0 to [`LARGEST_SWING`] and the period within [`SWING_PERIODS_S`].
pub fn flow_scale(amplitude: f64, period_s: f64) -> Option<ScaleSwing> {
    let swings = (0.0..=LARGEST_SWING).contains(&amplitude);
    (swings && SWING_PERIODS_S.contains(&period_s)).then_some(ScaleSwing {
        amplitude,
        period_s,
    })
}

/// A peculiarity of the published flight app on the link, by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quirk {
    /// Takes its own command for the camera's echo: sends each one once
    SelfAcknowledge,
    /// Handles the last message of the cycle before once more
    StackLeftovers,
    /// Handles the last message again where nothing came
    RepeatsLastMessage,
    /// Never uses what the tenth receive call of a cycle brings
    DropsTenthMessage,
    /// Has room for 200 bytes
    ShortBuffer,
    /// Reads in the air what came on the ground
    KeepsGroundBytes,
    /// Finds frames as the generated C receiver does
    PublishedReceiver,
    /// Hands every number on, NaN as well
    UncheckedValues,
}

impl Quirk {
    /// Its switch.
    pub fn of(self, quirks: &mut Quirks) -> &mut bool {
        match self {
            Self::SelfAcknowledge => &mut quirks.self_acknowledge,
            Self::StackLeftovers => &mut quirks.stack_leftovers,
            Self::RepeatsLastMessage => &mut quirks.repeats_last_message,
            Self::DropsTenthMessage => &mut quirks.drops_tenth_message,
            Self::ShortBuffer => &mut quirks.short_buffer,
            Self::KeepsGroundBytes => &mut quirks.keeps_ground_bytes,
            Self::PublishedReceiver => &mut quirks.published_receiver,
            Self::UncheckedValues => &mut quirks.unchecked_values,
        }
    }
}

fn swing<S: Serializer>(swing: &Option<ScaleSwing>, serializer: S) -> Result<S::Ok, S::Error> {
    let parts = swing.map(|swing| [("amplitude", swing.amplitude), ("period_s", swing.period_s)]);
    serializer.collect_map(parts.into_iter().flatten())
}

/// The peculiarities that are switched on, by their names on the command line.
fn names<S: Serializer>(quirks: &Quirks, serializer: S) -> Result<S::Ok, S::Error> {
    let mut quirks = *quirks;
    let on = Quirk::value_variants()
        .iter()
        .filter(|quirk| *quirk.of(&mut quirks))
        .filter_map(Quirk::to_possible_value);
    serializer.collect_seq(on.map(|value| value.get_name().to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_summary_names_the_quirks_that_are_switched_on() {
        let mut conditions = Conditions {
            quirks: Quirks::NONE,
            ..Conditions::default()
        };
        for quirk in Quirk::value_variants() {
            *quirk.of(&mut conditions.quirks) = true;
            let json = serde_json::to_value(conditions).expect("JSON");
            let name = quirk.to_possible_value().expect("a name");
            assert_eq!(json["quirks"], serde_json::json!([name.get_name()]));
            *quirk.of(&mut conditions.quirks) = false;
        }
    }
}
