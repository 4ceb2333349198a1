//! Writes the log files that cfclient would have written of a flight: a file for each log configuration, a row for each
//! packet, the group `vh` as the flight app keeps it, east before north, headings clockwise, indices in a byte.

use std::fmt::Write as _;

use hil::import_cf::LogFile;
use hil::record::{PlanarPose, Recording};

/// Log files of a flight.
pub const FILES: usize = 4;

/// All variables that the importer reads.
pub const VARIABLES: [&str; 30] = [
    "stateEstimate.x",
    "stateEstimate.y",
    "stateEstimate.z",
    "stateEstimate.yaw",
    "vh.v_from_e",
    "vh.v_from_n",
    "vh.v_to_e",
    "vh.v_to_n",
    "vh.v_pos_e",
    "vh.v_pos_n",
    "vh.v_dpsi",
    "vh.v_source",
    "vh.m_ss_idx",
    "vh.m_ss_e",
    "vh.m_ss_n",
    "vh.m_odo_idx",
    "vh.m_odo_e",
    "vh.m_odo_n",
    "vh.i_ss_idx",
    "vh.i_from_e",
    "vh.i_from_n",
    "vh.i_from_psi",
    "vh.i_to_e",
    "vh.i_to_n",
    "vh.i_to_psi",
    "vh.p_e",
    "vh.p_n",
    "vh.p_exp",
    "vh.p_pt",
    "vh.p_block",
];

/// The Crazyflie's tick where the flight begins, ms: its 24 bits wrap in mid-flight.
const FIRST_TICK: u64 = (1 << 24) - 20_000;

/// A log configuration: its name, its variables, when in each period its packet is sent, and the period, ms.
struct Configuration {
    name: &'static str,
    variables: &'static [&'static str],
    offset_ms: u64,
    period_ms: u64,
}

impl Configuration {
    /// The file; `values` are the variables at a flight time, seconds.
    fn file(&self, end_s: f64, values: impl Fn(f64) -> Vec<f64>) -> LogFile {
        let mut text = format!("Timestamp,{}\n", self.variables.join(","));
        let mut ms = self.offset_ms;
        while ms as f64 / 1e3 <= end_s {
            // Writing to a String cannot fail.
            let _ = write!(text, "{}", (FIRST_TICK + ms) % (1 << 24));
            let values = values(ms as f64 / 1e3);
            assert_eq!(values.len(), self.variables.len());
            for value in values {
                // The packet holds single precision, Python prints it as double.
                let _ = write!(text, ",{}", f64::from(value as f32));
            }
            text.push('\n');
            ms += self.period_ms;
        }
        LogFile {
            name: format!("{}-20230531T10-11-12.csv", self.name),
            bytes: text.into_bytes(),
        }
    }
}

/// The logs of a flight: the filter's state, vectors, the rest of the vectors with the map, corrections.
pub fn logs(recording: &Recording) -> Vec<LogFile> {
    let end_s = recording.track.last().expect("a track").t;
    let file = |name, offset_ms, period_ms, variables, values: &dyn Fn(f64) -> Vec<f64>| {
        let configuration = Configuration {
            name,
            variables,
            offset_ms,
            period_ms,
        };
        configuration.file(end_s, values)
    };
    vec![
        file("state", 0, 100, &VARIABLES[..4], &|t| state(recording, t)),
        file("vector", 30, 100, &VARIABLES[4..10], &|t| {
            vector(recording, t)
        }),
        file("map", 60, 100, &VARIABLES[10..18], &|t| map(recording, t)),
        file("correction", 90, 200, &VARIABLES[18..25], &|t| {
            correction(recording, t)
        }),
    ]
}

fn state(recording: &Recording, t: f64) -> Vec<f64> {
    let point = &recording.track[(10.0 * t).round() as usize];
    let estimate = point.estimate;
    vec![
        estimate.x,
        estimate.y,
        point.height,
        estimate.yaw.to_degrees(),
    ]
}

/// The last thing that had happened by a time.
fn last<T>(things: &[T], time: impl Fn(&T) -> f64, t: f64) -> Option<&T> {
    things.iter().rfind(|thing| time(thing) <= t)
}

fn east_north(pose: PlanarPose) -> [f64; 2] {
    [-pose.y, pose.x]
}

fn vector(recording: &Recording, t: f64) -> Vec<f64> {
    let Some(mark) = last(&recording.vectors, |mark| mark.t, t) else {
        return vec![0.0; 6];
    };
    // The app was about where the camera saw it.
    let places = [mark.start, mark.target, mark.start];
    places.into_iter().flat_map(east_north).collect()
}

fn map(recording: &Recording, t: f64) -> Vec<f64> {
    let vector = last(&recording.vectors, |mark| mark.t, t);
    let mut values = vector.map_or(vec![0.0; 2], |mark| {
        vec![-mark.target.yaw, f64::from(u8::from(!mark.visual))]
    });
    let Some(snapshot) = last(&recording.snapshots, |mark| mark.t, t) else {
        values.extend([0.0; 6]);
        return values;
    };
    let low_byte = |count: u16| f64::from(count.to_le_bytes()[0]);
    // The way out ends some vectors behind the last snapshot.
    let turned = recording
        .vectors
        .first()
        .is_some_and(|first| t > first.t - 0.5);
    let count = if turned {
        recording.odometry_stored
    } else {
        snapshot.odometry_count
    };
    let place = east_north(snapshot.believed);
    values.push(low_byte(snapshot.index));
    values.extend(place);
    values.push(low_byte(count));
    values.extend(place);
    values
}

fn correction(recording: &Recording, t: f64) -> Vec<f64> {
    let Some(mark) = last(&recording.corrections, |mark| mark.t, t) else {
        return vec![0.0; 7];
    };
    let pose = |pose: PlanarPose| [-pose.y, pose.x, -pose.yaw];
    let index = f64::from(mark.index.to_le_bytes()[0]);
    let poses = [mark.from, mark.to].into_iter().flat_map(pose);
    std::iter::once(index).chain(poses).collect()
}
