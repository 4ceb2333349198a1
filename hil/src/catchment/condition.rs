//! What may differ between the time a snapshot is taken and the time it is homed to.

use std::fmt;
use std::str::FromStr;

use serde::{Serialize, Serializer};

/// A condition that hurts; one at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Condition {
    /// Nothing differs: the paper's comparison.
    None,
    /// The heading is known to so many degrees to either side.
    Heading(f32),
    /// A lamp stands on one side of the room that was not there: things are brighter and darker by
    /// this share at either end.
    Light(f32),
    /// Luma of normal noise on each bearing of the current view.
    Noise(f32),
    /// Roll and pitch of the current view, each up to so many degrees to either side.
    Tilt(f32),
    /// The current view is from so many metres higher.
    Height(f32),
    /// Somebody walks by, 1 to 2.5 m away.
    Person,
    /// The six things that stand about are elsewhere.
    Furniture,
}

/// The conditions that tables are made of.
pub const TABLE: [Condition; 10] = [
    Condition::None,
    Condition::Heading(10.0),
    Condition::Heading(30.0),
    Condition::Light(0.5),
    Condition::Noise(3.0),
    Condition::Tilt(10.0),
    Condition::Height(0.3),
    Condition::Height(-0.3),
    Condition::Person,
    Condition::Furniture,
];

impl Condition {
    /// How far the heading may be off, degrees.
    pub fn heading_deg(self) -> f32 {
        match self {
            Self::Heading(degrees) => degrees,
            _ => 0.0,
        }
    }

    /// Whether it can be made from pictures that are already taken.
    pub fn suits_pictures(self) -> bool {
        matches!(self, Self::None | Self::Heading(_) | Self::Noise(_))
    }
}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => f.write_str("none"),
            Self::Heading(degrees) => write!(f, "heading:{degrees}"),
            Self::Light(share) => write!(f, "light:{share}"),
            Self::Noise(luma) => write!(f, "noise:{luma}"),
            Self::Tilt(degrees) => write!(f, "tilt:{degrees}"),
            Self::Height(metres) => write!(f, "height:{metres}"),
            Self::Person => f.write_str("person"),
            Self::Furniture => f.write_str("furniture"),
        }
    }
}

impl FromStr for Condition {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, value) = match text.split_once(':') {
            Some((name, value)) => (name, Some(value)),
            None => (text, None),
        };
        let number = |usual: f32, least: f32, most: f32| match value {
            None => Ok(usual),
            Some(value) => value
                .parse()
                .ok()
                .filter(|number| (least..=most).contains(number))
                .ok_or_else(|| format!("{name}: a number from {least} to {most}, not `{value}`")),
        };
        match name {
            "none" if value.is_none() => Ok(Self::None),
            "person" if value.is_none() => Ok(Self::Person),
            "furniture" if value.is_none() => Ok(Self::Furniture),
            "heading" => number(30.0, 0.0, 180.0).map(Self::Heading),
            "light" => number(0.5, 0.0, 0.9).map(Self::Light),
            "noise" => number(3.0, 0.0, 100.0).map(Self::Noise),
            "tilt" => number(10.0, 0.0, 30.0).map(Self::Tilt),
            "height" => number(0.3, -2.0, 2.0).map(Self::Height),
            _ => Err(format!(
                "`{text}`: none of none, heading:DEGREES, light:SHARE, noise:LUMA, tilt:DEGREES, \
                 height:METRES, person, furniture"
            )),
        }
    }
}

impl Serialize for Condition {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_condition_is_read_as_it_is_written() {
        for condition in TABLE {
            assert_eq!(condition.to_string().parse(), Ok(condition));
        }
        assert_eq!("tilt".parse(), Ok(Condition::Tilt(10.0)));
    }

    #[test]
    fn what_is_no_condition_is_refused_with_its_name() {
        for bad in [
            "fog",
            "heading:200",
            "heading:x",
            "noise:NaN",
            "person:2",
            "",
        ] {
            let refusal = bad.parse::<Condition>().unwrap_err();
            let name = bad.split(':').next().unwrap();
            assert!(refusal.contains(name), "{refusal}");
        }
    }
}
