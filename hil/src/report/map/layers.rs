//! What is drawn on the map, from the floor upwards.

use core::fmt::Write;

use maud::{Markup, html};

use super::view::View;
use super::{labels, legend};
use crate::record::{Phase, PlanarPose, Recording, Reference, SnapshotMark, TrackPoint};
use crate::report::svg::{self, Point, px};
use crate::report::ticks::{self, Range};
use crate::report::{number, phase};

/// Points of a path nearer than this are one, user units.
const PATH_STEP: f64 = 0.7;
/// Arrows shorter than this say nothing, user units.
const SHORTEST_ARROW: f64 = 2.5;
/// Length of an arrow's head, user units.
const ARROW_HEAD: f64 = 3.4;
/// From this extent on, metres, the grid is never finer than a metre.
const METRE_GRID_M: f64 = 3.0;
/// Points of the track that the read-out knows.
const COARSE_POINTS: usize = 1200;

/// Grid, axes, scripted route and walls.
pub fn ground(recording: &Recording, view: &View) -> Markup {
    let route = svg::polyline(recording.route.iter().map(|place| view.place(*place)));
    let walls: String = recording
        .plan
        .iter()
        .map(|wall| svg::polyline([view.place(wall.from), view.place(wall.to)]))
        .collect();
    let frame = view.frame;
    html! {
        clipPath id="map-frame" {
            rect x=(px(frame.left)) y=(px(frame.top)) width=(px(frame.width)) height=(px(frame.height)) {}
        }
        (grid(view))
        g clip-path="url(#map-frame)" {
            path class="route s-route" d=(route) {}
            path class="wall s-soft" d=(walls) {}
        }
        rect class="axis s-soft" x=(px(frame.left)) y=(px(frame.top)) width=(px(frame.width)) height=(px(frame.height)) {}
    }
}

/// Lines every round number of metres, equal both ways, with their labels.
fn grid(view: &View) -> Markup {
    let frame = view.frame;
    let (bottom, right) = (frame.top + frame.height, frame.left + frame.width);
    let most = (frame.width.max(frame.height) / 46.0) as usize;
    let span = view.west.span().max(view.north.span());
    let step = ticks::nice_step(span, most).max(if span > METRE_GRID_M { 1.0 } else { 0.0 });
    let east = Range {
        low: -view.west.high,
        high: -view.west.low,
    };
    let decimals = ticks::decimals(step);
    html! {
        @for north in ticks::whole_steps(view.north, step) {
            @let y = view.place([north, 0.0])[1];
            path class="hair s-grid" d=(format!("M{} {}H{}", px(frame.left), px(y), px(right))) {}
            text class="f-muted small end" x=(px(frame.left - 7.0)) y=(px(y + 4.0)) { (number::fixed(north, decimals)) }
        }
        @for east in ticks::whole_steps(east, step) {
            @let x = view.place([0.0, -east])[0];
            path class="hair s-grid" d=(format!("M{} {}V{}", px(x), px(frame.top), px(bottom))) {}
            text class="f-muted small middle" x=(px(x)) y=(px(bottom + 17.0)) { (number::fixed(east, decimals)) }
        }
        text class="f-muted small middle" x=(px(frame.left + frame.width / 2.0)) y=(px(bottom + 36.0)) { "east (−y), m" }
        text class="f-muted small middle" transform=(format!("translate(10 {}) rotate(-90)", px(frame.top + frame.height / 2.0))) {
            "north (x), m"
        }
    }
}

/// Beliefs, the true path, homing vectors, snapshots, start and end.
pub fn flight(recording: &Recording, view: &View, most_arrows: usize) -> Markup {
    let track = &recording.track;
    let pieces = phase::pieces(track);
    let (out, back): (Vec<_>, Vec<_>) = pieces
        .into_iter()
        .partition(|(phase, _)| matches!(phase, Phase::Ground | Phase::Outbound));
    let home = view.place([0.0, 0.0]);
    let end = track.last().map(|last| at(view, last.truth));
    let marks: Vec<Point> = end.into_iter().chain([home]).collect();
    html! {
        g clip-path="url(#map-frame)" {
            @if recording.reference == Reference::Truth {
                path class="line uncorrected s-uncorrected" d=(path(view, track, |point| point.uncorrected)) {}
                path class="line estimate s-muted" d=(path(view, track, |point| point.estimate)) {}
            }
            @for (phase, piece) in out {
                path class=(phase::line_class(phase)) d=(path(view, piece, |point| point.truth)) {}
            }
            // Paper-coloured below the way back, so that it stands out where it covers the way out.
            @for (_, piece) in &back {
                path class="line casing s-paper" d=(path(view, piece, |point| point.truth)) {}
            }
            @for (phase, piece) in back {
                path class=(phase::line_class(phase)) d=(path(view, piece, |point| point.truth)) {}
            }
            path class="arrow s-ink" d=(arrows(recording, view, most_arrows)) {}
            (snapshots(&recording.snapshots, view))
            (legend::home_mark(home))
            @if let Some(end) = end { (legend::end_mark(end)) }
            (numbers(&recording.snapshots, view, &marks))
        }
    }
}

/// True positions for the read-out: `t x y` in seconds and user units, separated by commas.
pub fn coarse_track(recording: &Recording, view: &View) -> String {
    let step = recording.track.len().div_ceil(COARSE_POINTS).max(1);
    let mut data = String::new();
    for point in recording.track.iter().step_by(step) {
        let place = at(view, point.truth);
        if svg::is_finite(place) && point.t.is_finite() {
            // Writing to a String cannot fail.
            let _ = write!(data, "{:.1} {} {},", point.t, px(place[0]), px(place[1]));
        }
    }
    data.pop();
    data
}

fn at(view: &View, pose: PlanarPose) -> Point {
    view.place([pose.x, pose.y])
}

fn path(view: &View, piece: &[TrackPoint], pose: impl Fn(&TrackPoint) -> PlanarPose) -> String {
    let places = piece.iter().map(|point| at(view, pose(point)));
    svg::polyline(svg::thin(places, PATH_STEP))
}

/// Homing vectors from where the drone was, evenly thinned.
fn arrows(recording: &Recording, view: &View, most: usize) -> String {
    let visual: Vec<_> = recording
        .vectors
        .iter()
        .filter(|vector| vector.visual)
        .collect();
    let step = visual.len().div_ceil(most).max(1);
    visual
        .into_iter()
        .step_by(step)
        .filter_map(|vector| {
            let from = at(view, vector.truth);
            let [dx, dy] = [
                vector.target.y - vector.start.y,
                vector.target.x - vector.start.x,
            ];
            arrow(from, [-dx * view.scale, -dy * view.scale])
        })
        .collect()
}

/// A shaft and a head of fixed size; none if it would be too short to see or is not finite.
fn arrow(from: Point, shaft: Point) -> Option<String> {
    let length = libm::hypot(shaft[0], shaft[1]);
    if !svg::is_finite(from) || !length.is_finite() || length < SHORTEST_ARROW {
        return None;
    }
    let [ux, uy] = [shaft[0] / length, shaft[1] / length];
    let tip = [from[0] + shaft[0], from[1] + shaft[1]];
    let barb = |side: f64| {
        let [back, out] = [ARROW_HEAD, side * ARROW_HEAD * 0.6];
        [tip[0] - back * ux - out * uy, tip[1] - back * uy + out * ux]
    };
    Some(svg::polyline([from, tip]) + &svg::polyline([barb(1.0), tip, barb(-1.0)]))
}

/// Dots where the snapshots were taken.
fn snapshots(marks: &[SnapshotMark], view: &View) -> Markup {
    let dots = marks.iter().map(|mark| (mark, at(view, mark.truth)));
    html! {
        @for (mark, dot) in dots.filter(|(_, dot)| svg::is_finite(*dot)) {
            circle class="dot f-paper s-ink" cx=(px(dot[0])) cy=(px(dot[1])) r="3.2" {
                title { (description(mark)) }
            }
        }
    }
}

/// Their numbers, where there is room.
fn numbers(snapshots: &[SnapshotMark], view: &View, marks: &[Point]) -> Markup {
    let dot = |mark: &SnapshotMark| (at(view, mark.truth), mark.index);
    let dots: Vec<(Point, u16)> = snapshots.iter().map(dot).collect();
    html! {
        @for ((_, index), spot) in dots.iter().zip(labels::place(&dots, marks)) {
            @if let Some([x, y]) = spot {
                text class="f-ink s-paper halo tiny middle" x=(px(x)) y=(px(y + 3.4)) { (index) }
            }
        }
    }
}

fn description(mark: &SnapshotMark) -> String {
    format!(
        "Snapshot {}, {} s, x {} m, y {} m",
        mark.index,
        number::fixed(mark.t, 1),
        number::fixed(mark.truth.x, 2),
        number::fixed(mark.truth.y, 2),
    )
}
