//! Numbers for people: fixed precision, true minus signs, grouped thousands.

/// What stands where there is no number.
pub const NONE: &str = "–";

/// A number with so many decimals.
pub fn fixed(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return NONE.to_owned();
    }
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.bytes().all(|byte| matches!(byte, b'0' | b'.')) => digits.to_owned(),
        Some(digits) => format!("\u{2212}{digits}"),
        None => text,
    }
}

/// A number with at most so many decimals, without trailing zeros.
pub fn trimmed(value: f64, decimals: usize) -> String {
    let text = fixed(value, decimals);
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

/// A signed count with a true minus sign.
pub fn signed(value: i8) -> String {
    fixed(f64::from(value), 0)
}

/// A count in groups of three, by narrow spaces that do not break.
pub fn grouped(value: u64) -> String {
    let digits = value.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

/// Two hexadecimal digits of a stored byte.
pub fn hex(byte: u8) -> String {
    format!("{byte:02X}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_are_grouped_from_the_right() {
        assert_eq!(grouped(7), "7");
        assert_eq!(grouped(708), "708");
        assert_eq!(grouped(168_000), "168\u{202f}000");
        assert_eq!(grouped(1_234_567), "1\u{202f}234\u{202f}567");
    }

    #[test]
    fn trailing_zeros_are_trimmed_behind_the_point_only() {
        assert_eq!(trimmed(2.0, 2), "2");
        assert_eq!(trimmed(0.25, 2), "0.25");
        assert_eq!(trimmed(10.0, 0), "10");
    }

    #[test]
    fn zero_has_no_sign_and_no_number_is_a_dash() {
        assert_eq!(fixed(-0.001, 2), "0.00");
        assert_eq!(fixed(-1.5, 1), "\u{2212}1.5");
        assert_eq!(fixed(f64::NAN, 1), NONE);
    }
}
