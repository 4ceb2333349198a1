//! The level horizon of a tilted camera, in rendered worlds.

use core::f32::consts::TAU;

use fake_sensors::camera::{Exposure, Moment, PanoramicCamera, PanoramicLens, Pose};
use fake_sensors::world::World;
use link::{Command, Message, Mode, Record, State};
use nalgebra::{UnitQuaternion, Vector3};
use nav::horizon::BEARINGS;
use nav::{Derotation, Horizon, LensCalibration, PanoramaMap, Snapshot, Spectrum, Tilt};
use pilot::{FRAME_LAYOUT, Frame, Outbox, Parameters, Pilot};

const TILT_RAD: f32 = 15.0 * TAU / 360.0;
const HEADING_RAD: f32 = 0.6;

/// The most that derotation may leave of what a tilt does to the horizon, as a share. What a tilted ring
/// does not show, a third of it, stays unknown.
const LEFT_AT_MOST: f32 = 0.6;

/// Rolls and pitches of 15 degrees all round.
fn tilts() -> impl Iterator<Item = Tilt> {
    (0..8).map(|n| {
        let (sin, cos) = libm::sincosf(n as f32 * TAU / 8.0);
        Tilt {
            roll_rad: TILT_RAD * sin,
            pitch_rad: TILT_RAD * cos,
        }
    })
}

/// What a camera sees that leans so. The world's body frame has y to the left: a pitch with the nose up
/// is negative about it.
fn frame(camera: &mut PanoramicCamera, tilt: Tilt) -> Frame {
    let attitude = UnitQuaternion::from_euler_angles(tilt.roll_rad, -tilt.pitch_rad, HEADING_RAD);
    let pose = Pose {
        position_m: Vector3::new(-1.0, 0.4, 0.7),
        attitude,
    };
    let exposure = Exposure {
        lines: 100,
        gain: 1.0,
    };
    *camera.expose(&Moment { pose, time_s: 0.0 }, exposure, 0)
}

/// Root mean square difference of two horizons whose means are the same; a snapshot has no mean.
fn difference(a: &Horizon, b: &Horizon) -> f32 {
    let mean = |horizon: &Horizon| horizon.luma().iter().sum::<f32>() / BEARINGS as f32;
    let rest = mean(a) - mean(b);
    let squares = a.luma().into_iter().zip(b.luma()).map(|(a, b)| {
        let off = a - b - rest;
        off * off
    });
    (squares.sum::<f32>() / BEARINGS as f32).sqrt()
}

/// With `--nocapture` the figures.
#[test]
fn derotated_at_15_degrees_the_horizon_resembles_the_level_one_far_more() {
    let lens = LensCalibration::DEFAULT;
    let map = PanoramaMap::new(&lens, &FRAME_LAYOUT).expect("the default lens");
    let derotation = Derotation::new(&lens, &FRAME_LAYOUT).expect("the default lens");
    println!("world            rms luma: as it is  derotated  (means over 8 tilts of 15 degrees)");
    for name in ["arena-panels", "corridor-doors", "office"] {
        let world = World::named(name, 1).expect("a world");
        let mut camera = PanoramicCamera::new(world, &PanoramicLens::default(), 1);
        let level = map.horizon(&frame(&mut camera, Tilt::default()), HEADING_RAD);
        let (mut plain, mut derotated) = (0.0, 0.0);
        for tilt in tilts() {
            let frame = frame(&mut camera, tilt);
            plain += difference(&map.horizon(&frame, HEADING_RAD), &level) / 8.0;
            let horizon = derotation.horizon(&frame, HEADING_RAD, tilt);
            derotated += difference(&horizon, &level) / 8.0;
        }
        println!("{name:<18}{plain:>17.1}{derotated:>11.1}");
        assert!(
            derotated < LEFT_AT_MOST * plain,
            "{name}: {plain} {derotated}"
        );
    }
}

/// The snapshot that a pilot stores who has heard of a tilt before it sees the frame.
fn remembered(parameters: &Parameters, frame: &Frame, tilt: Tilt) -> Snapshot {
    let mut pilot = Pilot::new(parameters).expect("the default lens");
    let mut outbox = Outbox::new();
    let state = Message::State(State {
        phi: tilt.roll_rad,
        theta: tilt.pitch_rad,
        psi: -HEADING_RAD,
        ..State::default()
    });
    let record = Message::Command(Command {
        command: Mode::Record(Record::SEQUENCE_WITH_ODOMETRY).byte(),
        ..Command::default()
    });
    pilot.on_message(0, &state, &mut outbox);
    pilot.on_frame(frame);
    pilot.on_message(50, &record, &mut outbox);
    outbox.clear();
    pilot.on_message(100, &state, &mut outbox);
    let snapshots = pilot.navigator().route().snapshots();
    snapshots.last().expect("a snapshot").view.in_paper_form()
}

#[test]
fn a_pilot_that_derotates_remembers_the_level_view_by_the_tilt_that_state_tells() {
    let world = World::named("office", 1).expect("a world");
    let mut camera = PanoramicCamera::new(world, &PanoramicLens::default(), 1);
    let tilt = Tilt {
        roll_rad: TILT_RAD,
        pitch_rad: -0.5 * TILT_RAD,
    };
    let seen = frame(&mut camera, tilt);
    let derotation = Derotation::new(&LensCalibration::DEFAULT, &FRAME_LAYOUT).expect("a lens");
    let level = derotation.horizon(&seen, HEADING_RAD, tilt);
    let derotates = Parameters {
        derotate: true,
        ..Parameters::DEFAULT
    };
    let expected = Snapshot::quantise(&Spectrum::of(&level));
    assert_eq!(remembered(&derotates, &seen, tilt), expected);
    // The paper does not derotate, and neither does a pilot that is not told to.
    let as_it_is = remembered(&Parameters::DEFAULT, &seen, tilt);
    assert_eq!(
        as_it_is,
        remembered(&Parameters::DEFAULT, &seen, Tilt::default())
    );
    assert_ne!(as_it_is, expected);
}
