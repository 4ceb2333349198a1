//! The column beside the map: what the lines mean, north, and the scale.

use maud::{Markup, html};

use super::view::View;
use crate::record::{Phase, Recording, Reference};
use crate::report::number;
use crate::report::phase;
use crate::report::svg::px;
use crate::report::ticks;

/// Height of one entry, user units.
const ROW: f64 = 23.0;

/// Height of the whole legend, user units.
pub fn height(recording: &Recording) -> f64 {
    ROW * entries(recording).len() as f64
}

/// Explains every kind of mark on the map, from the given place downwards.
pub fn legend(recording: &Recording, left: f64, top: f64) -> Markup {
    html! {
        @for (row, (mark, label)) in entries(recording).into_iter().enumerate() {
            g transform=(format!("translate({} {})", px(left), px(top + ROW * row as f64 + 8.0))) {
                (mark)
                text class="f-ink" x="46" y="4" { (label) }
            }
        }
    }
}

fn entries(recording: &Recording) -> Vec<(Markup, &'static str)> {
    let line = |class: &'static str| html! { path class=(class) d="M0 0h34" {} };
    let flown = [Phase::Outbound, Phase::Odometry, Phase::Homing];
    let mut entries: Vec<(Markup, &str)> = flown
        .map(|phase| (line(phase::line_class(phase)), phase::label(phase)))
        .to_vec();
    let arrow = html! { path class="arrow s-ink" d="M3 0h26m-5 -3.5l5 3.5l-5 3.5" {} };
    entries.push((arrow, "homing vectors"));
    entries.push((dot(), "snapshots, numbered"));
    let is_truth = recording.reference == Reference::Truth;
    let home = match is_truth {
        true => "home, the true start",
        false => "home, the filter's origin",
    };
    entries.push((home_mark([17.0, 0.0]), home));
    entries.push((end_mark([17.0, 0.0]), "end of the flight"));
    if is_truth {
        entries.push((line("line estimate s-muted"), "the filter's estimate"));
        let uncorrected = line("line uncorrected s-uncorrected");
        entries.push((uncorrected, "the same, uncorrected"));
    }
    if !recording.route.is_empty() {
        let route = html! { path class="route s-route" d="M4 0h26" {} };
        entries.push((route, "scripted route"));
    }
    if !recording.plan.is_empty() {
        let wall = html! { path class="wall s-soft" d="M2 0h30" {} };
        entries.push((wall, "walls and panels"));
    }
    entries
}

fn dot() -> Markup {
    html! {
        circle class="dot f-paper s-ink" cx="13" cy="0" r="3.2" {}
        text class="f-ink s-paper halo tiny" x="20" y="-2" { "7" }
    }
}

/// The true start: a ring.
pub fn home_mark([x, y]: [f64; 2]) -> Markup {
    html! { circle class="dot s-ink" fill="none" stroke-width="2" cx=(px(x)) cy=(px(y)) r="8" {} }
}

/// Where the flight ended: a filled square on its corner.
pub fn end_mark([x, y]: [f64; 2]) -> Markup {
    let data = format!("M{} {}l5.5 5.5l-5.5 5.5l-5.5 -5.5z", px(x), px(y - 5.5));
    html! { path class="f-ink s-paper" stroke-width="1.2" d=(data) {} }
}

/// A bar of a round length and an arrow to the north, below the map where they hide nothing.
pub fn scale_and_north(view: &View) -> Markup {
    let metres = ticks::nice_step(view.west.span(), 8);
    let length = metres * view.scale;
    let frame = view.frame;
    let right = frame.left + frame.width;
    let y = frame.top + frame.height + 35.0;
    html! {
        path class="line s-ink" stroke-width="1.6" d=(format!("M{} {}v5h{}v-5", px(right - length), px(y - 5.0), px(length))) {}
        text class="f-ink end" x=(px(right - length - 8.0)) y=(px(y + 1.0)) { (number::trimmed(metres, 2)) " m" }
        path class="f-ink" d=(format!("M{} {}l5 14l-5 -3.5l-5 3.5z", px(frame.left + 6.0), px(y - 13.0))) {}
        text class="f-ink" x=(px(frame.left + 17.0)) y=(px(y + 1.0)) { "N" }
    }
}
