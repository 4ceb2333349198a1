//! How far apart snapshots are taken along odometry.

use std::str::FromStr;

use pilot::SPACING_BY_THEORY;

/// What it is called where people ask for it.
const AUTO: &str = "auto";

/// From one snapshot to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spacing {
    /// Always the same.
    Every(Distance),
    /// As far as odometry leads, on the way back, from one into the catchment of the next with a stated
    /// probability ([`nav::navigator::Drift`]): the firmware finds the distance for each snapshot.
    ByTheory,
}

/// A length in the firmware's unit of 0.1 m, so that it can be asked for on the link without rounding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Distance {
    decimetres: u8,
}

/// A text is no spacing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("from 0.2 to 10 metres in steps of 0.1, or `auto`")]
pub struct NoSpacing;

impl Distance {
    /// From metres; `None` unless a multiple of 0.1 m within 0.2..=10 m.
    pub fn from_metres(metres: f64) -> Option<Self> {
        // Closer than 0.2 m there is no odometry between snapshots; beyond 10 m an odometry vector
        // of 12.7 m at most could not span a leg.
        let decimetres = metres * 10.0;
        let whole = (decimetres - decimetres.round()).abs() < 1e-6;
        (whole && (0.2..=10.0).contains(&metres)).then(|| Self {
            decimetres: decimetres.round() as u8,
        })
    }

    /// In metres.
    pub fn metres(self) -> f64 {
        f64::from(self.decimetres) / 10.0
    }
}

impl Spacing {
    /// 2 m: what the paper's routes have where it says nothing else.
    pub const DEFAULT: Self = Self::Every(Distance { decimetres: 20 });

    /// From metres, as [`Distance::from_metres`].
    pub fn from_metres(metres: f64) -> Option<Self> {
        Distance::from_metres(metres).map(Self::Every)
    }

    /// What the first argument of a command asks for; `None` where it asks for nothing that there is.
    pub fn from_argument(argument: u8) -> Option<Self> {
        match argument {
            SPACING_BY_THEORY => Some(Self::ByTheory),
            decimetres => Self::from_metres(f64::from(decimetres) / 10.0),
        }
    }

    /// The first argument of the command that asks for it.
    pub fn argument(self) -> u8 {
        match self {
            Self::Every(distance) => distance.decimetres,
            Self::ByTheory => SPACING_BY_THEORY,
        }
    }
}

/// Metres, or `auto`.
impl FromStr for Spacing {
    type Err = NoSpacing;

    fn from_str(text: &str) -> Result<Self, NoSpacing> {
        if text == AUTO {
            return Ok(Self::ByTheory);
        }
        let metres = text.parse().map_err(|_| NoSpacing)?;
        Self::from_metres(metres).ok_or(NoSpacing)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spacing_is_tenths_of_a_metre_or_the_firmwares_to_find() {
        let metres = |text: &str| match text.parse() {
            Ok(Spacing::Every(distance)) => Some(distance.metres()),
            Ok(Spacing::ByTheory) | Err(NoSpacing) => None,
        };
        assert_eq!(["0.2", "7.5", "10"].map(metres), [0.2, 7.5, 10.0].map(Some));
        for nonsense in ["0.1", "10.1", "0.25", "-1", "nan", "", "Auto"] {
            assert_eq!(nonsense.parse::<Spacing>(), Err(NoSpacing), "{nonsense}");
        }
        assert_eq!("auto".parse(), Ok(Spacing::ByTheory));
    }

    #[test]
    fn the_link_carries_every_spacing_there_and_back() {
        for argument in (2..=100).chain([255]) {
            let spacing = Spacing::from_argument(argument);
            assert_eq!(spacing.map(Spacing::argument), Some(argument));
        }
        assert_eq!(Spacing::from_argument(255), Some(Spacing::ByTheory));
        assert_eq!([0, 1, 101, 254].map(Spacing::from_argument), [None; 4]);
    }
}
