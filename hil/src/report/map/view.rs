//! From metres north and west to the paper: equal axes, north up, west to the left.

use crate::record::Recording;
use crate::report::svg::Point;
use crate::report::ticks::Range;

/// How far beyond the flown path walls and beliefs are still shown, as a share of its extent.
const REACH: f64 = 0.6;
/// At least so far, metres.
const LEAST_REACH_M: f64 = 3.0;
/// Margin around everything, as a share of the extent.
const MARGIN: f64 = 0.04;

/// A rectangle on the paper, user units.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Left edge.
    pub left: f64,
    /// Upper edge.
    pub top: f64,
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
}

/// What part of the world is shown where.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Where it is drawn.
    pub frame: Frame,
    /// User units per metre.
    pub scale: f64,
    /// Metres north that are shown.
    pub north: Range,
    /// Metres west that are shown.
    pub west: Range,
}

impl View {
    /// Shows the whole flight in a frame of the given width whose height follows from the flight,
    /// within limits. The narrower direction shows more of the surroundings.
    pub fn of(recording: &Recording, left: f64, top: f64, width: f64, heights: [f64; 2]) -> Self {
        let (north, west) = extent(recording);
        let height = (width * north.span() / west.span()).clamp(heights[0], heights[1]);
        let scale = (width / west.span()).min(height / north.span());
        Self {
            frame: Frame {
                left,
                top,
                width,
                height,
            },
            scale,
            north: stretched(north, height / scale),
            west: stretched(west, width / scale),
        }
    }

    /// Where a place (x north, y west, metres) is on the paper.
    pub fn place(&self, place: [f64; 2]) -> Point {
        [
            self.frame.left + (self.west.high - place[1]) * self.scale,
            self.frame.top + (self.north.high - place[0]) * self.scale,
        ]
    }
}

/// The flown path, the route, and what is near to them.
fn extent(recording: &Recording) -> (Range, Range) {
    let flown = recording
        .track
        .iter()
        .map(|point| [point.truth.x, point.truth.y]);
    let core: Vec<[f64; 2]> = flown.chain(recording.route.iter().copied()).collect();
    let square = Range {
        low: -1.0,
        high: 1.0,
    };
    let north = Range::of(core.iter().map(|place| place[0])).unwrap_or(square);
    let west = Range::of(core.iter().map(|place| place[1])).unwrap_or(square);
    let reach = (REACH * north.span().max(west.span())).max(LEAST_REACH_M);
    let is_near = |place: &[f64; 2]| {
        grown(north, reach).contains(place[0]) && grown(west, reach).contains(place[1])
    };

    let walls = recording.plan.iter().flat_map(|wall| [wall.from, wall.to]);
    let beliefs = recording.track.iter().flat_map(|point| {
        [
            [point.estimate.x, point.estimate.y],
            [point.uncorrected.x, point.uncorrected.y],
        ]
    });
    let (mut shown_north, mut shown_west) = (north, west);
    for place in walls.chain(beliefs).filter(is_near) {
        shown_north = shown_north.with(place[0]);
        shown_west = shown_west.with(place[1]);
    }
    let margin = MARGIN * shown_north.span().max(shown_west.span());
    (grown(shown_north, margin), grown(shown_west, margin))
}

fn grown(range: Range, by: f64) -> Range {
    Range {
        low: range.low - by,
        high: range.high + by,
    }
}

fn stretched(range: Range, span: f64) -> Range {
    grown(range, (span - range.span()).max(0.0) / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::WallSegment;

    fn room() -> View {
        let wall = WallSegment {
            from: [0.0, 0.0],
            to: [2.0, 4.0],
        };
        let recording = Recording {
            plan: vec![wall],
            route: vec![[1.0, 1.0]],
            ..Default::default()
        };
        View::of(&recording, 50.0, 40.0, 600.0, [300.0, 700.0])
    }

    #[test]
    fn north_is_up_and_west_is_left() {
        let view = room();
        let here = view.place([0.0, 0.0]);
        assert!(view.place([1.0, 0.0])[1] < here[1]);
        assert!(view.place([0.0, 1.0])[0] < here[0]);
    }

    #[test]
    fn a_metre_is_as_long_north_as_west() {
        let view = room();
        let here = view.place([0.0, 0.0]);
        let north = here[1] - view.place([1.0, 0.0])[1];
        let west = here[0] - view.place([0.0, 1.0])[0];
        assert!((north - west).abs() < 1e-9);
    }

    #[test]
    fn what_is_shown_fills_the_frame() {
        let view = room();
        assert!((view.west.span() * view.scale - view.frame.width).abs() < 1e-6);
        assert!((view.north.span() * view.scale - view.frame.height).abs() < 1e-6);
    }
}
