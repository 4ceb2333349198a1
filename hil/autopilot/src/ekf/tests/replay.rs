//! Reading recordings: typed events, and errors that name file and line.

use crate::ekf::replay::{Action, ReplayError, RowFault, recording, table};
use crate::ekf::{Measurement, Range};

const HEADER: &str = "tick_ms,kind,v0,v1,v2,v3,v4,v5,v6,v7\n";

fn parse(rows: &str) -> Result<Vec<crate::ekf::replay::Event>, ReplayError> {
    let source = table::Source::of("a.events.csv", &format!("{HEADER}{rows}"));
    recording::events(&source)
}

fn fault(rows: &str) -> (String, RowFault) {
    match parse(rows) {
        Err(error @ ReplayError::Row { .. }) => {
            let text = error.to_string();
            let ReplayError::Row { fault, .. } = error else {
                unreachable!("matched above")
            };
            (text, fault)
        }
        other => panic!("no fault in a row: {other:?}"),
    }
}

#[test]
fn events_become_measurements() {
    let events = parse("15,tof,0.5,0.0025,,,,,,\n1000,reset,1,,,,,,,\n1900,flying,1,,,,,,,\n")
        .expect("a sound file");
    assert_eq!(events.len(), 3);
    assert_eq!(events[0].tick_ms, 15);
    let range = Range {
        distance_m: 0.5,
        sd_m: 0.0025,
    };
    assert_eq!(events[0].action, Action::Measure(Measurement::Range(range)));
    assert_eq!(events[1].action, Action::Reset);
    assert_eq!(events[2].action, Action::Flying(true));
}

#[test]
fn a_pose_takes_its_heading_from_the_yaw_column() {
    let events = parse("7,pose,1,2,3,1.2,0.01,-0.02,0.01,0.0045\n").expect("a sound file");
    let Action::Measure(Measurement::Pose(pose)) = events[0].action else {
        panic!("not a pose: {:?}", events[0]);
    };
    let (_, _, yaw) = pose.attitude.euler_angles();
    assert!((yaw - 1.2).abs() < 1e-3);
    assert_eq!(pose.sd_attitude_rad, 0.0045);
}

#[test]
fn a_fault_names_file_line_and_column() {
    let (text, found) = fault("15,tof,0.5,0.0025,,,,,,\n20,tof,half,0.0025,,,,,,\n");
    assert!(text.starts_with("a.events.csv:3: "), "{text}");
    assert_eq!(
        found,
        RowFault::NotANumber {
            column: "v0",
            text: "half".into()
        }
    );
    assert_eq!(fault("15,tof,0.5\n").1, RowFault::Missing("v1"));
    assert_eq!(
        fault("15,sonar,0.5\n").1,
        RowFault::UnknownEvent("sonar".into())
    );
    assert_eq!(
        fault("15,reset,1\n14,reset,1\n").1,
        RowFault::OutOfOrder(14)
    );
}

#[test]
fn a_missing_file_is_named() {
    let error = crate::ekf::replay::Recording::load(std::path::Path::new("/nowhere"), "x")
        .expect_err("there is no such file");
    assert!(error.to_string().contains("/nowhere/x.imu.csv"));
}
