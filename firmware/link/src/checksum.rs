//! The two-byte checksum of a pprzlink frame: Fletcher's sums modulo 256 (RFC 1146, appendix I).

/// The sums over the bytes from the length byte to the last body byte, in the order they are sent.
pub(crate) fn checksum(bytes: &[u8]) -> [u8; 2] {
    bytes.iter().fold([0, 0], |[a, b], byte| {
        let a = a.wrapping_add(*byte);
        [a, b.wrapping_add(a)]
    })
}

#[cfg(test)]
mod tests {
    use super::checksum;

    #[test]
    fn the_follow_command_sums_to_27_90() {
        // Worked by hand: A runs 0a 0a 0a 0f 15 27 27, B runs 0a 14 1e 2d 42 69 90.
        let covered = [0x0a, 0x00, 0x00, 0x05, 0x06, 0x12, 0x00];
        assert_eq!(checksum(&covered), [0x27, 0x90]);
    }
}
