//! The time line as a picture: one frame period in whole, and what vision does with the frame
//! under the magnifying glass.

mod panel;
mod period;

use maud::{PreEscaped, html};

use super::timeline::Timeline;
use crate::report::style;
use crate::report::svg::px;

use panel::Panel;

/// User units of the whole picture.
const WIDTH: f64 = 1200.0;
/// Room for the title.
const TITLE: f64 = 52.0;

/// One frame period of a time line as a stand-alone SVG: of all in the window, the first in which
/// most stages run.
pub fn picture(timeline: &Timeline) -> String {
    let period = period::busiest(timeline.slices());
    let whole = Panel::new(timeline, period, "One frame period, ms");
    let close = period::look(timeline.slices(), period).map(|span| {
        Panel::new(
            timeline,
            span,
            "The same, where vision looks at the frame, ms",
        )
    });
    let below = TITLE + whole.height();
    let height = below + close.as_ref().map_or(0.0, Panel::height);
    html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {} {}", px(WIDTH), px(height)))
            role="img" aria-label="Timing diagram of a frame period" {
            style { (PreEscaped(style::figure())) }
            rect class="f-paper" width=(px(WIDTH)) height=(px(height)) {}
            text class="f-ink title" x="16" y="24" { "Tasks, interrupts, DMA and link in one frame period" }
            text class="f-muted subtitle" x="16" y="43" {
                (format!("from {:.6} s of the flight on; by the emulated core's cycle counter", 1.0e-6 * period.low))
            }
            (whole.draw(TITLE))
            @if let Some(close) = close { (close.draw(below)) }
        }
    }
    .into_string()
}

#[cfg(test)]
fn slice(
    track: super::timeline::Track,
    name: &str,
    from_us: f64,
    for_us: f64,
) -> super::timeline::Slice {
    super::timeline::Slice {
        track,
        name: name.to_owned(),
        from_us,
        for_us,
    }
}
