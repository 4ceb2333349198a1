//! Numbers that can only hold what a world can be built from.

use serde::Deserialize;

/// Declares a number with a range; a value outside is refused while the file is read, at its line.
macro_rules! quantity {
    ($(#[$doc:meta])* $name:ident, $low:literal ..= $high:literal, $unit:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
        #[serde(try_from = "f64")]
        pub struct $name(f32);

        impl $name {
            /// The number itself.
            pub fn get(self) -> f32 {
                self.0
            }
        }

        impl TryFrom<f64> for $name {
            type Error = String;

            fn try_from(value: f64) -> Result<Self, String> {
                // NaN is in no range.
                if ($low..=$high).contains(&value) {
                    Ok(Self(value as f32))
                } else {
                    Err(format!("{value} is not within {}..={} {}", $low, $high, $unit))
                }
            }
        }
    };
}

quantity! {
    /// A coordinate in metres.
    Coordinate, -10_000.0..=10_000.0, "m"
}
quantity! {
    /// A length in metres: at least a millimetre.
    Length, 0.001..=10_000.0, "m"
}
quantity! {
    /// A factor on light or brightness.
    Level, 0.0..=1_000.0, "times"
}
quantity! {
    /// A part of a whole.
    Share, 0.0..=1.0, ""
}
quantity! {
    /// An angle in degrees.
    Degrees, -360.0..=360.0, "degrees"
}
quantity! {
    /// A time in seconds.
    Seconds, 0.0..=1_000_000.0, "s"
}
quantity! {
    /// A duration in seconds: not nothing.
    Duration, 0.001..=1_000_000.0, "s"
}
quantity! {
    /// A speed in metres a second.
    Speed, 0.001..=100.0, "m/s"
}

/// A point on the floor: x north, y west.
pub type Point = [Coordinate; 2];

/// The plain numbers of a point.
pub fn metres<const N: usize>(point: [Coordinate; N]) -> [f32; N] {
    point.map(Coordinate::get)
}

/// How many of something: one at least, a thousand at most.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "i64")]
pub struct Count(u16);

impl Count {
    /// The number itself.
    pub fn get(self) -> u16 {
        self.0
    }
}

impl TryFrom<i64> for Count {
    type Error = String;

    fn try_from(value: i64) -> Result<Self, String> {
        match u16::try_from(value) {
            Ok(count @ 1..=1_000) => Ok(Self(count)),
            _ => Err(format!("{value} is not within 1..=1000")),
        }
    }
}
