//! What the emulated camera looks from: true poses where somebody sends them, else the autopilot's
//! own belief.

use fake_sensors::camera;
use link::WorldPose;

use super::line::{PoseError, PoseLine, PoseLines};
use crate::live::endpoint::PoseSource;
use crate::live::port::{News, OpenError, Port};

/// Height of the flights that STATE messages tell of, m: they do not say it (flight app).
const FLIGHT_HEIGHT_M: f64 = 0.5;
/// After this long without a STATE the drone stands on the ground: the app sends one every 100 ms in
/// the air, and none on the ground, while it takes off and while it lands.
const SILENCE_MS: u64 = 1_000;
/// How long after the last true pose a STATE is not yet believed instead: a peer that ends closes
/// one wire before the other.
const LAST_WORDS_MS: u64 = 500;

/// What happened at the source.
#[derive(Debug)]
pub enum Seen {
    /// At its port.
    News(News),
    /// A line that is no pose.
    Bad(PoseError),
    /// It is another one now, for people.
    Switched(String),
}

/// Who says where the camera is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Speaker {
    /// Nobody yet: the drone stands at the start of the route.
    Nobody,
    Stream,
    State,
}

/// The camera's place in the world.
#[derive(Debug)]
pub struct Eyes {
    source: PoseSource,
    port: Option<Port>,
    received: Vec<u8>,
    lines: PoseLines,
    speaker: Speaker,
    pose: PoseLine,
    /// When the last true pose came.
    streamed_ms: Option<u64>,
    /// When the last STATE came.
    state_ms: Option<u64>,
    poses: u64,
    bad: u64,
}

impl Eyes {
    /// On the ground at the start of the route, facing north, until the source says otherwise.
    ///
    /// # Errors
    /// [`OpenError`] where its port cannot be opened.
    pub fn open(source: PoseSource) -> Result<Self, OpenError> {
        Ok(Self {
            source,
            port: source.port().map(Port::open_tcp).transpose()?,
            received: Vec::new(),
            lines: PoseLines::default(),
            speaker: Speaker::Nobody,
            pose: PoseLine {
                t: 0.0,
                x: 0.0,
                y: 0.0,
                z: 0.0,
                roll: 0.0,
                pitch: 0.0,
                yaw: 0.0,
            },
            streamed_ms: None,
            state_ms: None,
            poses: 0,
            bad: 0,
        })
    }

    /// Takes what has come to the port.
    pub fn poll(&mut self, now_ms: u64) -> Vec<Seen> {
        let Some(port) = &mut self.port else {
            return Vec::new();
        };
        self.received.clear();
        let mut seen = Vec::new();
        for news in port.poll(&mut self.received) {
            if matches!(news, News::Came(_)) {
                self.lines.clear();
            }
            seen.push(Seen::News(news));
        }
        for line in self.lines.push(&self.received) {
            match line {
                Ok(pose) => {
                    self.poses += 1;
                    self.streamed_ms = Some(now_ms);
                    self.pose = pose;
                    seen.extend(self.switch(Speaker::Stream));
                }
                Err(error) => {
                    self.bad += 1;
                    seen.push(Seen::Bad(error));
                }
            }
        }
        seen
    }

    /// The autopilot believes to be at `pose`.
    pub fn state(&mut self, now_ms: u64, pose: WorldPose) -> Option<Seen> {
        self.state_ms = Some(now_ms);
        if !self.believes_states(now_ms) {
            return None;
        }
        self.pose = PoseLine {
            t: now_ms as f64 / 1_000.0,
            x: pose.x.into(),
            y: pose.y.into(),
            z: FLIGHT_HEIGHT_M,
            roll: 0.0,
            pitch: 0.0,
            yaw: pose.yaw.into(),
        };
        self.switch(Speaker::State)
    }

    fn believes_states(&self, now_ms: u64) -> bool {
        let peer = self.port.as_ref().is_some_and(Port::has_peer);
        match self.source {
            PoseSource::State => true,
            PoseSource::Tcp(_) => false,
            PoseSource::TcpElseState(_) => self
                .streamed_ms
                .is_none_or(|streamed_ms| !peer && now_ms >= streamed_ms + LAST_WORDS_MS),
        }
    }

    fn switch(&mut self, speaker: Speaker) -> Option<Seen> {
        if std::mem::replace(&mut self.speaker, speaker) == speaker {
            return None;
        }
        let text = match (speaker, self.source.port()) {
            (Speaker::Stream, Some(port)) => format!("true poses from {port}"),
            _ => "the autopilot's STATE messages".to_owned(),
        };
        Some(Seen::Switched(text))
    }

    /// Whether the drone is in the air, as its STATEs tell.
    pub fn airborne(&self, now_ms: u64) -> bool {
        self.state_ms
            .is_some_and(|state_ms| now_ms < state_ms + SILENCE_MS)
    }

    /// Where the drone is: the newest pose, held until the next.
    pub fn pose(&self, now_ms: u64) -> PoseLine {
        let mut pose = self.pose;
        if self.speaker == Speaker::State && !self.airborne(now_ms) {
            pose.z = 0.0;
        }
        pose
    }

    /// Where its camera is.
    pub fn camera(&self, now_ms: u64) -> camera::Pose {
        self.pose(now_ms).camera()
    }

    /// Whether what is known now is only what the drone believes.
    pub fn is_belief(&self) -> bool {
        self.speaker == Speaker::State
    }

    /// For people: where poses are to come from.
    pub fn place(&self) -> String {
        match &self.port {
            Some(port) => format!("{} ({})", self.source, port.place()),
            None => self.source.to_string(),
        }
    }

    /// How often somebody came to the port; how many poses, and how many lines that were none, came.
    pub fn counts(&self) -> (u32, u64, u64) {
        let peers = self.port.as_ref().map_or(0, Port::peers);
        (peers, self.poses, self.bad)
    }
}
