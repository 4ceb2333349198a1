//! Reading recordings: typed events, errors that name file and line, and what counts as a deviation.

use nalgebra::Vector3;
use proptest::prelude::*;

use crate::ekf::replay::table::Source;
use crate::ekf::replay::{Action, Event, Limits, Recording, ReplayError, RowFault, deviation};
use crate::ekf::{Measurement, Parameters, Range};

const IMU_HEADER: &str = "gx_cdps,gy_cdps,gz_cdps,ax_1e4g,ay_1e4g,az_1e4g\n";
const EVENTS_HEADER: &str = "tick_ms,kind,v0,v1,v2,v3,v4,v5,v6,v7\n";
const EKF_HEADER: &str = "tick_ms,x,y,z,vx,vy,vz,pbx,pby,pbz,qw,qx,qy,qz,roll_deg,pitch_legacy_deg,yaw_deg,\
    Pxx,Pyy,Pzz,Pvx,Pvy,Pvz,Pd0,Pd1,Pd2,P08,P18,P37,P25\n";
/// The filter after its tick 9, at rest: the variances of a reset and nine milliseconds of noise, for the first tick
/// predicts and adds noise over no time.
const AT_REST_ROW: &str = "9,0,0,0,0,0,0,0,0,0,1,0,0,0,0,0,0,\
    100,100,1,0.00010225,0.00010225,0.000109,0.00010009,0.00010009,0.00010009,0,0,0,0\n";

fn still_imu(rows: usize) -> String {
    IMU_HEADER.to_owned() + &"0,0,0,0,0,10000\n".repeat(rows)
}

fn parse(imu: &str, events: &str, ekf: &str) -> Result<Recording, ReplayError> {
    Recording::parse(
        &Source::of("a.imu.csv", imu),
        &Source::of("a.events.csv", events),
        &Source::of("a.ekf.csv", ekf),
    )
}

fn parse_events(rows: &str) -> Result<Vec<Event>, ReplayError> {
    let ekf = format!("{EKF_HEADER}{AT_REST_ROW}");
    let recording = parse(&still_imu(2000), &format!("{EVENTS_HEADER}{rows}"), &ekf);
    recording.map(|recording| recording.events)
}

/// The fault and the error's text, which begins with file and line.
fn fault<T: std::fmt::Debug>(result: Result<T, ReplayError>) -> (String, RowFault) {
    match result {
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
fn imu_rows_are_hundredths_of_degrees_per_second_and_ten_thousandths_of_g() {
    let imu = format!("{IMU_HEADER}2,-9,36,167,-237,10168\n");
    let ekf = EKF_HEADER.to_owned() + &AT_REST_ROW.replacen('9', "0", 1);
    let recording = parse(&imu, EVENTS_HEADER, &ekf).expect("a sound recording");
    assert_eq!(recording.imu.len(), 1);
    let sample = recording.imu[0];
    assert_eq!(sample.gyro_deg_s, Vector3::new(0.02, -0.09, 0.36));
    assert_eq!(sample.acc_g, Vector3::new(0.0167, -0.0237, 1.0168));
}

#[test]
fn events_become_measurements() {
    let rows = "15,tof,0.5,0.0025,,,,,,\n1000,reset,1,,,,,,,\n1900,flying,1,,,,,,,\n";
    let events = parse_events(rows).expect("a sound file");
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
    let events = parse_events("7,pose,1,2,3,1.2,0.01,-0.02,0.01,0.0045\n").expect("a sound file");
    let Action::Measure(Measurement::Pose(pose)) = events[0].action else {
        panic!("not a pose: {:?}", events[0]);
    };
    let (_, _, yaw) = pose.attitude.euler_angles();
    assert!((yaw - 1.2).abs() < 1e-3);
    assert_eq!(pose.sd_attitude_rad, 0.0045);
}

#[test]
fn a_fault_names_file_line_and_column() {
    let (text, found) = fault(parse_events(
        "15,tof,0.5,0.0025,,,,,,\n20,tof,half,0.0025,,,,,,\n",
    ));
    assert!(text.starts_with("a.events.csv:3: "), "{text}");
    let not_a_number = |text: &str| RowFault::NotANumber {
        column: "v0",
        text: text.into(),
    };
    assert_eq!(found, not_a_number("half"));
    for senseless in ["NaN", "inf", "-inf"] {
        let row = format!("15,tof,{senseless},0.0025\n");
        assert_eq!(fault(parse_events(&row)).1, not_a_number(senseless));
    }
    let faults = [
        ("15,tof,0.5\n", RowFault::Missing("v1")),
        ("15,tof\n", RowFault::Missing("v0")),
        ("15,sonar,0.5\n", RowFault::UnknownEvent("sonar".into())),
        ("15,reset,1\n14,reset,1\n", RowFault::OutOfOrder(14)),
        (
            "2000,reset,1\n",
            RowFault::BehindTheImu {
                tick_ms: 2000,
                imu_rows: 2000,
            },
        ),
        (
            "15,tof,0,0,0,0,0,0,0,0,0\n",
            RowFault::TooManyFields {
                found: 11,
                columns: 10,
            },
        ),
        (
            "-1,reset,1\n",
            RowFault::NotANumber {
                column: "tick_ms",
                text: "-1".into(),
            },
        ),
    ];
    for (rows, expected) in faults {
        assert_eq!(fault(parse_events(rows)).1, expected, "{rows}");
    }
}

#[test]
fn a_file_that_holds_nothing_or_lacks_a_column_is_told_by_name() {
    let imu = still_imu(10);
    let ekf = format!("{EKF_HEADER}{AT_REST_ROW}");
    let short = imu.replacen("az_1e4g", "az", 1);
    for (files, place, expected) in [
        (
            ("", EVENTS_HEADER, &ekf[..]),
            "a.imu.csv:1",
            RowFault::NoHeader,
        ),
        (
            (IMU_HEADER, EVENTS_HEADER, &ekf),
            "a.imu.csv:1",
            RowFault::NoRows,
        ),
        (
            (&short, EVENTS_HEADER, &ekf),
            "a.imu.csv:2",
            RowFault::NoColumn("az_1e4g"),
        ),
        ((&imu, "", &ekf), "a.events.csv:1", RowFault::NoHeader),
        (
            (&imu, EVENTS_HEADER, EKF_HEADER),
            "a.ekf.csv:1",
            RowFault::NoRows,
        ),
    ] {
        let (text, found) = fault(parse(files.0, files.1, files.2));
        assert!(text.starts_with(place), "{text}");
        assert_eq!(found, expected);
    }
}

#[test]
fn a_reference_behind_the_last_imu_sample_is_no_success() {
    // It would never be compared.
    let ekf = format!("{EKF_HEADER}{AT_REST_ROW}");
    let (text, found) = fault(parse(&still_imu(9), EVENTS_HEADER, &ekf));
    assert!(text.starts_with("a.ekf.csv:2: "), "{text}");
    let behind = RowFault::BehindTheImu {
        tick_ms: 9,
        imu_rows: 9,
    };
    assert_eq!(found, behind);
}

#[test]
fn line_ends_of_other_systems_and_blank_lines_at_the_end_are_read() {
    let windows = |text: &str| text.replace('\n', "\r\n") + "\r\n\r\n";
    let ekf = windows(&format!("{EKF_HEADER}{AT_REST_ROW}"));
    let recording = parse(&windows(&still_imu(10)), &windows(EVENTS_HEADER), &ekf);
    assert_eq!(recording.expect("a sound recording").imu.len(), 10);
}

#[test]
fn a_missing_file_is_named() {
    let error =
        Recording::load(std::path::Path::new("/nowhere/x")).expect_err("there is no such file");
    assert!(error.to_string().contains("/nowhere/x.imu.csv"));
}

#[test]
fn a_recording_that_agrees_is_within_the_limits_and_one_that_does_not_is_not() {
    let compare = |row: &str| {
        let recording = parse(
            &still_imu(10),
            EVENTS_HEADER,
            &(EKF_HEADER.to_owned() + row),
        );
        deviation(
            &recording.expect("a sound recording"),
            Parameters::default(),
        )
        .expect("the events fit the queue")
    };
    let agreeing = compare(AT_REST_ROW);
    assert!(agreeing.within(&Limits::FIRMWARE), "{agreeing:?}");
    assert_eq!(agreeing.compared, 1);

    // Each of the four limits by itself: position, velocity, attitude, a variance.
    for (column, value) in [
        (1, "0.0006"),
        (4, "0.0003"),
        (11, "0.0001"),
        (25, "0.0001003"),
    ] {
        let mut fields: Vec<&str> = AT_REST_ROW.split(',').collect();
        fields[column] = value;
        let moved = compare(&fields.join(","));
        assert!(!moved.within(&Limits::FIRMWARE), "column {column}");
    }
}

#[test]
fn nothing_compared_or_no_number_once_is_never_within() {
    let rows = format!("{EKF_HEADER}{AT_REST_ROW}{AT_REST_ROW}");
    let recording = parse(&still_imu(10), EVENTS_HEADER, &rows).expect("a sound recording");
    let within = |recording: &Recording| {
        let found = deviation(recording, Parameters::default()).expect("no events");
        found.within(&Limits::FIRMWARE)
    };
    assert!(within(&recording));

    let mut empty = recording.clone();
    empty.references.clear();
    assert!(!within(&empty));

    // The second, good row must not wipe out the first.
    let mut senseless = recording;
    senseless.references[0].position_m.x = f32::NAN;
    assert!(!within(&senseless));
}

proptest! {
    #[test]
    fn no_text_whatever_makes_the_reader_panic(
        imu in "[-0-9a-z_.,\\n ]{0,200}",
        events in "[-0-9a-z_.,\\n ]{0,200}",
    ) {
        let ekf = format!("{EKF_HEADER}{AT_REST_ROW}");
        let imu = format!("{IMU_HEADER}{imu}");
        let events = format!("{EVENTS_HEADER}{events}");
        if let Err(ReplayError::Row { line, .. }) = parse(&imu, &events, &ekf) {
            prop_assert!(line >= 1);
        }
    }

    #[test]
    fn a_recording_cut_anywhere_is_read_or_refused_with_its_line(cut in 0_usize..400) {
        let rows = "0,pose,1,2,3,1.2,0.01,-0.02,0.01,0.0045\n5,flow,1,-2,0.01,2,,,,\n";
        let whole = format!("{EVENTS_HEADER}{rows}");
        let cut = &whole[..cut.min(whole.len())];
        let ekf = format!("{EKF_HEADER}{AT_REST_ROW}");
        match parse(&still_imu(10), cut, &ekf) {
            Ok(recording) => prop_assert!(recording.events.len() <= 2),
            Err(error) => prop_assert!(error.to_string().starts_with("a.events.csv:"), "{error}"),
        }
    }
}
