//! The flight in a sentence, in key figures, and in all figures of the summary.

use maud::{Markup, html};
use serde_json::Value;

use super::number::{self, NONE};
use crate::summary::Summary;

/// The flight in one sentence.
pub fn headline(summary: &Summary) -> String {
    let out = number::fixed(summary.outbound_m, 0);
    let memory = number::grouped(summary.memory_bytes as u64);
    if summary.completed {
        let error = number::fixed(summary.home_error_m, 2);
        format!(
            "{out} m out and home again, to within {error} m, on {memory} bytes of route memory"
        )
    } else {
        format!("{out} m out, not home again")
    }
}

/// What was flown, and with what.
pub fn subline(summary: &Summary) -> String {
    let apart = number::trimmed(summary.spacing_m, 2);
    let how = match summary.homing {
        "odometry" => "odometry alone".to_owned(),
        "sequence" => format!("snapshots alone, {apart} m apart"),
        _ => format!("snapshots {apart} m apart and odometry"),
    };
    format!(
        "World {} · route {} · {how} · seed {} · {}",
        summary.world, summary.route, summary.seed, summary.backend,
    )
}

/// A figure with its unit, and a line that says what it means.
struct Figure {
    label: &'static str,
    value: String,
    unit: &'static str,
    why: String,
}

/// Twelve figures in a grid.
pub fn key_figures(summary: &Summary) -> Markup {
    let figures = [
        route_figures(summary),
        memory_figures(summary),
        board_figures(summary),
    ];
    html! {
        dl.figures {
            @for figure in figures.into_iter().flatten() {
                div {
                    dt { (figure.label) }
                    dd { (figure.value) @if figure.value != NONE { small { (figure.unit) } } }
                    dd.why { (figure.why) }
                }
            }
        }
    }
}

fn route_figures(summary: &Summary) -> [Figure; 4] {
    [
        Figure {
            label: "Home error",
            value: number::fixed(summary.home_error_m, 2),
            unit: "m",
            why: "from the true start at the end".into(),
        },
        Figure {
            label: "By odometry alone",
            value: number::fixed(summary.odometry_only_error_m, 2),
            unit: "m",
            why: "error of the uncorrected estimate".into(),
        },
        Figure {
            label: "Cross-track, RMS",
            value: number::fixed(summary.cross_track_rms_m, 2),
            unit: "m",
            why: format!(
                "over {} m of the way back",
                number::fixed(summary.inbound_m, 1)
            ),
        },
        Figure {
            label: "Real-time factor",
            value: number::fixed(summary.realtime_factor, 1),
            unit: "×",
            why: format!(
                "{} s of flight in {} s",
                number::fixed(summary.flight_s, 0),
                number::fixed(summary.wall_s, 1)
            ),
        },
    ]
}

fn memory_figures(summary: &Summary) -> [Figure; 4] {
    let captured = number::grouped(summary.frames_captured);
    [
        Figure {
            label: "Route memory per metre",
            value: number::fixed(summary.bytes_per_m, 1),
            unit: "B/m",
            why: format!(
                "over {} m of the way out",
                number::fixed(summary.outbound_m, 1)
            ),
        },
        Figure {
            label: "Route memory",
            value: number::grouped(summary.memory_bytes as u64),
            unit: "bytes",
            why: "with the odometry counts".into(),
        },
        Figure {
            label: "Snapshots",
            value: number::grouped(summary.snapshots as u64),
            unit: "",
            why: match summary.homing {
                "odometry" => "odometry alone was recorded".into(),
                _ => format!("one every {} m", number::trimmed(summary.spacing_m, 2)),
            },
        },
        Figure {
            label: "Frames dropped",
            value: number::grouped(summary.frames_dropped),
            unit: "",
            why: format!(
                "of {} sent; {captured} captured",
                number::grouped(summary.frames_sent)
            ),
        },
    ]
}

fn board_figures(summary: &Summary) -> [Figure; 4] {
    let cycles = summary.cycles_per_frame;
    let image = summary.firmware;
    let unmeasured = || "no processor was emulated".to_owned();
    let count = |value: u32| number::grouped(u64::from(value));
    [
        Figure {
            label: "Cycles per frame, p50",
            value: cycles.map_or(NONE.into(), |cycles| count(cycles.p50)),
            unit: "",
            why: cycles.map_or_else(unmeasured, |cycles| {
                format!("p99 {}, max {}", count(cycles.p99), count(cycles.max))
            }),
        },
        Figure {
            label: "CPU load",
            value: summary
                .cpu_load
                .map_or(NONE.into(), |load| number::fixed(100.0 * load, 1)),
            unit: "%",
            why: summary
                .cpu_load
                .map_or_else(unmeasured, |_| "share of cycles awake".into()),
        },
        Figure {
            label: "Flash",
            value: image.map_or(NONE.into(), |image| kilobytes(image.flash_bytes)),
            unit: "kB",
            why: image.map_or_else(unmeasured, |_| "size of the image".into()),
        },
        Figure {
            label: "Static RAM",
            value: image.map_or(NONE.into(), |image| kilobytes(image.ram_bytes)),
            unit: "kB",
            why: image.map_or_else(unmeasured, |image| stack(image.stack_peak_bytes)),
        },
    ]
}

fn stack(peak_bytes: Option<u32>) -> String {
    match peak_bytes {
        Some(peak) => format!("and {} kB of stack at its peak", kilobytes(peak)),
        None => "the stack reached into it".into(),
    }
}

/// Thousands of bytes with one decimal.
fn kilobytes(bytes: u32) -> String {
    number::fixed(f64::from(bytes) / 1000.0, 1)
}

/// Every figure of `summary.json` under its name there.
pub fn all_figures(summary: &Summary) -> Markup {
    let mut rows = Vec::new();
    match serde_json::to_value(summary) {
        Ok(value) => flatten("", &value, &mut rows),
        Err(error) => rows.push(("error".into(), error.to_string())),
    }
    html! {
        details {
            summary { "All figures of summary.json" }
            dl.all {
                @for (name, value) in rows { div { dt { (name) } dd { (value) } } }
            }
        }
    }
}

/// Objects become dotted names.
fn flatten(name: &str, value: &Value, rows: &mut Vec<(String, String)>) {
    match value {
        Value::Object(fields) => {
            for (field, value) in fields {
                let dot = if name.is_empty() { "" } else { "." };
                flatten(&format!("{name}{dot}{field}"), value, rows);
            }
        }
        Value::String(text) => rows.push((name.to_owned(), text.clone())),
        Value::Number(number) if number.is_f64() => {
            let value = number.as_f64().unwrap_or(f64::NAN);
            rows.push((name.to_owned(), number::trimmed(value, 4)));
        }
        Value::Null => rows.push((name.to_owned(), NONE.to_owned())),
        other => rows.push((name.to_owned(), other.to_string())),
    }
}
