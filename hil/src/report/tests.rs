//! What a report promises.

use super::{html, picture, sample};
use crate::record::{
    LogLine, OdometryMark, Phase, PlanarPose, Recording, SnapshotMark, TrackPoint, WallSegment,
};

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
