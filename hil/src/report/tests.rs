//! What a report promises.

use super::{html, picture, sample};
use crate::record::{
    LinkDrop, LogLine, OdometryMark, Phase, PlanarPose, Recording, Reference, Side, SnapshotMark,
    TrackPoint, WallSegment,
};
use crate::summary::Summary;

fn at(x: f64, y: f64) -> PlanarPose {
    PlanarPose { x, y, yaw: 0.0 }
}

fn point(t: f64, phase: Phase, truth: PlanarPose) -> TrackPoint {
    TrackPoint {
        t,
        phase,
        truth,
        estimate: truth,
        uncorrected: truth,
        height: 0.5,
    }
}

/// Out a metre, back by odometry, home by camera, with one snapshot.
fn small_flight() -> Recording {
    Recording {
        plan: vec![WallSegment {
            from: [-1.0, 1.0],
            to: [2.0, 1.0],
        }],
        track: vec![
            point(0.0, Phase::Outbound, at(0.0, 0.0)),
            point(1.0, Phase::Outbound, at(1.0, 0.0)),
            point(2.0, Phase::Odometry, at(0.5, 0.1)),
            point(3.0, Phase::Homing, at(0.0, 0.0)),
        ],
        snapshots: vec![SnapshotMark {
            t: 0.0,
            index: 0,
            odometry_count: 0x0103,
            believed: at(0.0, 0.0),
            truth: at(0.0, 0.0),
            coefficients: (0..16).map(|k| -25 + 3 * k).collect(),
        }],
        odometry_stored: 1,
        odometry: vec![OdometryMark {
            index: 0x0103,
            counts: [10, -3],
        }],
        ..Recording::default()
    }
}

/// Both documents have balanced tags and quotes: they parse as XML once the doctype and the void
/// elements of HTML are set aside.
fn assert_well_formed(document: &str) {
    const VOID: [&str; 4] = ["meta", "br", "input", "!DOCTYPE"];
    let mut open = Vec::new();
    let mut rest = document;
    while let Some(start) = rest.find('<') {
        let end = rest[start..].find('>').expect("a tag that ends") + start;
        let tag = &rest[start + 1..end];
        assert!(
            tag.matches('"').count().is_multiple_of(2),
            "quotes in <{tag}>"
        );
        let name = tag
            .trim_start_matches('/')
            .split_whitespace()
            .next()
            .unwrap_or("");
        rest = &rest[end + 1..];
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name), "<{tag}> closes another element");
        } else if !VOID.contains(&name) {
            open.push(name);
        }
        if matches!(tag, "script" | "style") {
            rest = &rest[rest.find("</").expect("an end of raw text")..];
        }
    }
    assert!(open.is_empty(), "left open: {open:?}");
}

/// No word of a value that could not be written as a number.
fn assert_only_numbers(document: &str) {
    for attribute in document.split(" d=\"").skip(1) {
        let data = attribute.split('"').next().unwrap_or("");
        assert!(!data.contains("NaN") && !data.contains("inf"), "{data}");
    }
}

#[test]
fn an_empty_recording_gives_a_valid_page_and_picture() {
    let (recording, summary) = sample::nothing();
    for document in [html(&recording, &summary), picture(&recording, &summary)] {
        assert_well_formed(&document);
        assert_only_numbers(&document);
    }
}

#[test]
fn every_snapshot_byte_count_and_vector_appears_in_hexadecimal() {
    let (_, summary) = sample::nothing();
    let recording = small_flight();
    let page = html(&recording, &summary);
    for value in &recording.snapshots[0].coefficients {
        let byte = format!(">{:02X}</td>", value.to_le_bytes()[0]);
        assert!(page.contains(&byte), "{byte}");
    }
    assert!(page.contains("03 01<br>"), "the count, low byte first");
    assert!(
        page.contains("0A FD <span>1.0, \u{2212}0.3</span>"),
        "the vector and its metres"
    );
}

#[test]
fn totals_are_told_with_and_without_the_counts() {
    let (_, mut summary) = sample::nothing();
    summary.outbound_m = 10.0;
    let page = html(&small_flight(), &summary);
    assert!(page.contains("<b>20 bytes</b> with the odometry counts, 2.0 for each metre"));
    assert!(page.contains("<b>18 bytes</b> without, 1.8 per metre"));
}

#[test]
fn each_phase_has_the_colour_of_the_paper_and_a_line_of_its_own() {
    let (_, summary) = sample::nothing();
    let picture = picture(&small_flight(), &summary);
    for class in [
        "line outbound s-outbound",
        "line odometry s-odometry",
        "line homing s-homing",
    ] {
        // Once on the map, once in the legend.
        assert_eq!(
            picture.matches(&format!("class=\"{class}\"")).count(),
            2,
            "{class}"
        );
    }
    for rule in [
        ".s-outbound{stroke:#c4291f}",
        ".s-odometry{stroke:#e3a500}",
        ".s-homing{stroke:#1c5fc4}",
    ] {
        assert!(picture.contains(rule), "{rule}");
    }
}

#[test]
fn text_from_the_flight_is_escaped() {
    let (mut recording, mut summary) = sample::nothing();
    summary.world = "<b>\"&".into();
    summary.outcome = "</script><script>alert(1)</script>".into();
    summary.completed = false;
    recording.log.push(LogLine {
        t: 0.0,
        source: "rig",
        level: "\"<i>".into(),
        text: "a < b & c".into(),
        origin: None,
    });
    for document in [html(&recording, &summary), picture(&recording, &summary)] {
        assert!(!document.contains("<b>\"&"));
        assert!(!document.contains("alert(1)</script>"));
        assert_well_formed(&document);
    }
    assert!(html(&recording, &summary).contains("a &lt; b &amp; c"));
}

#[test]
fn values_that_are_not_finite_break_nothing() {
    let (_, mut summary) = sample::nothing();
    summary.home_error_m = f64::NAN;
    summary.cross_track_rms_m = f64::INFINITY;
    summary.outbound_m = 0.0;
    let mut recording = small_flight();
    recording.track[1].truth = at(f64::NAN, f64::INFINITY);
    recording.track[2].estimate.yaw = f64::NEG_INFINITY;
    recording.snapshots[0].truth = at(f64::NAN, 0.0);
    for document in [html(&recording, &summary), picture(&recording, &summary)] {
        assert_well_formed(&document);
        assert_only_numbers(&document);
    }
}

/// The small flight as it is known from the logs of the real thing.
fn imported_flight() -> (Recording, Summary) {
    let mut recording = Recording {
        reference: Reference::Estimate,
        plan: Vec::new(),
        ..small_flight()
    };
    let unknown = at(f64::NAN, f64::NAN);
    for point in &mut recording.track {
        point.uncorrected = unknown;
    }
    recording.snapshots[0].coefficients.clear();
    recording.log.push(LogLine {
        t: 0.0,
        source: "rig",
        level: "warn".into(),
        text: "headings: not known".into(),
        origin: None,
    });
    let summary = Summary {
        backend: "cfclient",
        route: "vectors-20230531".into(),
        outbound_m: 1.0,
        inbound_m: 1.0,
        home_error_m: 0.3,
        odometry_only_error_m: f64::NAN,
        spacing_m: f64::NAN,
        realtime_factor: f64::NAN,
        snapshots: 1,
        memory_bytes: 20,
        ..Summary::default()
    };
    (recording, summary)
}

#[test]
fn a_flight_known_by_its_estimate_alone_never_speaks_of_the_truth() {
    let (recording, summary) = imported_flight();
    let (page, picture) = (html(&recording, &summary), picture(&recording, &summary));
    for document in [&page, &picture] {
        assert_well_formed(document);
        assert_only_numbers(document);
        for phrase in [
            "truly",
            "true start",
            "less truth",
            "Home error",
            "uncorrected</text>",
            "odometry alone",
        ] {
            assert!(!document.contains(phrase), "{phrase}");
        }
    }
    assert!(
        page.contains("1 m out and 1 m back, by the drone&#39;s own estimate")
            || page.contains("1 m out and 1 m back, by the drone's own estimate")
    );
    assert!(page.contains("What these logs hold") && page.contains("headings: not known"));
}

#[test]
fn what_is_not_known_is_not_shown() {
    let (recording, summary) = imported_flight();
    let page = html(&recording, &summary);
    for phrase in [
        "Camera frames dropped",
        "Link frames dropped",
        "CPU load",
        "Flash",
        "Static RAM",
        "Real-time factor",
        "<h2>Exposure",
        "<h2>Processor",
        "<h2>Link",
        "<dt>seed",
        "<dt>world",
        "<dt>frames_sent",
        "remembered horizon",
    ] {
        assert!(!page.contains(phrase), "{phrase}");
    }
    assert!(page.contains("The coefficients of the snapshots are not known."));
}

#[test]
fn the_page_names_every_dropped_frame_and_says_when_there_was_none() {
    let (_, summary) = sample::nothing();
    let mut recording = small_flight();
    let none = "No frame of the link was dropped.";
    assert!(html(&recording, &summary).contains(none));
    recording.link_drops.push(LinkDrop {
        t: 1.5,
        side: Side::Autopilot,
        message: "INS_CORRECTION".into(),
        why: "checksum & all".into(),
    });
    let page = html(&recording, &summary);
    assert!(!page.contains(none));
    for part in [
        "<td class=\"count\">1.500</td>",
        ">INS_CORRECTION</td>",
        ">checksum &amp; all</td>",
    ] {
        assert!(page.contains(part), "{part}");
    }
}

#[test]
fn the_page_tells_the_conditions_of_the_flight() {
    let (recording, mut summary) = sample::nothing();
    assert!(!html(&recording, &summary).contains("<b>Conditions</b>"));
    summary.conditions.corrupted_share = 0.01;
    let page = html(&recording, &summary);
    assert!(page.contains("<b>Conditions</b>: 1 % of the link's bytes corrupted"));
}

#[test]
fn the_page_needs_no_network() {
    let (recording, summary) = sample::long_flight();
    let page = html(&recording, &summary);
    for reference in ["src=", "href=", "@import", "url(http", "<link", "<img"] {
        assert!(!page.contains(reference), "{reference}");
    }
    let addresses = page.matches("http").count();
    assert_eq!(
        addresses,
        page.matches("http://www.w3.org/2000/svg").count()
    );
}

#[test]
fn a_long_flight_stays_below_one_and_a_half_megabytes() {
    let (recording, summary) = sample::long_flight();
    assert!(recording.track.len() > 2500 && recording.frames.len() > 8500);
    let page = html(&recording, &summary);
    assert_well_formed(&page);
    assert_only_numbers(&page);
    assert!(page.len() < 1_500_000, "{} bytes", page.len());
}

#[test]
fn equal_flights_give_equal_bytes() {
    let (recording, summary) = sample::long_flight();
    assert_eq!(html(&recording, &summary), html(&recording, &summary));
    let (again, _) = sample::long_flight();
    assert_eq!(picture(&recording, &summary), picture(&again, &summary));
}
