//! The three files of a recording, as typed rows.

use std::path::Path;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::table::{ReplayError, Row, RowFault, Source};
use crate::ekf::{
    AbsoluteHeight, Flow, ImuSample, LegacyEuler, Measurement, Pose, Position, Range, YawError,
};

/// A recorded sequence.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// One sample per millisecond, from tick 0.
    pub imu: Vec<ImuSample>,
    /// Everything else that reached the filter, in order of time and arrival.
    pub events: Vec<Event>,
    /// The recorded filter's state, in order of time.
    pub references: Vec<Reference>,
}

/// Something that reached the filter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// The tick it belongs to, ms.
    pub tick_ms: u64,
    /// What it was.
    pub action: Action,
}

/// What an event does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Action {
    /// A measurement enters the queue.
    Measure(Measurement),
    /// The drone takes off (true) or is set down (false).
    Flying(bool),
    /// The filter is reset.
    Reset,
}

/// The recorded filter after a tick.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// The tick, ms.
    pub tick_ms: u64,
    /// Position in the world, m.
    pub position_m: Vector3<f32>,
    /// Velocity in the world, m/s.
    pub velocity_m_s: Vector3<f32>,
    /// Reference attitude, body to world, as recorded: of unit length but for rounding.
    pub attitude: Quaternion<f32>,
    /// Exported angles.
    pub angles: LegacyEuler,
    /// The nine variances.
    pub variances: [f32; 9],
    /// The covariances that were recorded: row, column, value.
    pub covariances: [(usize, usize, f32); 4],
}

impl Recording {
    /// Reads `NAME.imu.csv`, `NAME.events.csv` and `NAME.ekf.csv` in `directory`.
    ///
    /// # Errors
    ///
    /// [`ReplayError::Read`] or [`ReplayError::Row`], naming the file and line.
    pub fn load(directory: &Path, name: &str) -> Result<Self, ReplayError> {
        let open = |part: &str| Source::read(&directory.join(format!("{name}.{part}.csv")));
        Ok(Self {
            imu: open("imu")?.rows(imu_sample)?,
            events: events(&open("events")?)?,
            references: references(&open("ekf")?)?,
        })
    }
}

/// Rates in 0.01 deg/s and forces in 1e-4 g, as integers.
fn imu_sample(row: &Row<'_>) -> Result<ImuSample, RowFault> {
    let gyro = row.numbers(["gx_cdps", "gy_cdps", "gz_cdps"])?;
    let acc = row.numbers(["ax_1e4g", "ay_1e4g", "az_1e4g"])?;
    Ok(ImuSample {
        gyro_deg_s: Vector3::from(gyro) / 100.0,
        acc_g: Vector3::from(acc) / 1e4,
    })
}

pub(in crate::ekf) fn events(source: &Source) -> Result<Vec<Event>, ReplayError> {
    let mut order = Ascending::default();
    source.rows(|row| {
        Ok(Event {
            tick_ms: order.check(row.number("tick_ms")?)?,
            action: action(row)?,
        })
    })
}

fn action(row: &Row<'_>) -> Result<Action, RowFault> {
    let measurement = match row.text("kind")? {
        "flying" => return Ok(Action::Flying(row.number::<f32>("v0")? != 0.0)),
        "reset" => return Ok(Action::Reset),
        "flow" => {
            let [x, y, dt_s, sd_counts] = row.numbers(["v0", "v1", "v2", "v3"])?;
            Measurement::Flow(Flow {
                counts: [x, y],
                dt_s,
                sd_counts,
            })
        }
        "tof" => {
            let [distance_m, sd_m] = row.numbers(["v0", "v1"])?;
            Measurement::Range(Range { distance_m, sd_m })
        }
        "pos" => {
            let [x, y, z, sd_m] = row.numbers(["v0", "v1", "v2", "v3"])?;
            Measurement::Position(Position {
                position_m: Vector3::new(x, y, z),
                sd_m,
            })
        }
        "yawerr" => {
            let [error_rad, sd_rad] = row.numbers(["v0", "v1"])?;
            Measurement::YawError(YawError { error_rad, sd_rad })
        }
        "height" => {
            let [height_m, sd_m] = row.numbers(["v0", "v1"])?;
            Measurement::AbsoluteHeight(AbsoluteHeight { height_m, sd_m })
        }
        "pose" => Measurement::Pose(pose(row)?),
        other => return Err(RowFault::UnknownEvent(other.to_owned())),
    };
    Ok(Action::Measure(measurement))
}

/// The quaternion is stored as `(cos yaw/2, qx, qy, sin yaw/2)`. Its length does not matter to the residual.
fn pose(row: &Row<'_>) -> Result<Pose, RowFault> {
    let [x, y, z, yaw, qx, qy, sd_position_m, sd_attitude_rad] =
        row.numbers(["v0", "v1", "v2", "v3", "v4", "v5", "v6", "v7"])?;
    let (sin, cos) = libm::sincosf(0.5 * yaw);
    Ok(Pose {
        position_m: Vector3::new(x, y, z),
        attitude: UnitQuaternion::new_normalize(Quaternion::new(cos, qx, qy, sin)),
        sd_position_m,
        sd_attitude_rad,
    })
}

fn references(source: &Source) -> Result<Vec<Reference>, ReplayError> {
    let mut order = Ascending::default();
    source.rows(|row| {
        let [w, i, j, k] = row.numbers(["qw", "qx", "qy", "qz"])?;
        let [roll_deg, pitch_deg, yaw_deg] =
            row.numbers(["roll_deg", "pitch_legacy_deg", "yaw_deg"])?;
        let [p08, p18, p37, p25] = row.numbers(["P08", "P18", "P37", "P25"])?;
        Ok(Reference {
            tick_ms: order.check(row.number("tick_ms")?)?,
            position_m: Vector3::from(row.numbers(["x", "y", "z"])?),
            velocity_m_s: Vector3::from(row.numbers(["vx", "vy", "vz"])?),
            attitude: Quaternion::new(w, i, j, k),
            angles: LegacyEuler {
                roll_deg,
                pitch_deg,
                yaw_deg,
            },
            variances: row.numbers([
                "Pxx", "Pyy", "Pzz", "Pvx", "Pvy", "Pvz", "Pd0", "Pd1", "Pd2",
            ])?,
            covariances: [(0, 8, p08), (1, 8, p18), (3, 7, p37), (2, 5, p25)],
        })
    })
}

/// Rows must not run backwards in time: the replay walks them once.
#[derive(Default)]
struct Ascending {
    latest_ms: u64,
}

impl Ascending {
    fn check(&mut self, tick_ms: u64) -> Result<u64, RowFault> {
        if tick_ms < self.latest_ms {
            return Err(RowFault::OutOfOrder(tick_ms));
        }
        self.latest_ms = tick_ms;
        Ok(tick_ms)
    }
}
