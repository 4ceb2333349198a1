//! Chrome's trace-event format, as far as a time line needs it; Perfetto (ui.perfetto.dev) and
//! `chrome://tracing` open it.

use std::collections::BTreeMap;

use serde::Serialize;

use super::timeline::{Slice, Timeline, Track};

/// The one process: the board. No track has this number: a viewer would take it for the main thread.
const BOARD: usize = 1;

/// Complete events and instants in the order of their beginnings, the outer before the inner, after
/// the tracks' names and places.
pub fn to_json(timeline: &Timeline) -> serde_json::Result<String> {
    let tracks = timeline.tracks();
    let numbers: BTreeMap<Track, usize> = tracks.keys().copied().zip(BOARD + 1..).collect();
    let name = "STM32F407, emulated";
    let board = TraceEvent::metadata("process_name", BOARD, Arguments::Name { name });
    let mut events = vec![board];
    for (track, name) in tracks {
        let tid = numbers[track];
        events.push(TraceEvent::metadata(
            "thread_name",
            tid,
            Arguments::Name { name },
        ));
        let place = Arguments::Index { sort_index: tid };
        events.push(TraceEvent::metadata("thread_sort_index", tid, place));
    }
    let mut slices: Vec<&Slice> = timeline.slices().iter().collect();
    slices.sort_by(|a, b| {
        let starts = a.from_us.total_cmp(&b.from_us);
        starts.then(b.for_us.total_cmp(&a.for_us))
    });
    let slices = slices.into_iter();
    events.extend(slices.map(|slice| TraceEvent::of(slice, numbers[&slice.track])));
    serde_json::to_string(&Document {
        trace_events: events,
        display_time_unit: "ns",
    })
}

#[derive(Serialize)]
struct Document<'t> {
    #[serde(rename = "traceEvents")]
    trace_events: Vec<TraceEvent<'t>>,
    #[serde(rename = "displayTimeUnit")]
    display_time_unit: &'static str,
}

#[derive(Default, Serialize)]
struct TraceEvent<'t> {
    ph: &'static str,
    name: &'t str,
    pid: usize,
    tid: usize,
    ts: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    dur: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    s: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    args: Option<Arguments<'t>>,
}

impl<'t> TraceEvent<'t> {
    fn on(tid: usize) -> Self {
        Self {
            pid: BOARD,
            tid,
            ..Self::default()
        }
    }

    fn metadata(name: &'static str, tid: usize, args: Arguments<'t>) -> Self {
        Self {
            ph: "M",
            name,
            args: Some(args),
            ..Self::on(tid)
        }
    }

    fn of(slice: &'t Slice, tid: usize) -> Self {
        let instant = slice.for_us == 0.0;
        Self {
            ph: if instant { "i" } else { "X" },
            name: &slice.name,
            ts: slice.from_us,
            dur: (!instant).then_some(slice.for_us),
            s: instant.then_some("t"),
            ..Self::on(tid)
        }
    }
}

#[derive(Serialize)]
#[serde(untagged)]
enum Arguments<'t> {
    Name { name: &'t str },
    Index { sort_index: usize },
}
