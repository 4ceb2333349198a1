//! The two-byte checksum of a pprzlink frame: Fletcher's sums modulo 256 (RFC 1146, appendix I).

/// The sums over the bytes from the length byte to the last body byte, in the order they are sent.
pub(crate) fn checksum(bytes: &[u8]) -> [u8; 2] {
    // In words, whose lowest bytes are the same, and eight bytes at a time: half the cycles.
    let (eights, rest) = bytes.as_chunks::<8>();
    let sums = eights
        .iter()
        .fold([0, 0], |sums, eight| eight.iter().fold(sums, add));
    rest.iter().fold(sums, add).map(|sum| sum as u8)
}

fn add([a, b]: [u32; 2], byte: &u8) -> [u32; 2] {
    let a = a.wrapping_add(u32::from(*byte));
    [a, b.wrapping_add(a)]
}

#[cfg(test)]
mod tests {
    use super::checksum;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_sums_are_fletchers_however_many_bytes_there_are(
            bytes in proptest::collection::vec(any::<u8>(), 0..=255),
        ) {
            // RFC 1146: A is the sum of the bytes, B the sum of all that A has been.
            let total = |bytes: &[u8]| bytes.iter().map(|byte| u64::from(*byte)).sum::<u64>();
            let a = total(&bytes);
            let b: u64 = (1..=bytes.len()).map(|length| total(&bytes[..length])).sum();
            prop_assert_eq!(checksum(&bytes), [a, b].map(|sum| (sum % 256) as u8));
        }
    }

    #[test]
    fn the_follow_command_sums_to_27_90() {
        // Worked by hand: A runs 0a 0a 0a 0f 15 27 27, B runs 0a 14 1e 2d 42 69 90.
        let covered = [0x0a, 0x00, 0x00, 0x05, 0x06, 0x12, 0x00];
        assert_eq!(checksum(&covered), [0x27, 0x90]);
    }
}
