use fake_sensors::camera::PanoramicLens;
use fake_sensors::camera::tcm8230::{CONTRAST, frame_period_ns, line_offset_ns};
use fake_sensors::world::World;
use nalgebra::{UnitQuaternion, Vector3};

use super::*;

const EXTCLK_HZ: u32 = 21_000_000;
/// A frame's time: it is exposed for the whole time between two of its readouts.
const LINES: u16 = 525;

fn heading(yaw_rad: f32) -> Pose {
    Pose {
        position_m: Vector3::new(-1.0, 0.4, 0.5),
        attitude: UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw_rad),
    }
}

/// The third frame of a camera (the first is black) that turns at once at `turn_ns`.
fn third_frame(turn_ns: u64, turn_rad: f32) -> Frame {
    let chip = Tcm8230::streaming(0, EXTCLK_HZ, LINES, 1.0);
    let world = World::named("arena-panels", 1).unwrap();
    let optics = PanoramicCamera::new(world, &PanoramicLens::default(), 1);
    let mut camera = Camera::new(chip, optics, heading(0.0));
    let mut turned = false;
    while let Some(due_ns) = camera.chip().next_edge() {
        if !turned && due_ns >= turn_ns {
            camera.look_from(turn_ns - 1, heading(0.0));
            camera.look_from(turn_ns, heading(turn_rad));
            turned = true;
        }
        if camera.take_edge(due_ns) == Some(Edge::FrameEnd) && camera.frames_started() == 3 {
            break;
        }
    }
    *camera.frame()
}

#[test]
fn a_row_shows_the_world_from_amid_its_exposure_and_not_from_its_readout() {
    let row = 60;
    let frame_ns = 2 * frame_period_ns(EXTCLK_HZ);
    let readout_ns = frame_ns + line_offset_ns(row, EXTCLK_HZ);
    let amid_ns = readout_ns - frame_period_ns(EXTCLK_HZ) / 2;
    let [before, after] = [third_frame(1, 0.0), third_frame(1, 1.0)];
    // Just before and just after the middle of that row's exposure.
    let [early, late] = [amid_ns - 1_000, amid_ns + 1_000].map(|ns| third_frame(ns, 1.0));
    // The blur mixes in the row above and the row below.
    let byte = |row: usize| LINE_BYTES * row;
    assert!(early[..byte(row - 1)] == before[..byte(row - 1)]);
    assert!(early[byte(row + 1)..] == after[byte(row + 1)..]);
    assert!(late[..byte(row)] == before[..byte(row)]);
    assert!(late[byte(row + 2)..] == after[byte(row + 2)..]);
    assert!(early[byte(row)..byte(row + 1)] != late[byte(row)..byte(row + 1)]);
    assert!(before[byte(row)..] != after[byte(row)..]);
    // A turn after the readout began, and still before the frame's end, shows nowhere.
    assert!(third_frame(frame_ns + frame_period_ns(EXTCLK_HZ) - 1, 1.0) == before);
}

/// A camera that lights each row when it must, and none ahead of time.
struct JustInTime {
    chip: Tcm8230,
    optics: PanoramicCamera,
    poses: Poses,
    start_ns: u64,
    frame: Frame,
}

impl JustInTime {
    fn light(&mut self, row: usize) {
        let amid_ns = self.start_ns as i64 + self.chip.mid_exposure_ns(row);
        self.optics.light_row(row, &self.poses.at(amid_ns as u64));
    }

    fn take_edge(&mut self, now_ns: u64) -> Option<Edge> {
        let edge = self.chip.take_edge(now_ns)?;
        match edge {
            Edge::FrameStart { .. } if self.chip.black() => {
                self.frame = *PanoramicCamera::black_frame();
            }
            Edge::FrameStart { number } => {
                self.start_ns = now_ns;
                self.optics.set_tuning(self.chip.tuning());
                self.optics.begin_frame(number);
                self.light(0);
            }
            Edge::Line(row) if !self.chip.black() => {
                if row + 1 < HEIGHT {
                    self.light(row + 1);
                }
                let line = self.optics.read_row(row, self.chip.exposure());
                self.frame[LINE_BYTES * row..][..LINE_BYTES].copy_from_slice(line);
            }
            Edge::Line(_) | Edge::FrameEnd => {}
        }
        Some(edge)
    }
}

/// What somebody does to a sensor, at a time in nanoseconds.
type Touch = fn(&mut Tcm8230, u64);

/// When: in the middle of the fourth frame.
const TOUCHED_MS: u64 = 135;

/// The frames of a quarter of a second in which the camera turns, and `touch` happens.
fn frames<C>(
    camera: &mut C,
    touch: Touch,
    chip: fn(&mut C) -> &mut Tcm8230,
    look_from: fn(&mut C, u64, Pose),
    take_edge: fn(&mut C, u64) -> Option<Edge>,
    frame: fn(&C) -> Frame,
) -> Vec<Frame> {
    let mut frames = Vec::new();
    for ms in 0..240 {
        let now_ns = ms * 1_000_000;
        look_from(camera, now_ns, heading(0.01 * ms as f32));
        if ms == TOUCHED_MS {
            touch(chip(camera), now_ns);
        }
        while let Some(due_ns) = chip(camera).next_edge()
            && due_ns < now_ns + 1_000_000
        {
            let edge = take_edge(camera, due_ns);
            // A frame that is broken off has a last line no more than a last edge.
            if matches!(edge, Some(Edge::Line(40) | LAST_LINE)) {
                frames.push(frame(camera));
            }
        }
    }
    frames
}

/// Row after row as the sensor puts them out, lit just in time, and ahead of time without and with a helper.
fn three_ways(lines: u16, touch: Touch) -> [Vec<Frame>; 3] {
    let chip = || Tcm8230::streaming(0, EXTCLK_HZ, lines, 1.0);
    let optics = || {
        let world = World::named("arena-panels", 1).expect("a world");
        PanoramicCamera::new(world, &PanoramicLens::default(), 1)
    };
    let mut just_in_time = JustInTime {
        chip: chip(),
        optics: optics(),
        poses: Poses::new(heading(0.0)),
        start_ns: 0,
        frame: [0; FRAME_BYTES],
    };
    let ahead = |mut camera: Camera| {
        frames(
            &mut camera,
            touch,
            Camera::chip,
            Camera::look_from,
            Camera::take_edge,
            |camera| *camera.frame(),
        )
    };
    let expected = frames(
        &mut just_in_time,
        touch,
        |camera| &mut camera.chip,
        |camera, now_ns, pose| camera.poses.push(now_ns, pose),
        JustInTime::take_edge,
        |camera| camera.frame,
    );
    [
        expected,
        ahead(Camera::new(chip(), optics(), heading(0.0))),
        ahead(Camera::new(chip(), optics(), heading(0.0)).with_helper()),
    ]
}

#[test]
fn rows_lit_ahead_of_time_are_those_lit_just_in_time_whoever_renders_them() {
    for lines in [1, 135, LINES] {
        let [expected, alone, helped] = three_ways(lines, |_, _| ());
        assert!(
            expected.len() >= 9 && expected[4] != expected[6],
            "they turn"
        );
        assert!(alone == expected && helped == expected, "{lines} lines");
    }
}

#[test]
fn a_sensor_that_is_touched_amid_a_frame_shows_nothing_that_was_lit_for_another() {
    let slower: Touch = |chip, now_ns| chip.set_clock(now_ns, Some(EXTCLK_HZ / 2));
    let brighter: Touch = |chip, now_ns| chip.write_exposure(now_ns, 300, 1.5);
    let duller: Touch = |chip, now_ns| chip.write_register(now_ns, CONTRAST, 0x40);
    let replaced: Touch =
        |chip, now_ns| *chip = Tcm8230::streaming(now_ns + 200_000, EXTCLK_HZ, 50, 2.0);
    let [untouched, ..] = three_ways(135, |_, _| ());
    for (name, touch) in [
        ("slower", slower),
        ("brighter", brighter),
        ("duller", duller),
        ("replaced", replaced),
    ] {
        let [expected, alone, helped] = three_ways(135, touch);
        assert!(expected != untouched, "{name} shows");
        assert!(alone == expected && helped == expected, "{name}");
    }
}
