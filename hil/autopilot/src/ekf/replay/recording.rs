//! The three files of a recording, as typed rows.

use std::ffi::OsString;
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
    /// Reads `PREFIX.imu.csv`, `PREFIX.events.csv` and `PREFIX.ekf.csv`, where `PREFIX` may hold folders.
    ///
    /// # Errors
    ///
    /// [`ReplayError::Read`] or [`ReplayError::Row`], naming the file and line.
    pub fn load(prefix: &Path) -> Result<Self, ReplayError> {
        let open = |part: &str| {
            let mut path = OsString::from(prefix);
            path.push(format!(".{part}.csv"));
            Source::read(Path::new(&path))
        };
        Self::parse(&open("imu")?, &open("events")?, &open("ekf")?)
    }

    pub(in crate::ekf) fn parse(
        imu: &Source,
        events: &Source,
        ekf: &Source,
    ) -> Result<Self, ReplayError> {
        let imu = imu.some_rows(imu_sample)?;
        let clock = Clock::of(&imu);
        Ok(Self {
            events: read_events(events, clock)?,
            references: read_references(ekf, clock)?,
            imu,
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

fn read_events(source: &Source, mut clock: Clock) -> Result<Vec<Event>, ReplayError> {
    source.rows(|row| {
        Ok(Event {
            tick_ms: clock.tick_ms(row)?,
            action: action(row)?,
        })
    })
}

fn action(row: &Row<'_>) -> Result<Action, RowFault> {
    let measurement = match row.text("kind")? {
        "flying" => return Ok(Action::Flying(row.number("v0")? != 0.0)),
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

fn read_references(source: &Source, mut clock: Clock) -> Result<Vec<Reference>, ReplayError> {
    source.some_rows(|row| {
        let [w, i, j, k] = row.numbers(["qw", "qx", "qy", "qz"])?;
        let [roll_deg, pitch_deg, yaw_deg] =
            row.numbers(["roll_deg", "pitch_legacy_deg", "yaw_deg"])?;
        let [p08, p18, p37, p25] = row.numbers(["P08", "P18", "P37", "P25"])?;
        Ok(Reference {
            tick_ms: clock.tick_ms(row)?,
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

/// Rows must not run backwards in time, for the replay walks them once, nor on behind the IMU's last sample.
#[derive(Clone, Copy)]
struct Clock {
    latest_ms: u64,
    imu_rows: usize,
}

impl Clock {
    fn of(imu: &[ImuSample]) -> Self {
        Self {
            latest_ms: 0,
            imu_rows: imu.len(),
        }
    }

    /// The row's tick.
    fn tick_ms(&mut self, row: &Row<'_>) -> Result<u64, RowFault> {
        let tick_ms = row.milliseconds("tick_ms")?;
        if tick_ms < self.latest_ms {
            return Err(RowFault::OutOfOrder(tick_ms));
        }
        if tick_ms >= self.imu_rows as u64 {
            return Err(RowFault::BehindTheImu {
                tick_ms,
                imu_rows: self.imu_rows,
            });
        }
        self.latest_ms = tick_ms;
        Ok(tick_ms)
    }
}
