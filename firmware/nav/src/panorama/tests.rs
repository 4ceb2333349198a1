extern crate std;

use core::f32::consts::{FRAC_PI_2, PI};
use std::boxed::Box;

use proptest::prelude::*;

use super::*;
use crate::horizon::BEARING_STEP_RAD;
use crate::spectrum::Spectrum;

const LAYOUT: FrameLayout = FrameLayout::SUBQCIF_UYVY;
const FRAME_BYTES: usize = LAYOUT.bytes();
const FRAME_WIDTH: usize = LAYOUT.width as usize;
const FRAME_HEIGHT: usize = LAYOUT.height as usize;

type Frame = [u8; FRAME_BYTES];

/// A frame of a world whose luma depends on the bearing alone, seen by a drone of this heading.
fn frame(lens: &LensCalibration, heading: f32, luma: impl Fn(f32) -> f32) -> Box<Frame> {
    let mut frame = Box::new([0xEE; FRAME_BYTES]);
    for row in 0..FRAME_HEIGHT {
        for column in 0..FRAME_WIDTH {
            let x = column as f32 + 0.5 - lens.centre_px.0;
            let y = row as f32 + 0.5 - lens.centre_px.1;
            let turned = libm::atan2f(y, x) - lens.zero_bearing_rad;
            let bearing = match lens.direction {
                BearingDirection::Clockwise => turned,
                BearingDirection::CounterClockwise => -turned,
            };
            frame[2 * (row * FRAME_WIDTH + column) + 1] = luma(bearing + heading) as u8;
        }
    }
    frame
}

fn lenses() -> [LensCalibration; 2] {
    let other = LensCalibration {
        centre_px: (61.0, 49.5),
        zero_bearing_rad: 0.7,
        direction: BearingDirection::CounterClockwise,
        inner_is_up: false,
        ..LensCalibration::DEFAULT
    };
    [LensCalibration::DEFAULT, other]
}

fn two_waves(bearing: f32) -> f32 {
    100.0 + 40.0 * libm::cosf(bearing - 0.7) + 20.0 * libm::sinf(3.0 * bearing)
}

#[test]
fn the_horizon_shows_what_the_world_is_at_each_bearing() {
    for lens in lenses() {
        let map = PanoramaMap::new(&lens, &LAYOUT).unwrap();
        for heading in [0.0, 1.0, -2.5, 3.0, 40.0] {
            let horizon = map.horizon(&frame(&lens, heading, two_waves)[..], heading);
            for (n, value) in horizon.luma().iter().enumerate() {
                let bearing = n as f32 * BEARING_STEP_RAD + horizon.residual_rad();
                // Half a pixel at radius 18 is 1.6 degrees; the mean over the radius is better.
                assert!((value - two_waves(bearing)).abs() < 3.0);
            }
        }
    }
}

#[test]
fn the_spectrum_does_not_depend_on_the_heading() {
    let lens = LensCalibration::DEFAULT;
    let map = PanoramaMap::new(&lens, &LAYOUT).unwrap();
    let view = |heading| Spectrum::of(&map.horizon(&frame(&lens, heading, two_waves)[..], heading));
    let north = view(0.0);
    for heading in [0.01, 0.5, FRAC_PI_2, PI, -3.0] {
        let turned = view(heading);
        for (a, b) in north.coefficients().iter().zip(turned.coefficients()) {
            assert!((a - b).l1_norm() < 1.0);
        }
    }
}

#[test]
fn the_rest_of_the_heading_turns_the_spectrum_exactly() {
    let lens = LensCalibration::DEFAULT;
    let map = PanoramaMap::new(&lens, &LAYOUT).unwrap();
    let frame = frame(&lens, 0.0, two_waves);
    let whole = Spectrum::of(&map.horizon(&frame[..], 17.0 * BEARING_STEP_RAD));
    let rest = 0.3 * BEARING_STEP_RAD;
    let both = Spectrum::of(&map.horizon(&frame[..], 17.0 * BEARING_STEP_RAD + rest));
    for (a, b) in whole
        .rotated(-rest)
        .coefficients()
        .iter()
        .zip(both.coefficients())
    {
        assert!((a - b).l1_norm() < 1e-3);
    }
}

#[test]
fn the_first_row_looks_up() {
    for lens in lenses() {
        let map = PanoramaMap::new(&lens, &LAYOUT).unwrap();
        let mut frame = Box::new([0; FRAME_BYTES]);
        for (index, byte) in frame.iter_mut().enumerate() {
            let x = (index / 2 % FRAME_WIDTH) as f32 + 0.5 - lens.centre_px.0;
            let y = (index / 2 / FRAME_WIDTH) as f32 + 0.5 - lens.centre_px.1;
            *byte = libm::hypotf(x, y) as u8;
        }
        let image = map.unwrap(&frame[..]);
        let (first, last) = (image[0][0], image[RADII - 1][0]);
        assert_eq!(first < last, lens.inner_is_up);
    }
}

/// A frame of one luma, but for what looks so many degrees up, where the ring spans 90.
fn frame_with(
    lens: &LensCalibration,
    luma: u8,
    from_deg: f32,
    to_deg: f32,
    other: u8,
) -> Box<Frame> {
    let mut frame = Box::new([luma; FRAME_BYTES]);
    for pixel in 0..FRAME_WIDTH * FRAME_HEIGHT {
        let x = (pixel % FRAME_WIDTH) as f32 + 0.5 - lens.centre_px.0;
        let y = (pixel / FRAME_WIDTH) as f32 + 0.5 - lens.centre_px.1;
        let outwards = libm::hypotf(x, y) - lens.horizon_radius_px;
        let up = if lens.inner_is_up {
            -outwards
        } else {
            outwards
        };
        let elevation = up * 90.0 / (lens.outer_radius_px - lens.inner_radius_px);
        if (from_deg..to_deg).contains(&elevation) {
            frame[2 * pixel + 1] = other;
        }
    }
    frame
}

#[test]
fn the_band_sees_17_degrees_up_and_down_and_neither_lamps_nor_floor_nor_fixture_beyond() {
    for lens in lenses() {
        let map = PanoramaMap::new(&lens, &LAYOUT).unwrap();
        let band = |from_deg, to_deg| {
            let frame = frame_with(&lens, 70, from_deg, to_deg, 255);
            let (_, mean) = map.horizon_and_band(&frame[..], 1.0);
            (mean, map.band(&frame[..]))
        };
        let mut uniform = LumaHistogram::new();
        (0..BAND_ROWS * BEARINGS).for_each(|_| uniform.add(70));
        // A pixel is 3.75 degrees high: what begins one farther out must not be seen.
        for (from_deg, to_deg) in [(21.0, 999.0), (-999.0, -21.0)] {
            assert_eq!(band(from_deg, to_deg), (70.0, uniform.clone()));
        }
        assert_eq!(band(-22.0, 22.0).0, 255.0);
        for (from_deg, to_deg) in [(7.0, 17.0), (-17.0, -7.0), (-5.0, 5.0)] {
            assert!(band(from_deg, to_deg).0 > 100.0);
        }
    }
}

#[test]
fn a_horizon_that_is_not_in_the_middle_of_the_ring_takes_the_band_with_it() {
    for (horizon_radius_px, first_row) in [(30.0, 5), (27.0, 3), (33.0, 7), (18.0, 0), (42.0, 10)] {
        let lens = LensCalibration {
            horizon_radius_px,
            ..LensCalibration::DEFAULT
        };
        let map = PanoramaMap::new(&lens, &LAYOUT).unwrap();
        for row in 0..RADII {
            // Row r is the ring from 18 + 1.5 r to 18 + 1.5 (r + 1) pixels: light it alone.
            let mut frame = Box::new([0; FRAME_BYTES]);
            for bearing in 0..BEARINGS {
                frame[map
                    .samples
                    .index(bearing, (row + RADII - map.band_start) % RADII)] = 160;
            }
            let lit = map.unwrap(&frame[..])[row].iter().all(|luma| *luma == 160);
            let seen = map.horizon_and_band(&frame[..], 0.0).1 > 20.0;
            assert!(lit);
            assert_eq!(seen, (first_row..first_row + BAND_ROWS).contains(&row));
        }
    }
}

#[test]
fn a_heading_that_is_not_finite_does_no_harm() {
    let map = PanoramaMap::new(&LensCalibration::DEFAULT, &LAYOUT).unwrap();
    for heading in [f32::NAN, f32::INFINITY, f32::MAX, f32::MIN] {
        let horizon = map.horizon(&[7; FRAME_BYTES], heading);
        assert_eq!(horizon.luma(), [7.0; BEARINGS]);
    }
}

#[test]
fn a_table_with_a_sample_outside_the_frame_is_refused() {
    let table =
        |bytes| SampleTable::new(bytes, |bearing, sample| (bearing * RADII + sample) as u16);
    assert!(table(BEARINGS * RADII).is_some());
    assert!(table(BEARINGS * RADII - 1).is_none());
}

#[test]
fn a_frame_that_is_too_short_is_black() {
    let map = PanoramaMap::new(&LensCalibration::DEFAULT, &LAYOUT).unwrap();
    let (horizon, band) = map.horizon_and_band(&[7; FRAME_BYTES - 1], 0.0);
    assert_eq!((horizon.luma(), band), ([0.0; BEARINGS], 0.0));
    assert_eq!(map.band(&[7; FRAME_BYTES - 1]), LumaHistogram::new());
}

proptest! {
    #[test]
    fn every_sample_of_a_lens_that_fits_is_luma_inside_the_frame(
        centre in (0.0_f32..128.0, 0.0_f32..96.0),
        inner in 0.1_f32..64.0,
        span in 0.1_f32..64.0,
        zero in -10.0_f32..10.0,
        clockwise: bool,
        inner_is_up: bool,
    ) {
        let lens = LensCalibration {
            centre_px: centre,
            inner_radius_px: inner,
            outer_radius_px: inner + span,
            horizon_radius_px: inner + 0.5 * span,
            vertical_field_rad: 1.0,
            zero_bearing_rad: zero,
            direction: if clockwise {
                BearingDirection::Clockwise
            } else {
                BearingDirection::CounterClockwise
            },
            inner_is_up,
        };
        if let Ok(map) = PanoramaMap::new(&lens, &LAYOUT) {
            for sample in 0..BEARINGS * RADII {
                let index = map.samples.index(sample / RADII, sample % RADII);
                prop_assert!(index % 2 == 1 && index < FRAME_BYTES);
            }
        }
    }
}
