//! The flight in key figures. What is not known is not shown.

use maud::{Markup, html};

use super::number;
use crate::record::{Recording, Reference};
use crate::summary::Summary;

/// A figure with its unit, and a line that says what it means.
struct Figure {
    label: &'static str,
    value: String,
    unit: &'static str,
    why: String,
}

/// A dozen figures in a grid.
pub fn key_figures(recording: &Recording, summary: &Summary) -> Markup {
    let figures = route_figures(recording.reference, summary)
        .into_iter()
        .chain(memory_figures(summary))
        .chain(transport_figures(summary))
        .chain(board_figures(summary));
    html! {
        dl.figures {
            @for figure in figures.flatten() {
                div {
                    dt { (figure.label) }
                    dd { (figure.value) small { (figure.unit) } }
                    dd.why { (figure.why) }
                }
            }
        }
    }
}

fn route_figures(reference: Reference, summary: &Summary) -> [Option<Figure>; 4] {
    let is_truth = reference == Reference::Truth;
    [
        known(summary.home_error_m).map(|error| Figure {
            label: if is_truth {
                "Home error"
            } else {
                "From the start at the end"
            },
            value: number::fixed(error, 2),
            unit: "m",
            why: match reference {
                Reference::Truth => "from the true start at the end".into(),
                Reference::Estimate => "by the drone's own estimate".into(),
            },
        }),
        known(summary.odometry_only_error_m)
            .filter(|_| is_truth)
            .map(|error| Figure {
                label: "By odometry alone",
                value: number::fixed(error, 2),
                unit: "m",
                why: "error of the uncorrected estimate".into(),
            }),
        known(summary.cross_track_rms_m)
            .filter(|_| summary.inbound_m > 0.0)
            .map(|rms| Figure {
                label: "Cross-track, RMS",
                value: number::fixed(rms, 2),
                unit: "m",
                why: format!(
                    "over {} m of the way back",
                    number::fixed(summary.inbound_m, 1)
                ),
            }),
        known(summary.realtime_factor).map(|factor| Figure {
            label: "Real-time factor",
            value: number::fixed(factor, 1),
            unit: "×",
            why: format!(
                "{} s of flight in {} s",
                number::fixed(summary.flight_s, 0),
                number::fixed(summary.wall_s, 1)
            ),
        }),
    ]
}

fn memory_figures(summary: &Summary) -> [Option<Figure>; 3] {
    let out = number::fixed(summary.outbound_m, 1);
    let figures = [
        Figure {
            label: "Route memory per metre",
            value: number::fixed(summary.bytes_per_m, 1),
            unit: "B/m",
            why: format!("over {out} m of the way out"),
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
                _ if summary.spacing_m.is_finite() => {
                    format!("one every {} m", number::trimmed(summary.spacing_m, 2))
                }
                _ => format!("over {out} m of the way out"),
            },
        },
    ];
    figures.map(|figure| (summary.memory_bytes > 0).then_some(figure))
}

/// Camera frames and frames of the link, where any were counted.
fn transport_figures(summary: &Summary) -> [Option<Figure>; 2] {
    let link = &summary.link;
    let sent = link.to_camera.frames_sent + link.to_autopilot.frames_sent;
    let lost = link.to_camera.frames_dropped + link.to_autopilot.frames_dropped;
    let camera = Figure {
        label: "Camera frames dropped",
        value: number::grouped(summary.frames_dropped),
        unit: "",
        why: format!(
            "of {} sent; {} captured",
            number::grouped(summary.frames_sent),
            number::grouped(summary.frames_captured)
        ),
    };
    let link = Figure {
        label: "Link frames dropped",
        value: number::grouped(lost),
        unit: "",
        why: format!("of {} sent, both ways", number::grouped(sent)),
    };
    [
        (summary.frames_sent > 0).then_some(camera),
        (sent + lost > 0).then_some(link),
    ]
}

fn board_figures(summary: &Summary) -> [Option<Figure>; 4] {
    let image = summary.firmware;
    let count = |value: u32| number::grouped(u64::from(value));
    [
        summary.cycles_per_frame.map(|cycles| Figure {
            label: "Cycles per frame, p50",
            value: count(cycles.p50),
            unit: "",
            why: format!("p99 {}, max {}", count(cycles.p99), count(cycles.max)),
        }),
        summary.cpu_load.map(|load| Figure {
            label: "CPU load",
            value: number::fixed(100.0 * load, 1),
            unit: "%",
            why: "share of cycles awake".into(),
        }),
        image.map(|image| Figure {
            label: "Flash",
            value: kilobytes(image.flash_bytes),
            unit: "kB",
            why: "size of the image".into(),
        }),
        image.map(|image| Figure {
            label: "Static RAM",
            value: kilobytes(image.ram_bytes),
            unit: "kB",
            why: stack(image.stack_peak_bytes, summary.backend),
        }),
    ]
}

fn known(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

fn stack(peak_bytes: Option<u32>, backend: &str) -> String {
    match peak_bytes {
        Some(peak) => format!("and {} kB of stack at its peak", kilobytes(peak)),
        None if backend == "board" => "and a stack that was not measured".into(),
        None => "the stack reached into it".into(),
    }
}

/// Thousands of bytes with one decimal.
fn kilobytes(bytes: u32) -> String {
    number::fixed(f64::from(bytes) / 1000.0, 1)
}
