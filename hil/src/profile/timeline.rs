//! Tasks, interrupts, DMA, link and frames on one time line.

use std::collections::BTreeMap;

use emulator::core::Cycle;
use emulator::trace::{Event, SerialWire, What};

use super::symbols::{Function, Symbols};
use super::wires::Heard;

/// A piece of a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// From this second of the flight on.
    pub from_s: f64,
    /// For so many seconds.
    pub for_s: f64,
}

/// The tracks, from top to bottom.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Track {
    /// Frames of the camera, and what becomes of them.
    Camera,
    /// The stages of vision and answer.
    Stages,
    /// A task, by its number.
    Task(usize),
    /// An exception, by its number.
    Exception(u8),
    /// Ends of DMA transfers: controller and stream.
    Dma(u8, u8),
    /// Messages from the autopilot.
    Received,
    /// Messages to the autopilot.
    Sent,
    /// When the core sleeps.
    Sleep,
}

/// Something on a track.
#[derive(Clone, Debug, PartialEq)]
pub struct Slice {
    /// Where.
    pub track: Track,
    /// What.
    pub name: String,
    /// From when, microseconds of the flight.
    pub from_us: f64,
    /// How long, microseconds; zero: an instant.
    pub for_us: f64,
}

/// A time line of a window.
#[derive(Clone, Debug)]
pub struct Timeline {
    from: Cycle,
    to: Cycle,
    zero: Cycle,
    core_hz: u32,
    /// What has begun: its track, its name, and when.
    open: Vec<(Track, String, Cycle)>,
    frame: Option<Cycle>,
    lines: usize,
    slices: Vec<Slice>,
    tracks: BTreeMap<Track, String>,
}

impl Timeline {
    /// An empty one; `zero` is the cycle of the flight's time zero.
    pub fn new(window: Window, zero: Cycle, core_hz: u32) -> Self {
        let cycle = |seconds: f64| zero + (seconds.max(0.0) * f64::from(core_hz)) as Cycle;
        Self {
            from: cycle(window.from_s),
            to: cycle(window.from_s + window.for_s),
            zero,
            core_hz,
            open: Vec::new(),
            frame: None,
            lines: 0,
            slices: Vec::new(),
            tracks: BTreeMap::new(),
        }
    }

    /// What is on it, in the order of its ends.
    pub fn slices(&self) -> &[Slice] {
        &self.slices
    }

    /// The tracks that have something on them, with their names, from top to bottom.
    pub fn tracks(&self) -> &BTreeMap<Track, String> {
        &self.tracks
    }

    /// Follows an event; `heard` is the message that is whole with it.
    pub fn draw(&mut self, event: &Event, heard: Option<&Heard>, symbols: &Symbols) {
        if let Some(heard) = heard {
            let track = match heard.wire {
                SerialWire::Receive => Track::Received,
                SerialWire::Transmit => Track::Sent,
            };
            self.add(
                track,
                heard.message.name(),
                heard.began,
                heard.ended,
                symbols,
            );
        }
        match event.what {
            What::Entered(address) => self.enter(address, event.at, symbols),
            What::Returned(address) => {
                if let Some(function) = symbols.at(address) {
                    self.close(track_of(function), event.at, symbols);
                }
            }
            What::ExceptionEntered(number) => {
                let name = symbols.exception(number).to_owned();
                self.open.push((Track::Exception(number), name, event.at));
            }
            What::ExceptionReturned(number) => {
                self.close(Track::Exception(number), event.at, symbols);
            }
            What::Slept { until } => self.add(Track::Sleep, "asleep", event.at, until, symbols),
            What::Reset => self.open.clear(),
            What::DmaDone { controller, stream } => {
                let track = Track::Dma(controller, stream);
                self.add(track, "transfer complete", event.at, event.at, symbols);
            }
            What::Byte { .. } => {}
            What::FrameStart => (self.frame, self.lines) = (Some(event.at), 0),
            What::Line => self.lines += 1,
            What::FrameEnd => {
                if let Some(start) = self.frame.take() {
                    let name = format!("frame of {} lines", self.lines);
                    self.add(Track::Camera, &name, start, event.at, symbols);
                }
            }
        }
    }

    fn enter(&mut self, address: u32, at: Cycle, symbols: &Symbols) {
        let Some(function) = symbols.at(address) else {
            return;
        };
        let name = match function {
            Function::Stage(stage) => stage.name().to_owned(),
            Function::Task(task) => symbols.tasks()[task].clone(),
        };
        self.open.push((track_of(function), name, at));
    }

    /// Ends what began last on a track.
    fn close(&mut self, track: Track, at: Cycle, symbols: &Symbols) {
        if let Some(last) = self.open.iter().rposition(|open| open.0 == track) {
            let (track, name, from) = self.open.remove(last);
            self.add(track, &name, from, at, symbols);
        }
    }

    fn add(&mut self, track: Track, name: &str, from: Cycle, to: Cycle, symbols: &Symbols) {
        if to < self.from || from >= self.to {
            return;
        }
        let microseconds = |cycles: Cycle| cycles as f64 * 1.0e6 / f64::from(self.core_hz);
        self.slices.push(Slice {
            track,
            name: name.to_owned(),
            from_us: microseconds(from.saturating_sub(self.zero)),
            for_us: microseconds(to - from),
        });
        let name = || name_of(track, symbols);
        self.tracks.entry(track).or_insert_with(name);
    }
}

fn track_of(function: Function) -> Track {
    match function {
        Function::Stage(_) => Track::Stages,
        Function::Task(task) => Track::Task(task),
    }
}

fn name_of(track: Track, symbols: &Symbols) -> String {
    match track {
        Track::Camera => "camera".to_owned(),
        Track::Stages => "stages".to_owned(),
        Track::Task(task) => format!("task {}", symbols.tasks()[task]),
        Track::Exception(number) => format!("interrupt {}", symbols.exception(number)),
        Track::Dma(controller, stream) => format!("DMA{controller} stream {stream}"),
        Track::Received => "link, from autopilot".to_owned(),
        Track::Sent => "link, to autopilot".to_owned(),
        Track::Sleep => "core".to_owned(),
    }
}
