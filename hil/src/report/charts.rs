//! The sections of the page that plot something over time.

use maud::{Markup, html};

use super::plot::{Events, Level, Plot, Series, TimeAxis};
use super::svg::Point;
use super::ticks::Range;
use super::{errors, histogram, number, phase};
use crate::record::{FrameMark, Recording, Reference};
use crate::summary::Summary;

/// From the first to the last thing recorded.
pub fn time_axis(recording: &Recording) -> TimeAxis {
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

/// How far belief and flight were off; without the truth, how far the way back was from the way out.
pub fn errors(recording: &Recording, summary: &Summary, time: &TimeAxis) -> Markup {
    let (heading, plots) = match recording.reference {
        Reference::Truth => {
            let [position, heading] = belief_plots(recording);
            let plots = vec![position, heading, cross_track(recording, summary, None)];
            ("Error over time", plots)
        }
        Reference::Estimate => {
            let plot = cross_track(recording, summary, Some(realignments(recording)));
            (
                "Way back and way out, by the drone's own estimate",
                vec![plot],
            )
        }
    };
    html! {
        section {
            h2 { (heading) }
            p.note { "The strip below each plot tells the phase: red and thin outbound, yellow by odometry, blue and thick by camera." }
            @for plot in plots { figure { (plot.render(time)) } }
        }
    }
}

/// Belief less truth, place and heading.
fn belief_plots(recording: &Recording) -> [Plot; 2] {
    let track = &recording.track;
    let position = belief_plot(
        recording,
        ("Position, estimate less truth", "m", 170.0),
        errors::position(track, |point| point.uncorrected),
        errors::position(track, |point| point.estimate),
    );
    let heading = belief_plot(
        recording,
        ("Heading, estimate less truth", "degrees", 140.0),
        errors::heading(track, |point| point.uncorrected),
        errors::heading(track, |point| point.estimate),
    );
    [position, heading]
}

fn cross_track(recording: &Recording, summary: &Summary, events: Option<Events>) -> Plot {
    Plot {
        levels: rms_level(summary),
        events,
        ..single_curve(
            "Distance of the way back from the way out",
            "m",
            errors::cross_track(recording),
        )
    }
}

/// When the camera told the filter where it really was.
fn realignments(recording: &Recording) -> Events {
    Events {
        label: "realigned at a snapshot",
        times: recording.corrections.iter().map(|mark| mark.t).collect(),
    }
}

/// The estimate with and without the camera's corrections.
fn belief_plot(
    recording: &Recording,
    (title, unit, height): (&'static str, &'static str, f64),
    uncorrected: Vec<Point>,
    estimate: Vec<Point>,
) -> Plot {
    Plot {
        title,
        unit,
        height,
        with_zero: true,
        series: vec![
            Series {
                label: "odometry, uncorrected",
                class: "line uncorrected s-uncorrected",
                points: uncorrected,
            },
            Series {
                label: "the filter's estimate",
                class: "line curve s-ink",
                points: estimate,
            },
        ],
        levels: Vec::new(),
        events: Some(realignments(recording)),
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

/// Brightness and what the firmware did about it.
pub fn exposure(recording: &Recording, time: &TimeAxis) -> Markup {
    let frames = &recording.frames;
    let set_point = f64::from(pilot::Parameters::DEFAULT.exposure.set_point);
    let luma = Plot {
        levels: vec![Level {
            label: format!("set-point {}", number::trimmed(set_point, 1)),
            value: set_point,
        }],
        ..single_curve(
            "Mean luma of the horizon",
            "of 255",
            curve(frames, |frame| f64::from(frame.luma)),
        )
    };
    let lines = single_curve(
        "Shutter",
        "lines",
        curve(frames, |frame| f64::from(frame.lines)),
    );
    let gain = single_curve(
        "Analogue gain",
        "factor",
        curve(frames, |frame| f64::from(frame.gain)),
    );
    html! {
        section {
            h2 { "Exposure" }
            p.note { "The firmware sets shutter and gain so that the horizon keeps its brightness." }
            @for plot in [luma, lines, gain] { figure { (plot.render(time)) } }
        }
    }
}

/// What a frame costs.
pub fn processor(recording: &Recording, summary: &Summary, time: &TimeAxis) -> Markup {
    let frames = &recording.frames;
    let cycles: Vec<u32> = frames.iter().filter_map(|frame| frame.cycles).collect();
    let thousands = |frame: &FrameMark| {
        frame
            .cycles
            .map_or(f64::NAN, |cycles| f64::from(cycles) / 1000.0)
    };
    let plot = Plot {
        with_zero: false,
        ..single_curve(
            "Cycles per frame",
            "thousand cycles",
            curve(frames, thousands),
        )
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

/// A low plot of a single curve.
fn single_curve(title: &'static str, unit: &'static str, points: Vec<Point>) -> Plot {
    Plot {
        title,
        unit,
        height: 115.0,
        with_zero: true,
        series: vec![Series {
            label: "",
            class: "line curve s-ink",
            points,
        }],
        levels: Vec::new(),
        events: None,
    }
}

fn curve(frames: &[FrameMark], value: impl Fn(&FrameMark) -> f64) -> Vec<Point> {
    frames.iter().map(|frame| [frame.t, value(frame)]).collect()
}
