//! Plays what the logs tell to the recorder, in the order of time.

use autopilot::app::Phase;
use link::{InsCorrection, Map, Message, Vector};

use super::estimate::Track;
use super::messages::{MeasuringPoint, Messages};
use super::missing::Note;
use super::phases::Phases;
use super::snapshots::{Remark, Snapshots};
use crate::record::{PlanarPose, Recording, Reference};
use crate::recorder::{Glimpse, Recorder};

/// Not known: leaves a gap in figures, null in JSON.
const UNKNOWN: PlanarPose = PlanarPose {
    x: f64::NAN,
    y: f64::NAN,
    yaw: f64::NAN,
};

/// Something at an instant.
#[derive(Clone, Copy, Debug)]
enum Event<'m> {
    Vector(&'m Vector),
    Map(&'m Map),
    Correction(&'m InsCorrection),
    Point(&'m MeasuringPoint),
    Step(&'m u8),
    /// A tenth of a second.
    Track,
}

/// The recording of the flight; `notes` are the first lines of its log.
pub fn recording(
    track: Option<&Track>,
    messages: &Messages,
    phases: &Phases,
    notes: Vec<Note>,
) -> Recording {
    let mut player = Player {
        track,
        recorder: Recorder::new(Recording {
            reference: Reference::Estimate,
            ..Recording::default()
        }),
        phase: Phase::Ground,
        snapshots: Snapshots::default(),
        map: None,
    };
    for note in notes {
        player.recorder.note(0, note.level, note.text);
    }
    for (ms, event) in in_order(track, messages) {
        player.enter(ms, phases.at(ms));
        player.play(ms, event);
    }
    player.finish()
}

/// All events by time; at the same time messages come before the track.
fn in_order<'m>(track: Option<&Track>, messages: &'m Messages) -> Vec<(u64, Event<'m>)> {
    let mut events = Vec::new();
    events.extend(of(&messages.maps, Event::Map));
    events.extend(of(&messages.vectors, Event::Vector));
    events.extend(of(&messages.corrections, Event::Correction));
    events.extend(of(&messages.points, Event::Point));
    events.extend(of(&messages.steps, Event::Step));
    let instants = track.map(Track::instants).unwrap_or_default();
    events.extend(instants.into_iter().map(|ms| (ms, Event::Track)));
    events.sort_by_key(|(ms, _)| *ms);
    events
}

fn of<'m, T>(
    messages: &'m [(u64, T)],
    event: fn(&'m T) -> Event<'m>,
) -> impl Iterator<Item = (u64, Event<'m>)> {
    messages
        .iter()
        .map(move |(ms, message)| (*ms, event(message)))
}

struct Player<'t> {
    track: Option<&'t Track<'t>>,
    recorder: Recorder,
    phase: Phase,
    snapshots: Snapshots,
    /// The newest map entry.
    map: Option<Map>,
}

impl Player<'_> {
    fn enter(&mut self, ms: u64, phase: Phase) {
        if phase == self.phase {
            return;
        }
        self.phase = phase;
        self.recorder.phase(ms, phase);
        // Where the way back begins, the stack is what the newest entry says.
        if let (Phase::Following, Some(map)) = (phase, self.map.clone()) {
            self.message(ms, &Message::Map(map));
        }
    }

    fn play(&mut self, ms: u64, event: Event) {
        match event {
            Event::Vector(vector) => self.message(ms, &Message::Vector(vector.clone())),
            Event::Correction(correction) => {
                self.message(ms, &Message::InsCorrection(correction.clone()));
            }
            Event::Map(map) => self.map(ms, map),
            Event::Point(point) => self.recorder.note(
                ms,
                "info",
                format!(
                    "the script noted point {} of run {} at x {:.2} m, y {:.2} m",
                    point.point, point.run, point.north, -point.east
                ),
            ),
            Event::Step(step) => {
                self.recorder
                    .note(ms, "info", format!("step {step} of the script"))
            }
            Event::Track => {
                let glimpse = self.glimpse(ms);
                self.recorder.track(ms, &glimpse);
            }
        }
    }

    fn map(&mut self, ms: u64, map: &Map) {
        if self.phase == Phase::Recording {
            let estimate = self.glimpse(ms).estimate;
            if let Some(remark) = self.snapshots.map(ms as f64 / 1_000.0, map, estimate) {
                self.recorder.note(ms, "warn", in_words(remark));
            }
        }
        self.message(ms, &Message::Map(map.clone()));
        self.map = Some(map.clone());
    }

    fn message(&mut self, ms: u64, message: &Message) {
        let glimpse = self.glimpse(ms);
        self.recorder.message(ms, message, &glimpse);
    }

    fn glimpse(&self, ms: u64) -> Glimpse {
        let estimate = self
            .track
            .and_then(|track| track.pose(ms))
            .unwrap_or(UNKNOWN);
        let height = self.track.and_then(|track| track.height(ms));
        Glimpse {
            truth: estimate,
            estimate,
            uncorrected: UNKNOWN,
            height_m: height.unwrap_or(f64::NAN),
        }
    }

    fn finish(self) -> Recording {
        Recording {
            snapshots: self.snapshots.into_marks(),
            ..self.recorder.finish()
        }
    }
}

fn in_words(remark: Remark) -> String {
    match remark {
        Remark::Missed(1) => "a snapshot was taken between two rows and is not known".into(),
        Remark::Missed(count) => {
            format!("{count} snapshots were taken between two rows and are not known")
        }
        Remark::Restarted => {
            "the numbers of the snapshots begin anew: another route. Cut the files here to see each by itself".into()
        }
    }
}
