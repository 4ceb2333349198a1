//! The page: what is told, in which order.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::{charts, figures, log, map, memory, style};
use crate::record::Recording;
use crate::summary::Summary;

/// Read-outs under the pointer. Everything is visible without it.
const SCRIPT: &str = include_str!("hover.js");

/// The whole document.
pub fn page(recording: &Recording, summary: &Summary) -> Markup {
    let time = charts::time_axis(recording);
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { "Flight report: " (figures::headline(summary)) }
                style { (PreEscaped(style::page())) }
            }
            body {
                main {
                    (header(summary))
                    (from_above(recording))
                    (charts::errors(recording, summary, &time))
                    (charts::exposure(recording, &time))
                    (charts::processor(recording, summary, &time))
                    (route_memory(recording, summary))
                    section.long { h2 { "Log" } (log::log(&recording.log)) }
                    footer {
                        "Positions in metres from the true start, x north, y west. "
                        "Headings counter-clockwise from north."
                    }
                }
                script { (PreEscaped(SCRIPT)) }
            }
        }
    }
}

fn header(summary: &Summary) -> Markup {
    let (class, verdict) = if summary.completed {
        ("verdict completed", "✓ completed")
    } else {
        ("verdict failed", "✗ failed")
    };
    html! {
        header {
            div.eyebrow { "Cataglyphis flight report" }
            h1 { (figures::headline(summary)) }
            p { span class=(class) { (verdict) } (summary.outcome) }
            p.note { (figures::subline(summary)) }
            (figures::key_figures(summary))
            (figures::all_figures(summary))
        }
    }
}

fn from_above(recording: &Recording) -> Markup {
    html! {
        section {
            h2 { "The world from above" }
            figure {
                (map::figure(recording))
                figcaption {
                    "Where the drone truly was, in the colours of van Dijk et al. 2024, Fig. 6. "
                    "Arrows are vectors from the camera, drawn from where the drone was; only some are shown. "
                    "Dashed grey is where its filter believed it was; dotted, where the same filter would have believed it was without the camera."
                }
            }
        }
    }
}

fn route_memory(recording: &Recording, summary: &Summary) -> Markup {
    html! {
        section.long {
            h2 { "Route memory, byte by byte" }
            (memory::memory(recording, summary.outbound_m))
        }
    }
}
