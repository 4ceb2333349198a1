//! Poses as lines of JSON, and whose pose the camera follows.

use std::f64::consts::FRAC_PI_2;
use std::io::Write;
use std::net::{TcpListener, TcpStream};

use hil::live::{Eyes, PoseError, PoseLine, PoseLines, PoseSource, Seen, TcpPort};
use link::WorldPose;
use nalgebra::Vector3;

use super::{free_port, wait_until};

const LEVEL: PoseLine = PoseLine {
    t: 0.0,
    x: 0.0,
    y: 0.0,
    z: 0.0,
    roll: 0.0,
    pitch: 0.0,
    yaw: 0.0,
};

fn encoded(pose: PoseLine) -> Vec<u8> {
    pose.encode().expect("a line")
}

fn at(x: f64) -> PoseLine {
    PoseLine { x, ..LEVEL }
}

#[test]
fn a_line_says_where_the_camera_is() {
    let line = br#"{"t":1.5,"x":1,"y":2,"z":0.5,"roll":0,"pitch":0,"yaw":0}"#;
    let camera = PoseLine::parse(line).expect("a pose").camera();
    // The optic is 4 cm above the feet.
    let error = camera.position_m - Vector3::new(1.0, 2.0, 0.54);
    assert!(error.norm() < 1e-6, "{error}");
}

#[test]
fn yaw_turns_to_the_left_pitch_bows_the_nose_and_roll_lowers_the_right_side() {
    let turned = |pose: PoseLine, axis: Vector3<f32>| pose.camera().attitude * axis;
    for (pose, axis, becomes) in [
        (
            PoseLine {
                yaw: FRAC_PI_2,
                ..LEVEL
            },
            Vector3::x(),
            Vector3::y(),
        ),
        (
            PoseLine {
                pitch: FRAC_PI_2,
                ..LEVEL
            },
            Vector3::x(),
            -Vector3::z(),
        ),
        (
            PoseLine {
                roll: FRAC_PI_2,
                ..LEVEL
            },
            Vector3::y(),
            Vector3::z(),
        ),
        // Yaw first: the axis of pitch has turned with it.
        (
            PoseLine {
                yaw: FRAC_PI_2,
                pitch: FRAC_PI_2,
                ..LEVEL
            },
            Vector3::y(),
            -Vector3::x(),
        ),
    ] {
        let error = turned(pose, axis) - becomes;
        assert!(error.norm() < 1e-6, "{pose:?}");
    }
}

#[test]
fn a_pose_goes_through_a_line_and_back() {
    let pose = PoseLine {
        t: 12.345,
        x: -3.2,
        y: 0.1 + 0.2,
        z: 0.5,
        roll: 0.01,
        pitch: -0.2,
        yaw: 3.1,
    };
    assert_eq!(PoseLine::parse(&encoded(pose)).expect("a pose"), pose);
    let attitude = nalgebra::UnitQuaternion::from_euler_angles(pose.roll, pose.pitch, pose.yaw);
    let again = PoseLine::new(pose.t, &Vector3::new(pose.x, pose.y, pose.z), &attitude);
    let error = [
        again.roll - pose.roll,
        again.pitch - pose.pitch,
        again.yaw - pose.yaw,
    ];
    assert!(error.iter().all(|error| error.abs() < 1e-12), "{error:?}");
}

#[test]
fn what_is_no_pose_is_an_error_that_says_why() {
    for (line, why) in [
        ("no JSON", "expected"),
        ("{}", "missing field"),
        (r#"{"t":0,"x":0,"y":0,"z":0,"roll":0,"pitch":0}"#, "`yaw`"),
        (
            r#"{"t":0,"x":"1","y":0,"z":0,"roll":0,"pitch":0,"yaw":0}"#,
            "invalid type",
        ),
        (
            r#"{"t":0,"x":null,"y":0,"z":0,"roll":0,"pitch":0,"yaw":0}"#,
            "invalid type",
        ),
        (
            r#"{"t":0,"x":1e999,"y":0,"z":0,"roll":0,"pitch":0,"yaw":0}"#,
            "out of range",
        ),
        (
            r#"{"t":0,"x":0,"y":-1001,"z":0,"roll":0,"pitch":0,"yaw":0}"#,
            "`y` is -1001",
        ),
        (
            r#"{"t":0,"x":0,"y":0,"z":0,"roll":0,"pitch":0,"yaw":0} {}"#,
            "trailing",
        ),
    ] {
        let error = PoseLine::parse(line.as_bytes())
            .expect_err(line)
            .to_string();
        assert!(error.contains(why), "{line}: {error}");
    }
}

#[test]
fn lines_are_found_however_the_bytes_come() {
    let mut bytes = encoded(at(1.0));
    bytes.extend(b"\r\n\nnonsense\n");
    bytes.extend(encoded(at(2.0)));
    for length in 1..=bytes.len() {
        let mut lines = PoseLines::default();
        let said: Vec<_> = bytes
            .chunks(length)
            .flat_map(|piece| lines.push(piece))
            .collect();
        assert!(
            matches!(said.as_slice(), [Ok(first), Err(PoseError::Json(_)), Ok(last)]
                if first.x == 1.0 && last.x == 2.0),
            "{length}: {said:?}"
        );
    }
}

#[test]
fn a_line_without_an_end_is_one_error_and_the_next_line_is_read() {
    let mut lines = PoseLines::default();
    let mut said = Vec::new();
    for _ in 0..100 {
        said.extend(lines.push(&[b'x'; 1000]));
    }
    said.extend(lines.push(b"\n"));
    said.extend(lines.push(&encoded(at(3.0))));
    assert!(matches!(said.as_slice(), [Err(PoseError::TooLong), Ok(pose)] if pose.x == 3.0));
}

/// Somebody who renders, or a simulator: a plain TCP client.
fn client(port: TcpPort) -> TcpStream {
    TcpStream::connect(("127.0.0.1", port.number())).expect("a connection")
}

/// Polls until something holds; what was seen meanwhile.
fn watch(eyes: &mut Eyes, now_ms: u64, until: impl Fn(&Eyes, &[Seen]) -> bool) -> Vec<Seen> {
    let mut seen = Vec::new();
    wait_until("the pose changes", || {
        seen.extend(eyes.poll(now_ms));
        until(eyes, &seen)
    });
    seen
}

fn believed(x: f32) -> WorldPose {
    WorldPose {
        x,
        y: 0.0,
        yaw: 0.0,
    }
}

#[test]
fn without_anything_else_the_camera_is_where_the_states_say() {
    let mut eyes = Eyes::open(PoseSource::State).expect("no port");
    assert_eq!(eyes.pose(0).z, 0.0, "on the ground until a STATE comes");
    assert!(eyes.state(100, believed(1.0)).is_some(), "told");
    assert!(eyes.state(200, believed(2.0)).is_none(), "once");
    assert_eq!((eyes.pose(1_199).x, eyes.pose(1_199).z), (2.0, 0.5));
    assert_eq!(
        eyes.pose(1_200).z,
        0.0,
        "silent for a second: on the ground"
    );
    assert!(eyes.is_belief());
}

#[test]
fn true_poses_win_over_states_as_long_as_their_sender_is_there() {
    let port = free_port();
    let mut eyes = Eyes::open(PoseSource::TcpElseState(port)).expect("a port");
    eyes.state(0, believed(1.0));
    assert_eq!(eyes.pose(0).x, 1.0);

    let mut sender = client(port);
    sender.write_all(&encoded(at(7.0))).expect("sent");
    let seen = watch(&mut eyes, 100, |eyes, _| eyes.pose(100).x == 7.0);
    assert!(
        seen.iter()
            .any(|seen| matches!(seen, Seen::Switched(text) if text.contains("true")))
    );
    assert!(!eyes.is_belief());
    eyes.state(10_000, believed(2.0));
    assert_eq!(eyes.pose(10_000).x, 7.0, "silent but there: held");

    drop(sender);
    watch(&mut eyes, 10_100, |_, seen| !seen.is_empty());
    eyes.state(10_100, believed(3.0));
    assert_eq!(eyes.pose(10_100).x, 3.0);
    assert!(eyes.is_belief());
}

#[test]
fn a_sender_that_ends_with_the_flight_leaves_the_last_true_pose() {
    let port = free_port();
    let mut eyes = Eyes::open(PoseSource::TcpElseState(port)).expect("a port");
    let mut sender = client(port);
    sender.write_all(&encoded(at(7.0))).expect("sent");
    watch(&mut eyes, 1_000, |eyes, _| eyes.pose(1_000).x == 7.0);
    drop(sender);
    let gone = |seen: &Seen| matches!(seen, Seen::News(hil::live::News::Gone { .. }));
    watch(&mut eyes, 1_001, |_, seen| seen.iter().any(gone));
    // What was on its way when the program ended.
    eyes.state(1_001, believed(3.0));
    assert_eq!(eyes.pose(60_000).x, 7.0);
}

#[test]
fn bad_lines_leave_the_last_good_pose_and_senders_come_and_go() {
    let port = free_port();
    let mut eyes = Eyes::open(PoseSource::Tcp(port)).expect("a port");
    for round in 1..=3 {
        let mut sender = client(port);
        let here = f64::from(round);
        sender.write_all(&encoded(at(here))).expect("sent");
        sender.write_all(b"{\"t\":0,\"x\":\n").expect("sent");
        let seen = watch(&mut eyes, 0, |_, seen| {
            seen.iter().any(|seen| matches!(seen, Seen::Bad(_)))
        });
        assert!(matches!(seen.last(), Some(Seen::Bad(_))), "{seen:?}");
        assert_eq!(eyes.pose(0).x, here);
        // Cut off in the middle of a line, which is not the beginning of the next sender's.
        sender.write_all(b"{\"t\":0").expect("sent");
        drop(sender);
        let gone = |seen: &Seen| matches!(seen, Seen::News(hil::live::News::Gone { .. }));
        watch(&mut eyes, 0, |_, seen| seen.iter().any(gone));
        eyes.state(1_000_000, believed(9.0));
        assert_eq!(eyes.pose(1_000_000).x, here, "STATEs do not matter here");
    }
    assert_eq!(eyes.counts(), (3, 3, 3));
}

#[test]
fn a_simulator_may_listen_as_well_as_connect() {
    let port = free_port();
    let listener = TcpListener::bind(("127.0.0.1", port.number())).expect("a free port");
    let mut eyes = Eyes::open(PoseSource::Tcp(port)).expect("a port");
    listener.set_nonblocking(true).expect("an option");
    let mut sender = None;
    wait_until("it is called", || {
        eyes.poll(0);
        sender = sender.take().or_else(|| listener.accept().ok());
        sender.is_some()
    });
    let (mut sender, _) = sender.expect("a caller");
    sender.write_all(&encoded(at(4.0))).expect("sent");
    watch(&mut eyes, 0, |eyes, _| eyes.pose(0).x == 4.0);
}
