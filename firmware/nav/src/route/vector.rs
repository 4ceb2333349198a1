//! Odometry in two bytes.

use nalgebra::Vector2;

/// Metres of one count (paper, Fig. 8).
pub const ODOMETRY_RESOLUTION_M: f32 = 0.1;

/// The farthest that one byte reaches, counts.
const REACH: i32 = i8::MAX as i32;

/// A way of at most ±12.7 m along each axis, in counts of 0.1 m.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct OdometryVector {
    /// North, counts.
    pub x: i8,
    /// West, counts.
    pub y: i8,
}

impl OdometryVector {
    /// Bytes of a vector.
    pub const BYTES: usize = 2;

    /// The way, metres: north, west.
    pub fn metres(self) -> Vector2<f32> {
        Vector2::new(f32::from(self.x), f32::from(self.y)) * ODOMETRY_RESOLUTION_M
    }

    /// The stored form: north, west.
    pub const fn to_bytes(self) -> [u8; Self::BYTES] {
        [self.x.cast_unsigned(), self.y.cast_unsigned()]
    }
}

/// How many vectors a way takes: none if it is nothing.
pub(super) fn pieces_needed(way: [i32; 2]) -> usize {
    let longest = way[0].unsigned_abs().max(way[1].unsigned_abs());
    longest.div_ceil(REACH as u32) as usize
}

/// A way in as few vectors as it takes, all but equal, their sum exact.
pub(super) fn pieces(way: [i32; 2]) -> impl Iterator<Item = OdometryVector> {
    let total = pieces_needed(way) as i64;
    let share = move |axis: usize, done: i64| i64::from(way[axis]) * done / total;
    // No piece exceeds the reach: the way is at most total x reach along each axis.
    (0..total).map(move |index| OdometryVector {
        x: (share(0, index + 1) - share(0, index)) as i8,
        y: (share(1, index + 1) - share(1, index)) as i8,
    })
}
