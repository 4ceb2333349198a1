//! The page: what is told, in which order.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::{charts, conditions, figures, key_figures, link, log, map, memory, style};
use crate::record::{LogLine, Recording, Reference};
use crate::summary::Summary;

/// Read-outs under the pointer. Everything is visible without it.
const SCRIPT: &str = include_str!("hover.js");

/// Lines about the logs of an imported flight that are shown at most.
const MOST_REMARKS: usize = 40;

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
                title { "Flight report: " (figures::headline(recording, summary)) }
                style { (PreEscaped(style::page())) }
            }
            body {
                main {
                    (header(recording, summary))
                    @if figures::is_imported(summary) { (remarks(&recording.log)) }
                    (from_above(recording))
                    (charts::errors(recording, summary, &time))
                    @if !figures::is_imported(summary) { (link::link(recording, summary, &time)) }
                    @if !recording.frames.is_empty() { (charts::exposure(recording, &time)) }
                    @if summary.cycles_per_frame.is_some() { (charts::processor(recording, summary, &time)) }
                    (route_memory(recording, summary))
                    section.long { h2 { "Log" } (log::log(&recording.log)) }
                    footer { (origin(recording.reference)) " Headings counter-clockwise from north." }
                }
                script { (PreEscaped(SCRIPT)) }
            }
        }
    }
}

fn header(recording: &Recording, summary: &Summary) -> Markup {
    let (class, verdict) = match summary.completed {
        _ if figures::is_imported(summary) => ("verdict imported", "imported"),
        true => ("verdict completed", "✓ completed"),
        false => ("verdict failed", "✗ failed"),
    };
    html! {
        header {
            div.eyebrow { "Cataglyphis flight report" }
            h1 { (figures::headline(recording, summary)) }
            p { span class=(class) { (verdict) } (summary.outcome) }
            p.note { (figures::subline(summary)) }
            @if let Some(conditions) = conditions::in_words(&summary.conditions) {
                p.note { b { "Conditions" } ": " (conditions) }
            }
            (key_figures::key_figures(recording, summary))
            (figures::all_figures(recording, summary))
        }
    }
}

/// What the importer had to say of the logs before the flight.
fn remarks(log: &[LogLine]) -> Markup {
    let before = log
        .iter()
        .filter(|line| line.source == "rig" && line.t <= 0.0);
    html! {
        section {
            h2 { "What these logs hold" }
            ul.remarks { @for line in before.take(MOST_REMARKS) {
                li class=(line.level) { (line.text) }
            } }
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
                    (whose_path(recording.reference))
                    " in the colours of van Dijk et al. 2024, Fig. 6. "
                    "Arrows are vectors from the camera, drawn from where the drone was; only some are shown. "
                    @if recording.reference == Reference::Truth {
                        "Dashed grey is where its filter believed it was; dotted, where the same filter would have believed it was without the camera."
                    }
                }
            }
        }
    }
}

fn whose_path(reference: Reference) -> &'static str {
    match reference {
        Reference::Truth => "Where the drone truly was,",
        Reference::Estimate => {
            "Where the drone was by its own estimate (its true place is not known),"
        }
    }
}

fn origin(reference: Reference) -> &'static str {
    match reference {
        Reference::Truth => "Positions in metres from the true start, x north, y west.",
        Reference::Estimate => {
            "Positions in metres by the drone's own estimate from where its filter was reset, x north, y west."
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
