//! The camera of a board that has none: the same sensor, lens and world as on every other board, but
//! its frames go over a serial line, each as soon as the one before it is through.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use fake_sensors::camera::Pose;
use fake_sensors::camera::tcm8230::Edge;
use frames::{Damage, Pieces, Replies, Reply, Shape, Verdict};
use serde::Serialize;

use crate::board::CAMERA_LEAD_NS;
use crate::board::camera::Camera;
use crate::live::{News, Port};

use super::transcript::UsedFrame;

/// Without a word about a frame for so long after its last byte, the next one is sent. A board needs
/// some 40 ms; adapters and their drivers some 20 more.
const FORGET: Duration = Duration::from_millis(300);
/// Frames that may wait for their verdict before another one is sent. With one, every second frame of
/// the camera is sent, more than the 10 a second that the paper's firmware looks at; with two all are,
/// and the line at 3 Mbaud is never idle, which an emulated board keeps up with on a fast machine only.
const MOST_AWAITING: usize = 1;
/// Without a frame that was used for so long, the flight cannot go on.
const BLIND: Duration = Duration::from_secs(3);

/// What became of the frames of a flight.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct FrameFigures {
    /// The camera has taken them.
    pub rendered: u64,
    /// Put on the line, but for those whose fate is not known yet.
    pub sent: u64,
    /// The firmware has looked at them.
    pub used: u64,
    /// Whole, but overtaken by a newer one before the firmware could look.
    pub missed: u64,
    /// Parts of them were lost.
    pub torn: u64,
    /// Too old when they were whole.
    pub late: u64,
    /// Had come before.
    pub repeated: u64,
    /// There was no buffer.
    pub busy: u64,
    /// Nothing was heard of them.
    pub unanswered: u64,
    /// Answers that were none.
    pub damaged_answers: u64,
}

/// The line with the frames does not work.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Blind {
    /// The device is gone.
    #[error("the frames' device went away: {0}")]
    Gone(String),
    /// Nothing that was sent was of use.
    #[error(
        "no frame was used for {} s: of {} sent {} were torn, {} late, {} repeated, {} found no buffer, {} had no answer; \
         {} answers were damaged",
        BLIND.as_secs(), .0.sent, .0.torn, .0.late, .0.repeated, .0.busy, .0.unanswered, .0.damaged_answers
    )]
    Unused(FrameFigures),
}

/// The camera, and the line that its frames take.
pub struct Eye {
    camera: Camera,
    shape: Shape,
    port: Port,
    replies: Replies,
    sending: Option<Sending>,
    /// Through, and without a verdict yet; oldest first.
    awaiting: VecDeque<Awaiting>,
    /// Not waited for any more; a verdict may yet come.
    forgotten: Vec<UsedFrame>,
    /// Of the last frame.
    number: u32,
    /// When the last one was used, or the flight began.
    used_at: Option<Instant>,
    figures: FrameFigures,
    used: Vec<UsedFrame>,
}

/// The frame that is being sent.
struct Sending {
    frame: UsedFrame,
    sent: usize,
}

/// A frame whose last byte was taken.
struct Awaiting {
    frame: UsedFrame,
    since: Instant,
}

impl Eye {
    /// A camera at a port whose board has begun a session; `camera` must be streaming since its time
    /// zero.
    pub fn new(camera: Camera, shape: Shape, port: Port) -> Self {
        Self {
            camera,
            shape,
            port,
            replies: Replies::new(),
            sending: None,
            awaiting: VecDeque::new(),
            forgotten: Vec::new(),
            number: 0,
            used_at: None,
            figures: FrameFigures::default(),
            used: Vec::new(),
        }
    }

    /// What became of the frames so far.
    pub fn figures(&self) -> FrameFigures {
        let on_the_way = self.awaiting.len() + usize::from(self.sending.is_some());
        FrameFigures {
            sent: self.figures.sent - on_the_way as u64,
            ..self.figures
        }
    }

    /// The frames that the board has looked at, as they were sent, and their shape.
    pub fn into_used(mut self) -> (Vec<UsedFrame>, Shape) {
        // A verdict that was late stands behind those of later frames.
        self.used.sort_by_key(|frame| frame.number);
        (self.used, self.shape)
    }

    /// One millisecond, in which the camera is there.
    ///
    /// # Errors
    /// [`Blind`].
    pub fn step(&mut self, now_ms: u64, pose: Pose) -> Result<(), Blind> {
        let now_ns = now_ms * 1_000_000 + CAMERA_LEAD_NS;
        self.camera.look_from(now_ns, pose);
        self.listen(now_ns)?;
        self.look(now_ns + 1_000_000);
        self.push();
        if self.used_at.get_or_insert_with(Instant::now).elapsed() >= BLIND {
            return Err(Blind::Unused(self.figures()));
        }
        Ok(())
    }

    /// The camera's edges up to the end of this millisecond.
    fn look(&mut self, until_ns: u64) {
        while let Some(due_ns) = self.camera.chip().next_edge().filter(|ns| *ns < until_ns) {
            if self.camera.take_edge(due_ns) == Some(Edge::FrameEnd) {
                self.figures.rendered += 1;
                self.send();
            }
        }
    }

    /// Sends the frame that is ready, if the line is free. Frames that find it busy are frames that
    /// this camera has not taken.
    fn send(&mut self) {
        if self.sending.is_some() || self.awaiting.len() >= MOST_AWAITING {
            return;
        }
        self.number = self.number.wrapping_add(1);
        self.figures.sent += 1;
        let pieces = Pieces::of(self.number, self.camera.frame(), &self.shape);
        self.sending = Some(Sending {
            frame: UsedFrame {
                number: self.number,
                wire: pieces.flatten().collect(),
            },
            sent: 0,
        });
    }

    fn push(&mut self) {
        if let Some(sending) = &mut self.sending
            // A line that is gone is noticed when it is listened to.
            && let Ok(sent) = self.port.send_some(&sending.frame.wire[sending.sent..])
        {
            sending.sent += sent;
        }
        let through = |sending: &mut Sending| sending.sent == sending.frame.wire.len();
        if let Some(Sending { frame, .. }) = self.sending.take_if(through) {
            let since = Instant::now();
            self.awaiting.push_back(Awaiting { frame, since });
        }
        let forgotten = |awaiting: &Awaiting| awaiting.since.elapsed() >= FORGET;
        while self.awaiting.front().is_some_and(forgotten) {
            let oldest = self.awaiting.pop_front();
            self.forgotten.extend(oldest.map(|oldest| oldest.frame));
            self.figures.unanswered += 1;
        }
    }

    /// The frame `number`, if it is on its way.
    fn take(&mut self, number: u32) -> Option<UsedFrame> {
        let is_it = |sending: &mut Sending| sending.frame.number == number;
        if let Some(sending) = self.sending.take_if(is_it) {
            return Some(sending.frame);
        }
        let mut awaiting = self.awaiting.iter();
        if let Some(place) = awaiting.position(|awaiting| awaiting.frame.number == number) {
            return Some(self.awaiting.remove(place)?.frame);
        }
        let mut forgotten = self.forgotten.iter();
        let place = forgotten.position(|frame| frame.number == number)?;
        self.figures.unanswered -= 1;
        Some(self.forgotten.swap_remove(place))
    }

    fn listen(&mut self, now_ns: u64) -> Result<(), Blind> {
        let mut received = Vec::new();
        for news in self.port.poll(&mut received) {
            if let News::Gone { peer, .. } = news {
                return Err(Blind::Gone(peer));
            }
        }
        let mut unread = &received[..];
        while let Some(reply) = self.replies.next_reply(&mut unread) {
            self.hear(now_ns, reply);
        }
        Ok(())
    }

    fn hear(&mut self, now_ns: u64, reply: Result<Reply, Damage>) {
        let Ok(reply) = reply else {
            self.figures.damaged_answers += 1;
            return;
        };
        if let Reply::Verdict {
            number,
            verdict,
            shutter_lines,
            gain,
        } = reply
        {
            self.camera
                .chip()
                .write_exposure(now_ns, shutter_lines, gain);
            self.count(verdict);
            if let Some(frame) = self.take(number)
                && verdict == Verdict::Used
            {
                self.used_at = Some(Instant::now());
                self.used.push(frame);
            }
        }
    }

    fn count(&mut self, verdict: Verdict) {
        let figures = &mut self.figures;
        *match verdict {
            Verdict::Used => &mut figures.used,
            Verdict::Missed => &mut figures.missed,
            Verdict::Torn => &mut figures.torn,
            Verdict::Late => &mut figures.late,
            Verdict::Repeated => &mut figures.repeated,
            Verdict::Busy => &mut figures.busy,
        } += 1;
    }
}
