//! Cosines as 16-bit integers, for tables that the compiler fills.

/// Parts of 1.
pub(crate) const ONE: f64 = 8192.0;

/// cos(n 2π/256) in parts of 2^13, rounded to the nearest.
pub(crate) const fn cosine(n: usize) -> i16 {
    let n = n % 256;
    let (from_axis, sign) = match n {
        0..=64 => (n, 1.0),
        65..=128 => (128 - n, -1.0),
        129..=192 => (n - 128, -1.0),
        _ => (256 - n, 1.0),
    };
    let angle = from_axis as f64 * (core::f64::consts::TAU / 256.0);
    // Taylor's series within a quarter turn: the first term left out is (π/2)^14 / 14! = 6e-9.
    let square = angle * angle;
    let mut rest = 0.0;
    let mut order = 12.0;
    while order > 0.0 {
        rest = (rest + 1.0) * -square / (order * (order - 1.0));
        order -= 2.0;
    }
    // The cast cuts off, and the cosine within a quarter turn is not negative.
    let parts = ((1.0 + rest) * ONE + 0.5) as i16;
    if sign > 0.0 { parts } else { -parts }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cosine_is_off_by_half_a_part_at_most_all_round() {
        for n in 0..600 {
            let exact = libm::cos(n as f64 * (core::f64::consts::TAU / 256.0)) * ONE;
            assert!((f64::from(cosine(n)) - exact).abs() < 0.501, "{n}");
        }
    }
}
