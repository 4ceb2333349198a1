//! The page: what is told, in which order.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::plot::{Events, Level, Plot, Series, TimeAxis};
use super::svg::Point;
use super::ticks::Range;
use super::{errors, figures, histogram, log, map, memory, number, phase, style};
use crate::record::{FrameMark, Recording};
use crate::summary::Summary;

/// Mean horizon luma that the exposure aims at, of 255 (van Dijk et al. 2024, Image processing).
const LUMA_SET_POINT: f64 = 80.0;

/// Read-outs under the pointer. Everything is visible without it.
const SCRIPT: &str = include_str!("hover.js");

/// The whole document.
pub fn page(recording: &Recording, summary: &Summary) -> Markup {
    let time = time_axis(recording);
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { "Flight report: " (map::headline(summary)) }
                style { (PreEscaped(style::page())) }
            }
            body {
                main {
                    (header(summary))
                    (from_above(recording))
                    (error_plots(recording, summary, &time))
                    (exposure_plots(recording, &time))
                    (processor_plots(recording, summary, &time))
                    (route_memory(recording, summary))
                    section.long { h2 { "Log" } (log::log(&recording.log)) }
                    footer { "Cataglyphis flight report. Positions: x north, y west, metres, from the true start. Headings: counter-clockwise from north." }
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
            h1 { (map::headline(summary)) }
            p { span class=(class) { (verdict) } (summary.outcome) }
            p.note {
                "World " (summary.world) ", route " (summary.route) ", seed " (summary.seed)
                ", backend " (summary.backend) ", homing " (summary.homing)
                ", a snapshot every " (number::fixed(summary.spacing_m, 2)) " m."
            }
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
                    "An arrow is a vector from the camera, drawn from where the drone was; only some of them are shown. "
                    "Grey: where its filter believed it was. Dotted: where the same filter would have believed to be without the camera."
                }
            }
        }
    }
}

fn error_plots(recording: &Recording, summary: &Summary, time: &TimeAxis) -> Markup {
    let track = &recording.track;
    let pair = |uncorrected: Vec<Point>, estimate: Vec<Point>| {
        vec![
            series(
                "without the camera",
                "line uncorrected s-uncorrected",
                uncorrected,
            ),
            series("with the camera", "line curve s-ink", estimate),
        ]
    };
    let position = Plot {
        title: "Position: belief less truth",
        unit: "m",
        height: 170.0,
        from_zero: true,
        series: pair(
            errors::position(track, |point| point.uncorrected),
            errors::position(track, |point| point.estimate),
        ),
        levels: Vec::new(),
        events: Some(corrections(recording)),
    };
    let heading = Plot {
        title: "Heading: belief less truth",
        unit: "degrees",
        height: 140.0,
        from_zero: true,
        series: pair(
            errors::heading(track, |point| point.uncorrected),
            errors::heading(track, |point| point.estimate),
        ),
        levels: Vec::new(),
        events: Some(corrections(recording)),
    };
    let cross_track = Plot {
        title: "Distance of the way back from the way out",
        unit: "m",
        height: 120.0,
        from_zero: true,
        series: vec![series(
            "",
            "line curve s-ink",
            errors::cross_track(recording),
        )],
        levels: rms_level(summary),
        events: None,
    };
    html! {
        section {
            h2 { "Error over time" }
            p.note { "The strip below each plot tells the phase: red and thin outbound, yellow by odometry, blue and thick by camera." }
            @for plot in [position, heading, cross_track] { figure { (plot.render(time)) } }
        }
    }
}

fn corrections(recording: &Recording) -> Events {
    Events {
        label: "realigned at a snapshot".into(),
        times: recording.corrections.iter().map(|mark| mark.t).collect(),
    }
}

fn rms_level(summary: &Summary) -> Vec<Level> {
    let value = summary.cross_track_rms_m;
    let label = format!("RMS {} m", number::fixed(value, 2));
    value
        .is_finite()
        .then_some(Level { label, value })
        .into_iter()
        .collect()
}

fn exposure_plots(recording: &Recording, time: &TimeAxis) -> Markup {
    let frames = &recording.frames;
    let over_time = |title, unit, value: fn(&FrameMark) -> f64, levels| Plot {
        title,
        unit,
        height: 110.0,
        from_zero: true,
        series: vec![series("", "line curve s-ink", frame_curve(frames, value))],
        levels,
        events: None,
    };
    let set_point = vec![Level {
        label: "set-point 80".into(),
        value: LUMA_SET_POINT,
    }];
    let plots = [
        over_time(
            "Mean luma of the horizon",
            "of 255",
            |frame| f64::from(frame.luma),
            set_point,
        ),
        over_time(
            "Shutter",
            "lines",
            |frame| f64::from(frame.lines),
            Vec::new(),
        ),
        over_time(
            "Gain",
            "1 = 0 dB",
            |frame| f64::from(frame.gain),
            Vec::new(),
        ),
    ];
    html! {
        section {
            h2 { "Exposure" }
            p.note { "The firmware sets shutter and gain so that the horizon keeps its brightness." }
            @for plot in plots { figure { (plot.render(time)) } }
        }
    }
}

fn processor_plots(recording: &Recording, summary: &Summary, time: &TimeAxis) -> Markup {
    let frames = &recording.frames;
    let cycles: Vec<u32> = frames.iter().filter_map(|frame| frame.cycles).collect();
    let plot = Plot {
        title: "Cycles per frame",
        unit: "thousand cycles",
        height: 150.0,
        from_zero: false,
        series: vec![series(
            "",
            "line curve s-ink",
            frame_curve(frames, |frame| {
                frame
                    .cycles
                    .map_or(f64::NAN, |cycles| f64::from(cycles) / 1000.0)
            }),
        )],
        levels: Vec::new(),
        events: None,
    };
    html! {
        section {
            h2 { "Processor" }
            p.note { "From a frame in memory to its spectrum, counted by the firmware itself." }
            figure { (plot.render(time)) }
            figure { (histogram::render(&cycles, summary.cycles_per_frame)) }
        }
    }
}

fn route_memory(recording: &Recording, summary: &Summary) -> Markup {
    html! {
        section.long {
            h2 { "Route memory, byte by byte" }
            p.note {
                "Each snapshot is a row: the coefficients as bars, as bytes, and as signed numbers. The remembered horizon is drawn from them alone "
                "(one count of frequency k is 0.60 · 0.826" sup { "k−1" } " luma; its mean is not stored), facing north. "
                "The count is the height of the odometry stack, low byte first. “Off by” is the distance between where the drone believed it was and where it was."
            }
            (memory::memory(recording, summary.outbound_m))
        }
    }
}

fn series(label: &str, class: &'static str, points: Vec<Point>) -> Series {
    Series {
        label: label.into(),
        class,
        points,
    }
}

fn frame_curve(frames: &[FrameMark], value: impl Fn(&FrameMark) -> f64) -> Vec<Point> {
    frames.iter().map(|frame| [frame.t, value(frame)]).collect()
}

/// From the first to the last thing recorded.
fn time_axis(recording: &Recording) -> TimeAxis {
    let track = recording.track.iter().map(|point| point.t);
    let frames = recording.frames.iter().map(|frame| frame.t);
    TimeAxis {
        range: Range::of(track.chain(frames)).unwrap_or(Range {
            low: 0.0,
            high: 1.0,
        }),
        phases: phase::spans(&recording.track),
    }
}
