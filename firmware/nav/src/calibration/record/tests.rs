extern crate std;

use std::{vec, vec::Vec};

use proptest::prelude::*;

use super::*;

const LAYOUT: FrameLayout = FrameLayout::SUBQCIF_UYVY;

/// A record whose bytes were changed by `tamper`, with a checksum that is right again.
fn sealed(tamper: impl FnOnce(&mut [u8; RECORD_BYTES])) -> [u8; RECORD_BYTES] {
    let mut record = encode(&LensCalibration::DEFAULT, &LAYOUT);
    tamper(&mut record);
    let sum = checksum(&record);
    record[CHECKED_BYTES..].copy_from_slice(&sum.to_le_bytes());
    record
}

/// A lens that fits a 128 x 96 frame.
fn lenses() -> impl Strategy<Value = LensCalibration> {
    (
        (44.0_f32..84.0, 44.0_f32..52.0),
        (1.0_f32..20.0, 0.1_f32..24.0, 0.0_f32..=1.0),
        (0.01_f32..3.1, -10.0_f32..10.0),
        (any::<bool>(), any::<bool>()),
    )
        .prop_map(|(centre_px, (inner, span, horizon), angles, flags)| {
            let outer_radius_px = inner + span;
            LensCalibration {
                centre_px,
                inner_radius_px: inner,
                outer_radius_px,
                horizon_radius_px: (inner + span * horizon).min(outer_radius_px),
                vertical_field_rad: angles.0,
                zero_bearing_rad: angles.1,
                direction: if flags.0 {
                    BearingDirection::Clockwise
                } else {
                    BearingDirection::CounterClockwise
                },
                inner_is_up: flags.1,
            }
        })
}

#[test]
fn the_bytes_are_those_of_the_documented_table() {
    let mut expected: Vec<u8> = b"LENS".to_vec();
    // Version 1, 48 bytes, 128 x 96.
    expected.extend([1, 0, 48, 0, 128, 0, 96, 0]);
    // IEEE 754 of 64, 48, 18, 42, 30, π/2, -π/2.
    for bits in [
        0x4280_0000_u32,
        0x4240_0000,
        0x4190_0000,
        0x4228_0000,
        0x41f0_0000,
        0x3fc9_0fdb,
        0xbfc9_0fdb,
    ] {
        expected.extend(bits.to_le_bytes());
    }
    expected.extend([0, 1, 0, 0]);
    let record = encode(&LensCalibration::DEFAULT, &LAYOUT);
    assert_eq!(record[..44], expected[..]);
}

/// The check value of the catalogue of parametrised CRC algorithms.
#[test]
fn the_checksum_is_crc_32_iso_hdlc() {
    assert_eq!(CRC.checksum(b"123456789"), 0xcbf4_3926);
}

#[test]
fn an_erased_page_is_empty_and_no_damaged_record() {
    assert_eq!(decode(&[0xff; 4096], &LAYOUT), Err(RecordError::Empty));
}

#[test]
fn each_kind_of_bad_page_is_named() {
    let cases: [(Vec<u8>, RecordError); 9] = [
        (vec![0xff; 47], RecordError::TooShort),
        (vec![0; 48], RecordError::NotARecord),
        (
            sealed(|record| record[4] = 2).to_vec(),
            RecordError::UnknownVersion(2),
        ),
        (
            sealed(|record| record[6] = 44).to_vec(),
            RecordError::WrongLength(44),
        ),
        (
            sealed(|record| record[8] = 160).to_vec(),
            RecordError::OtherFrame {
                width: 160,
                height: 96,
            },
        ),
        (
            sealed(|record| record[40] = 2).to_vec(),
            RecordError::UnknownValue,
        ),
        (
            sealed(|record| record[41] = 2).to_vec(),
            RecordError::UnknownValue,
        ),
        (
            sealed(|record| record[43] = 1).to_vec(),
            RecordError::UnknownValue,
        ),
        (
            // A centre that is not a number.
            sealed(|record| record[12..16].fill(0xff)).to_vec(),
            RecordError::Impossible(CalibrationError::NotFinite),
        ),
    ];
    for (page, error) in cases {
        assert_eq!(decode(&page, &LAYOUT), Err(error));
    }
}

#[test]
fn what_follows_the_record_on_its_page_does_not_matter() {
    let mut page = vec![0xff; 1024];
    page[..RECORD_BYTES].copy_from_slice(&encode(&LensCalibration::DEFAULT, &LAYOUT));
    assert_eq!(decode(&page, &LAYOUT), Ok(LensCalibration::DEFAULT));
}

#[test]
fn every_single_flipped_bit_is_refused() {
    let record = encode(&LensCalibration::DEFAULT, &LAYOUT);
    for bit in 0..8 * RECORD_BYTES {
        let mut flipped = record;
        flipped[bit / 8] ^= 1 << (bit % 8);
        assert!(decode(&flipped, &LAYOUT).is_err(), "bit {bit}");
    }
}

proptest! {
    #[test]
    fn a_record_gives_back_the_lens_it_was_made_of(lens in lenses()) {
        prop_assert_eq!(decode(&encode(&lens, &LAYOUT), &LAYOUT), Ok(lens));
    }

    #[test]
    fn any_two_flipped_bits_of_any_record_are_refused(
        lens in lenses(),
        first in 0..8 * RECORD_BYTES,
        apart in 1..8 * RECORD_BYTES,
    ) {
        let mut record = encode(&lens, &LAYOUT);
        for bit in [first, (first + apart) % (8 * RECORD_BYTES)] {
            record[bit / 8] ^= 1 << (bit % 8);
        }
        prop_assert!(decode(&record, &LAYOUT).is_err());
    }

    #[test]
    fn whatever_lies_on_the_page_what_is_read_is_a_lens_that_fits(
        page in proptest::collection::vec(any::<u8>(), 0..64),
    ) {
        if let Ok(lens) = decode(&page, &LAYOUT) {
            prop_assert_eq!(lens.check(&LAYOUT), Ok(()));
        }
    }
}
