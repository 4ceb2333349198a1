//! A pose as a line of JSON.

use fake_sensors::camera;
use nalgebra::{UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use crate::flight::aircraft::camera_pose;
use crate::record::PlanarPose;

/// Bytes of a line, at most; seven numbers take some 200.
const LINE_BYTES: usize = 4096;
/// Metres or radians beyond which a value is a mistake, as on the link.
const LARGEST: f64 = 1_000.0;

/// Where a drone is, at one instant. SI units.
///
/// World: x north (forward at yaw 0), y west (left), z up, the origin on the ground where the route
/// starts. The position is that of the drone's feet: z is 0 on the ground, and the camera looks out
/// 4 cm above. The attitude turns first by yaw about z, then by pitch about the new y, then by roll
/// about the new x (ZYX); all three right-handed, so a positive pitch is nose down.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PoseLine {
    /// The sender's clock, s.
    pub t: f64,
    /// North, m.
    pub x: f64,
    /// West, m.
    pub y: f64,
    /// Above the ground, m.
    pub z: f64,
    /// About the drone's forward axis, rad.
    pub roll: f64,
    /// About its left axis, rad.
    pub pitch: f64,
    /// Counter-clockwise from north, rad.
    pub yaw: f64,
}

/// Why a line is no pose.
#[derive(Debug, thiserror::Error)]
pub enum PoseError {
    /// Not the JSON that is expected; the message says what and where.
    #[error("{0}")]
    Json(#[from] serde_json::Error),
    /// A number beyond all flights.
    #[error("`{field}` is {value}: beyond ±{LARGEST}")]
    TooLarge {
        /// Of which field.
        field: &'static str,
        /// As read.
        value: f64,
    },
    /// No end of a line within the limit.
    #[error("longer than {LINE_BYTES} bytes")]
    TooLong,
}

impl PoseLine {
    /// A pose from position, m, and attitude, at `t`, s.
    pub fn new(t: f64, position_m: &Vector3<f64>, attitude: &UnitQuaternion<f64>) -> Self {
        let (roll, pitch, yaw) = attitude.euler_angles();
        Self {
            t,
            x: position_m.x,
            y: position_m.y,
            z: position_m.z,
            roll,
            pitch,
            yaw,
        }
    }

    /// Reads a line.
    ///
    /// # Errors
    /// [`PoseError`]: not a JSON object with these seven numbers, or absurd ones.
    pub fn parse(line: &[u8]) -> Result<Self, PoseError> {
        let pose: Self = serde_json::from_slice(line)?;
        for (field, value) in [
            ("x", pose.x),
            ("y", pose.y),
            ("z", pose.z),
            ("roll", pose.roll),
            ("pitch", pose.pitch),
            ("yaw", pose.yaw),
        ] {
            if value.abs() > LARGEST {
                return Err(PoseError::TooLarge { field, value });
            }
        }
        Ok(pose)
    }

    /// The line, with its end.
    ///
    /// # Errors
    /// None in practice: all fields are numbers.
    pub fn encode(&self) -> serde_json::Result<Vec<u8>> {
        let mut line = serde_json::to_vec(self)?;
        line.push(b'\n');
        Ok(line)
    }

    /// Where the camera of such a drone is.
    pub fn camera(&self) -> camera::Pose {
        let attitude = UnitQuaternion::from_euler_angles(self.roll, self.pitch, self.yaw);
        camera_pose(&Vector3::new(self.x, self.y, self.z), &attitude)
    }

    /// Its shadow on the ground.
    pub fn planar(&self) -> PlanarPose {
        PlanarPose {
            x: self.x,
            y: self.y,
            yaw: self.yaw,
        }
    }
}

/// Received bytes, cut into lines.
#[derive(Debug, Default)]
pub struct PoseLines {
    held: Vec<u8>,
    /// Within a line that is too long already.
    skipping: bool,
}

impl PoseLines {
    /// Takes bytes; what the lines say that they complete. Empty lines say nothing.
    pub fn push(&mut self, bytes: &[u8]) -> Vec<Result<PoseLine, PoseError>> {
        let mut said = Vec::new();
        for piece in bytes.split_inclusive(|byte| *byte == b'\n') {
            let (text, ended) = match piece.split_last() {
                Some((b'\n', text)) => (text, true),
                _ => (piece, false),
            };
            if self.held.len() + text.len() > LINE_BYTES {
                if !std::mem::replace(&mut self.skipping, true) {
                    said.push(Err(PoseError::TooLong));
                }
                self.held.clear();
            } else if !self.skipping {
                self.held.extend_from_slice(text);
            }
            if ended {
                let line = std::mem::take(&mut self.held);
                if !std::mem::take(&mut self.skipping) && !line.trim_ascii().is_empty() {
                    said.push(PoseLine::parse(&line));
                }
            }
        }
        said
    }

    /// Forgets a line that will not be finished.
    pub fn clear(&mut self) {
        *self = Self::default();
    }
}
