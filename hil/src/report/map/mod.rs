//! The world from above with the flight in it.

mod labels;
mod layers;
mod legend;
mod view;

use maud::{Markup, html};

use self::view::View;
use super::svg::px;
use super::{figures, number, style};
use crate::record::{Recording, Reference};
use crate::summary::Summary;

/// User units across, map and legend, on the page.
const PAGE_WIDTH: f64 = 1048.0;
/// The same in the stand-alone picture: fewer, so that its text is larger.
const PICTURE_WIDTH: f64 = 900.0;
/// Left edge of the map: room for the labels of the axis.
const LEFT: f64 = 46.0;
/// Width of the legend's column, and the gap before it.
const LEGEND: f64 = 202.0;
const GAP: f64 = 26.0;
/// Least and largest height of the map.
const HEIGHTS: [f64; 2] = [400.0, 860.0];
/// Room for the labels of the lower axis.
const BOTTOM: f64 = 44.0;
/// Margin of the stand-alone picture.
const MARGIN: f64 = 24.0;
/// Height of its title lines.
const TITLE: f64 = 64.0;

/// Homing vectors drawn at most.
const MOST_ARROWS: usize = 360;

/// The map and its legend, for the page.
pub fn figure(recording: &Recording) -> Markup {
    let view = view(recording, 6.0, PAGE_WIDTH);
    let view_box = format!(
        "0 0 {} {}",
        px(PAGE_WIDTH),
        px(view.frame.top + view.frame.height + BOTTOM)
    );
    html! {
        svg #map viewBox=(view_box) role="img" aria-label="The world from above with the flight in it"
            data-track=(layers::coarse_track(recording, &view)) {
            (scene(recording, &view))
        }
    }
}

/// The map by itself, with title and key figures.
pub fn picture(recording: &Recording, summary: &Summary) -> Markup {
    let view = view(recording, TITLE, PICTURE_WIDTH);
    let height = view.frame.top + view.frame.height + BOTTOM;
    let (width, height) = (PICTURE_WIDTH + 2.0 * MARGIN, height + 2.0 * MARGIN);
    html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("{0} {0} {1} {2}", px(-MARGIN), px(width), px(height)))
            width=(px(width)) height=(px(height)) role="img" aria-label=(figures::headline(recording, summary)) {
            title { (figures::headline(recording, summary)) }
            style { (maud::PreEscaped(style::figure())) }
            rect class="f-paper" x=(px(-MARGIN)) y=(px(-MARGIN)) width=(px(width)) height=(px(height)) {}
            text class="f-ink title" x="0" y="16" { (figures::headline(recording, summary)) }
            text class="f-muted subtitle" x="0" y="38" { (figures::subline(summary)) }
            (scene(recording, &view))
            (key_figures(recording, summary, PICTURE_WIDTH - LEGEND, TITLE + legend::height(recording) + 14.0))
        }
    }
}

fn view(recording: &Recording, top: f64, width: f64) -> View {
    View::of(recording, LEFT, top, width - LEFT - GAP - LEGEND, HEIGHTS)
}

fn scene(recording: &Recording, view: &View) -> Markup {
    html! {
        (layers::ground(recording, view))
        (layers::flight(recording, view, MOST_ARROWS))
        (legend::scale_and_north(view))
        (legend::legend(recording, view.frame.left + view.frame.width + GAP, view.frame.top))
    }
}

/// Up to four figures below the legend of the picture: those that are known.
fn key_figures(recording: &Recording, summary: &Summary, left: f64, top: f64) -> Markup {
    let (home, alone) = match recording.reference {
        Reference::Truth => ("from home at the end", summary.odometry_only_error_m),
        Reference::Estimate => ("from the start, as it believed", f64::NAN),
    };
    let cross_track_m = match summary.inbound_m > 0.0 {
        true => summary.cross_track_rms_m,
        false => f64::NAN,
    };
    let figures = [
        (summary.home_error_m, 2, "m", home),
        (alone, 2, "m", "by odometry alone"),
        (cross_track_m, 2, "m", "RMS off the way out"),
        (summary.bytes_per_m, 1, "B/m", "of route memory"),
    ];
    let known = figures.into_iter().filter(|(value, ..)| value.is_finite());
    html! {
        @for (row, (value, decimals, unit, label)) in known.enumerate() {
            @let y = top + 48.0 * row as f64 + 20.0;
            text x=(px(left)) y=(px(y)) {
                tspan class="f-ink big" { (number::fixed(value, decimals)) }
                tspan class="f-muted" dx="5" { (unit) }
            }
            text class="f-muted" x=(px(left)) y=(px(y + 17.0)) { (label) }
        }
    }
}
