use core::f32::consts::FRAC_PI_2;
use std::sync::LazyLock;

use nalgebra::{UnitQuaternion, Vector3};

use super::*;

const EXPOSURE: Exposure = Exposure {
    lines: 120,
    gain: 1.0,
};

/// Painted once for all tests.
static WORLD: LazyLock<World> = LazyLock::new(|| World::named("arena-panels", 1).unwrap());

fn world() -> World {
    WORLD.clone()
}

fn camera(seed: u64) -> PanoramicCamera {
    PanoramicCamera::new(world(), &PanoramicLens::default(), seed)
}

fn at(yaw_rad: f32) -> Moment {
    Moment {
        pose: Pose {
            position_m: Vector3::new(-1.1, 0.37, 0.5),
            attitude: UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw_rad),
        },
        time_s: 0.0,
    }
}

fn in_ring(x: usize, y: usize) -> bool {
    let centre = [x as f32 + 0.5, y as f32 + 0.5];
    (18.0..=42.0).contains(&PanoramicLens::default().distance_from_centre(centre))
}

fn ring_luma(frame: &Frame) -> Vec<f32> {
    (0..WIDTH * HEIGHT)
        .filter(|index| in_ring(index % WIDTH, index / WIDTH))
        .map(|index| f32::from(frame[2 * index + 1]))
        .collect()
}

fn mean(values: &[f32]) -> f32 {
    values.iter().sum::<f32>() / values.len() as f32
}

/// After a turn to the left by s, what was at bearing b + s is at bearing b. A quarter turn maps
/// pixels on pixels: bearings grow clockwise in the image, so the image turns counter-clockwise.
#[test]
fn a_quarter_turn_of_the_camera_turns_the_image_by_exactly_a_quarter() {
    let mut renderer = AnnulusRenderer::new(&PanoramicLens::default());
    let ahead = renderer.render(&world(), &at(0.0)).to_vec();
    let turned = renderer.render(&world(), &at(FRAC_PI_2)).to_vec();
    let mut compared = 0;
    for (x, y) in (0..WIDTH * HEIGHT).map(|index| (index % WIDTH, index / WIDTH)) {
        if in_ring(x, y) {
            // (dx, dy) from the centre shows what (-dy, dx) showed before the turn.
            let (source_x, source_y) = (64 + 48 - 1 - y, x + 48 - 64);
            let (new, old) = (turned[y * WIDTH + x], ahead[source_y * WIDTH + source_x]);
            assert!((new - old).abs() < 1e-3, "({x}, {y}): {new} {old}");
            compared += 1;
        }
    }
    assert!(compared > 4_000);
}

#[test]
fn a_landmark_appears_at_its_bearing_minus_the_heading() {
    let lens = PanoramicLens::default();
    let mut renderer = AnnulusRenderer::new(&lens);
    let world = world();
    let mut horizon = |yaw_rad: f32, bearing_rad: f32| {
        let view = View {
            bearing_rad,
            elevation_rad: 0.2,
        };
        let [x, y] = lens.project(view).map(|coordinate| coordinate as usize);
        renderer.render(&world, &at(yaw_rad))[y * WIDTH + x]
    };
    let step = core::f32::consts::TAU / 24.0;
    let shift = 5.0 * step;
    let mut error = 0.0;
    let mut contrast = 0.0;
    for n in 0..24 {
        let bearing = n as f32 * step;
        error += (horizon(shift, bearing) - horizon(0.0, bearing + shift)).abs();
        contrast += (horizon(0.0, bearing) - horizon(0.0, bearing + shift)).abs();
    }
    assert!(error < 0.2 * contrast, "{error} {contrast}");
}

#[test]
fn twice_the_shutter_or_the_gain_gives_twice_the_luma_above_black() {
    let mut camera = camera(1);
    let mut luma = |lines, gain| {
        let exposure = Exposure { lines, gain };
        mean(&ring_luma(camera.expose(&at(0.0), exposure, 0))) - 12.0
    };
    let dim = luma(20, 1.0);
    assert!((luma(40, 1.0) / dim - 2.0).abs() < 0.02);
    assert!((luma(20, 2.0) / dim - 2.0).abs() < 0.02);
}

#[test]
fn half_the_light_is_made_up_for_by_twice_the_shutter() {
    let mut camera = camera(1);
    let exposure = |lines| Exposure { lines, gain: 1.0 };
    let whole = mean(&ring_luma(camera.expose(&at(0.0), exposure(30), 0)));
    camera.set_light(0.5);
    let half = mean(&ring_luma(camera.expose(&at(0.0), exposure(30), 0)));
    let twice = mean(&ring_luma(camera.expose(&at(0.0), exposure(60), 0)));
    assert!((twice - whole).abs() < 0.1, "{twice} {whole}");
    assert!(((half - 12.0) / (whole - 12.0) - 0.5).abs() < 0.02);
}

#[test]
fn the_horizon_reaches_its_set_point_of_80_between_100_and_200_lines() {
    for seed in 1..=3 {
        let world = World::named("arena-panels", seed).unwrap();
        let mut camera = PanoramicCamera::new(world, &PanoramicLens::default(), 1);
        let mut luma = |lines| {
            let exposure = Exposure { lines, gain: 1.0 };
            mean(&ring_luma(camera.expose(&at(0.0), exposure, 0)))
        };
        assert!(luma(100) < 80.0 && luma(200) > 80.0);
    }
}

#[test]
fn a_frame_depends_on_seed_and_number_alone() {
    let frame = |seed, number| *camera(seed).expose(&at(0.1), EXPOSURE, number);
    assert_eq!(frame(1, 7), frame(1, 7));
    assert_ne!(frame(1, 7), frame(2, 7));
    assert_ne!(frame(1, 7), frame(1, 8));
    let mut used = camera(1);
    used.expose(&at(1.0), EXPOSURE, 3);
    assert_eq!(*used.expose(&at(0.1), EXPOSURE, 7), frame(1, 7));
}

#[test]
fn noise_is_about_two_luma_and_has_no_bias() {
    let mut camera = camera(1);
    let first = ring_luma(camera.expose(&at(0.0), EXPOSURE, 1));
    let second = ring_luma(camera.expose(&at(0.0), EXPOSURE, 2));
    let differences: Vec<f32> = first.iter().zip(&second).map(|(a, b)| a - b).collect();
    let squares: Vec<f32> = differences.iter().map(|d| d * d).collect();
    // The difference of two frames has twice the variance of one.
    let deviation = (0.5 * mean(&squares)).sqrt();
    assert!((1.0..3.0).contains(&deviation), "{deviation}");
    assert!(mean(&differences).abs() < 0.2);
}

#[test]
fn bytes_are_u_y_v_y_with_neutral_chroma_a_dark_middle_and_a_bright_rim() {
    let mut camera = camera(1);
    let frame = camera.expose(&at(0.0), EXPOSURE, 0);
    assert!(frame.iter().step_by(2).all(|&chroma| chroma == 0x80));
    let luma = |x: usize, y: usize| frame[LINE_BYTES * y + 2 * x + 1];
    assert!(luma(64, 48) < 25);
    assert!(luma(64 + 46, 48) > 120);
}

#[test]
fn a_masked_frame_is_black_with_neutral_chroma() {
    let frame = PanoramicCamera::black_frame();
    let (pixels, rest) = frame.as_chunks::<2>();
    assert!(rest.is_empty() && pixels.iter().all(|pixel| *pixel == [0x80, 0x00]));
}

#[test]
fn gamma_lifts_the_dark_as_its_exponent_says() {
    let mut camera = camera(1);
    let mut luma = |gamma| {
        camera.set_tuning(ImageTuning {
            gamma,
            contrast: 1.0,
            black_level: 0.0,
            ..ImageTuning::default()
        });
        let frame = camera.expose(&at(0.0), EXPOSURE, 0);
        f32::from(frame[LINE_BYTES * 48 + 2 * (64 + 46) + 1]) / 255.0
    };
    let (linear, shaped) = (luma(false), luma(true));
    assert!((shaped - linear.powf(0.55)).abs() < 0.01);
}

/// A frame whose rows each have a heading.
fn rolled(camera: &mut PanoramicCamera, number: u32, yaw_rad: impl Fn(usize) -> f32) -> Frame {
    camera.begin_frame(number);
    camera.light_row(0, &at(yaw_rad(0)));
    for row in 0..HEIGHT {
        if row + 1 < HEIGHT {
            camera.light_row(row + 1, &at(yaw_rad(row + 1)));
        }
        camera.read_row(row, EXPOSURE);
    }
    *camera.frame()
}

#[test]
fn a_frame_exposed_row_by_row_at_one_moment_is_the_frame_of_that_moment() {
    let mut rolling = camera(1);
    // What was rendered before does not shine through.
    rolling.expose(&at(2.0), EXPOSURE, 3);
    let frame = rolled(&mut rolling, 4, |_| 0.3);
    assert!(frame == *camera(1).expose(&at(0.3), EXPOSURE, 4));
}

#[test]
fn rows_exposed_after_a_turn_show_what_the_camera_saw_after_it() {
    let turn = HEIGHT / 2;
    let frame = rolled(&mut camera(1), 0, |row| if row < turn { 0.0 } else { 1.0 });
    let [before, after] = [0.0, 1.0].map(|yaw_rad| *camera(1).expose(&at(yaw_rad), EXPOSURE, 0));
    // But for the rows at the seam, which the blur mixes.
    let [start, end] = [turn - 1, turn + 1].map(|row| LINE_BYTES * row);
    assert!(frame[..start] == before[..start]);
    assert!(frame[end..] == after[end..]);
    assert!(frame[end..] != before[end..]);
}

/// A grey wall all round, without noise to speak of: what differs is the camera's own.
fn lit_evenly(tuning: ImageTuning, seed: u64) -> Frame {
    let mut sensor = ImageSensor::new(&PanoramicLens::default(), seed);
    sensor.set_tuning(tuning);
    sensor.begin_frame(0);
    let mut frame = [0; FRAME_BYTES];
    let (lines, _) = frame.as_chunks_mut::<LINE_BYTES>();
    for (row, line) in lines.iter_mut().enumerate() {
        sensor.form_row(row, &[0.4; WIDTH], EXPOSURE, line);
    }
    frame
}

fn luma_of(frame: &Frame) -> impl Iterator<Item = u8> + '_ {
    frame.iter().skip(1).step_by(2).copied()
}

#[test]
fn bad_pixels_show_as_soon_as_nobody_corrects_them_and_stay_where_they_are() {
    let raw = ImageTuning {
        blemish_correction: false,
        ..ImageTuning::default()
    };
    let places = |frame: &Frame| -> Vec<usize> {
        let is_bad = |luma: &u8| *luma <= 12 || *luma == 255;
        luma_of(frame)
            .enumerate()
            .filter_map(|(place, luma)| is_bad(&luma).then_some(place))
            .collect()
    };
    let bad = places(&lit_evenly(raw, 1));
    assert!((8..=12).contains(&bad.len()), "{bad:?}");
    assert_eq!(places(&lit_evenly(raw, 1)), bad);
    assert_ne!(
        places(&lit_evenly(raw, 2)),
        bad,
        "another camera has others"
    );
    assert!(places(&lit_evenly(ImageTuning::default(), 1)).is_empty());
}

#[test]
fn dust_takes_a_fifth_of_the_light_in_few_places_of_the_ring() {
    let dust = Blemishes::new(&PanoramicLens::default(), 1);
    let centres = (0..WIDTH * HEIGHT).map(|index| [(index % WIDTH) as f32, (index / WIDTH) as f32]);
    let shaded: Vec<f32> = centres
        .map(|centre| dust.transmission(centre))
        .filter(|transmission| *transmission < 0.95)
        .collect();
    assert!((20..120).contains(&shaded.len()), "{}", shaded.len());
    let darkest = shaded.into_iter().fold(1.0, f32::min);
    assert!((0.6..0.85).contains(&darkest), "{darkest}");
}

#[test]
fn test_pictures_know_no_light_no_noise_and_no_blemish() {
    let picture = |pattern| {
        let tuning = ImageTuning {
            gamma: true,
            test_pattern: Some(pattern),
            ..ImageTuning::default()
        };
        lit_evenly(tuning, 1)
    };
    let bars = picture(TestPattern::Bars);
    assert_eq!(bars[..4], [128, 255, 128, 255], "white");
    assert_eq!(
        bars[2 * 16..][..4],
        [0, 226, 149, 226],
        "yellow, from pixel 16 on"
    );
    assert_eq!(bars[LINE_BYTES - 4..LINE_BYTES], [128, 0, 128, 0], "black");
    let ramp: Vec<u8> = luma_of(&picture(TestPattern::Ramp)).take(WIDTH).collect();
    assert!(ramp.is_sorted() && ramp[0] == 0 && ramp[WIDTH - 1] == 255);
    // Gamma lifts the middle: 255 x 1.2 x 0.5^0.55 + 12.
    let shaped: Vec<u8> = luma_of(&picture(TestPattern::RampBeforeGamma))
        .take(WIDTH)
        .collect();
    assert!(shaped.is_sorted() && shaped[WIDTH / 2] > 200 && ramp[WIDTH / 2] < 130);
    for frame in [bars, picture(TestPattern::Ramp)] {
        let (lines, _) = frame.as_chunks::<LINE_BYTES>();
        assert!(lines.iter().all(|line| line == &lines[0]));
    }
}

/// The greatest difference between a row's mean luma above black and that under steady light, as a share.
fn banding(lines: u16) -> f32 {
    let mut camera = camera(1);
    let exposure = Exposure { lines, gain: 1.0 };
    let mut rows = |flicker| {
        camera.set_flicker(flicker);
        let frame = *camera.expose(&at(0.0), exposure, 3);
        let (rows, _) = frame.as_chunks::<LINE_BYTES>();
        // Rows that cross the ring.
        let mean_of = |row: &[u8; LINE_BYTES]| {
            let luma: Vec<f32> = row
                .iter()
                .skip(1)
                .step_by(2)
                .map(|l| f32::from(*l))
                .collect();
            mean(&luma) - 12.0
        };
        rows[10..86].iter().map(mean_of).collect::<Vec<f32>>()
    };
    let steady = rows(Flicker::NONE);
    let lamps = rows(Flicker {
        depth: 0.3,
        period_lines: 134.6,
    });
    let pairs = lamps.iter().zip(&steady);
    pairs
        .map(|(lit, usual)| (lit / usual - 1.0).abs())
        .fold(0.0, f32::max)
}

#[test]
fn flickering_lamps_band_the_image_unless_it_is_exposed_for_whole_periods() {
    assert!(banding(67) > 0.15);
    assert!(banding(202) > 0.04);
    assert!(banding(135) < 0.01);
}
