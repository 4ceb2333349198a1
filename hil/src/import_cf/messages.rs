//! What the camera said, as far as the variables of the group `vh` still tell.
//!
//! The group holds the last message of each kind (tomvand/2020-visualhoming-crazyflie, `visualhoming`): `v_*` VECTOR,
//! `m_*` MAP, `i_*` INS_CORRECTION; and `p_*`, the last place that a scripted experiment noted. Coordinates are east
//! and north, headings clockwise, indices the low byte. What stands in the first row is left over from before.

use link::{InsCorrection, Map, Vector};

use super::series::Variables;

/// A source byte without a meaning: the logs do not tell whether odometry or the camera led.
const NO_SOURCE: u8 = u8::MAX;

/// A place that a scripted experiment noted: the drone's own estimate at that moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuringPoint {
    /// The script's number of the run.
    pub run: u8,
    /// The script's number of the point.
    pub point: u8,
    /// Metres north.
    pub north: f64,
    /// Metres east.
    pub east: f64,
}

/// When the variables of a message changed, ms, and to what; none for those that were not logged.
type Seen<const N: usize> = (u64, [Option<f64>; N]);

/// The messages with the flight time, ms, of the row in which they were first seen.
#[derive(Clone, Debug, Default)]
pub struct Messages {
    /// Every vector that was seen.
    pub vectors: Vec<(u64, Vector)>,
    /// Every map entry that was seen, without coefficients: they are not logged.
    pub maps: Vec<(u64, Map)>,
    /// Every correction that was seen.
    pub corrections: Vec<(u64, InsCorrection)>,
    /// Every noted place that was seen.
    pub points: Vec<(u64, MeasuringPoint)>,
    /// Every step of the script that was seen.
    pub steps: Vec<(u64, u8)>,
}

impl Messages {
    /// All that the variables tell.
    pub fn of(variables: &Variables) -> Self {
        Self {
            vectors: vectors(variables),
            maps: maps(variables),
            corrections: corrections(variables),
            points: points(variables),
            steps: steps(variables),
        }
    }
}

fn vectors(variables: &Variables) -> Vec<(u64, Vector)> {
    const NAMES: [&str; 8] = [
        "vh.v_to_n",
        "vh.v_to_e",
        "vh.v_from_n",
        "vh.v_from_e",
        "vh.v_dpsi",
        "vh.v_source",
        "vh.v_pos_n",
        "vh.v_pos_e",
    ];
    let vector = |(ms, [to_n, to_e, from_n, from_e, turn, source, pos_n, pos_e]): Seen<8>| {
        let vector = Vector {
            target_n: single(to_n)?,
            target_e: single(to_e)?,
            start_n: single(from_n.or(pos_n))?,
            start_e: single(from_e.or(pos_e))?,
            delta_yaw: single(turn).unwrap_or(0.0),
            source: byte(source).unwrap_or(NO_SOURCE),
        };
        Some((ms, vector))
    };
    changes(variables, NAMES).filter_map(vector).collect()
}

fn maps(variables: &Variables) -> Vec<(u64, Map)> {
    const NAMES: [&str; 6] = [
        "vh.m_ss_idx",
        "vh.m_ss_n",
        "vh.m_ss_e",
        "vh.m_odo_idx",
        "vh.m_odo_n",
        "vh.m_odo_e",
    ];
    let (mut snapshot, mut odometry) = (Counter::default(), Counter::default());
    let map = |(ms, [ss, ss_n, ss_e, odo, odo_n, odo_e]): Seen<6>| {
        let (snapshot_n, snapshot_e) = (single(ss_n)?, single(ss_e)?);
        let map = Map {
            snapshot_index: snapshot.count(byte(ss)?),
            snapshot_n,
            snapshot_e,
            odometry_index: byte(odo).map_or(0, |low| odometry.count(low)),
            odometry_n: single(odo_n).unwrap_or(snapshot_n),
            odometry_e: single(odo_e).unwrap_or(snapshot_e),
            ..Map::default()
        };
        Some((ms, map))
    };
    changes(variables, NAMES).filter_map(map).collect()
}

fn corrections(variables: &Variables) -> Vec<(u64, InsCorrection)> {
    const NAMES: [&str; 7] = [
        "vh.i_ss_idx",
        "vh.i_from_n",
        "vh.i_from_e",
        "vh.i_from_psi",
        "vh.i_to_n",
        "vh.i_to_e",
        "vh.i_to_psi",
    ];
    let mut index = Counter::default();
    let correction = |(ms, [number, from_n, from_e, from_psi, to_n, to_e, to_psi]): Seen<7>| {
        let correction = InsCorrection {
            // Without its number each change is one more.
            snapshot_index: match byte(number) {
                Some(low) => index.count(low),
                None => index.one_more(),
            },
            n_from: single(from_n)?,
            e_from: single(from_e)?,
            psi_from: single(from_psi).unwrap_or(0.0),
            n_to: single(to_n)?,
            e_to: single(to_e)?,
            psi_to: single(to_psi).unwrap_or(0.0),
        };
        Some((ms, correction))
    };
    changes(variables, NAMES).filter_map(correction).collect()
}

fn points(variables: &Variables) -> Vec<(u64, MeasuringPoint)> {
    const NAMES: [&str; 4] = ["vh.p_pt", "vh.p_exp", "vh.p_n", "vh.p_e"];
    let point = |(ms, [point, run, north, east]): Seen<4>| {
        let point = MeasuringPoint {
            run: byte(run)?,
            point: byte(point)?,
            north: north?,
            east: east?,
        };
        Some((ms, point))
    };
    changes(variables, NAMES).filter_map(point).collect()
}

fn steps(variables: &Variables) -> Vec<(u64, u8)> {
    let step = |(ms, [step]): Seen<1>| Some((ms, byte(step)?));
    changes(variables, ["vh.p_block"])
        .filter_map(step)
        .collect()
}

/// The changes of a message's variables. The rows of the first variable that was logged are looked at: the others
/// may stand in files with another rhythm.
fn changes<'v, const N: usize>(
    variables: &'v Variables,
    names: [&str; N],
) -> impl Iterator<Item = Seen<N>> + use<'v, N> {
    let series = names.map(|name| variables.get(name));
    let rows = series.into_iter().flatten().next();
    let mut before = None;
    rows.into_iter()
        .flat_map(|rows| rows.times())
        .filter_map(move |ms| {
            let now = series.map(|series| series?.left_by(ms));
            let first = before.is_none();
            (before.replace(now) != Some(now) && !first).then_some((ms, now))
        })
}

/// As the message held it.
fn single(value: Option<f64>) -> Option<f32> {
    value.map(|value| value as f32)
}

fn byte(value: Option<f64>) -> Option<u8> {
    value.map(|value| value as u8)
}

/// A count of which only the low byte was logged.
#[derive(Clone, Copy, Debug, Default)]
struct Counter(u16);

impl Counter {
    /// Farther than this in one step a count does not go: it began anew. Stacks grow by ones and shrink by a few.
    const MOST_STEPS: u8 = 32;

    /// The count nearest to the last one that has this low byte.
    fn count(&mut self, low: u8) -> u16 {
        let step = low.wrapping_sub(self.0.to_le_bytes()[0]).cast_signed();
        let near = self.0.checked_add_signed(step.into());
        self.0 = match near {
            Some(near) if step.unsigned_abs() <= Self::MOST_STEPS => near,
            _ => low.into(),
        };
        self.0
    }

    fn one_more(&mut self) -> u16 {
        self.0 = self.0.wrapping_add(1);
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import_cf::LogFile;
    use crate::import_cf::clock::Clock;
    use crate::import_cf::table::Table;

    fn messages(files: &[&str]) -> Messages {
        let parse = |text: &&str| {
            let (name, bytes) = ("a.csv".into(), (*text).into());
            Table::parse(&LogFile { name, bytes }).expect("a log")
        };
        let tables: Vec<Table> = files.iter().map(parse).collect();
        let clock = Clock::of(&tables).expect("rows");
        Messages::of(&Variables::of(&tables, &clock))
    }

    #[test]
    fn a_count_goes_on_where_its_low_byte_wraps_both_ways() {
        let mut counter = Counter::default();
        let counts: Vec<u16> = (0..=300)
            .map(|count: u16| counter.count(count as u8))
            .collect();
        assert!(counts.iter().copied().eq(0..=300));
        assert_eq!(counter.count(299_u16 as u8), 299);
        assert_eq!(counter.count(255), 255);
    }

    #[test]
    fn a_count_that_falls_far_began_anew() {
        let mut counter = Counter(200);
        assert_eq!(counter.count(0), 0);
        assert_eq!(Counter(5).count(250), 250);
        assert_eq!(Counter(200).count(72), 72);
    }

    #[test]
    fn what_stands_in_the_first_row_is_no_message() {
        let log = "Timestamp,vh.p_block\n0,4\n100,4\n200,5\n300,5\n400,0\n";
        assert_eq!(messages(&[log]).steps, [(200, 5), (400, 0)]);
    }

    #[test]
    fn the_parts_of_a_correction_are_gathered_from_files_with_another_rhythm() {
        let from = "Timestamp,vh.i_ss_idx,vh.i_from_n,vh.i_from_e,vh.i_from_psi\n\
                    0,0,0,0,0\n100,0,0,0,0\n200,7,1.5,-0.5,0.25\n300,7,1.5,-0.5,0.25\n";
        let to = "Timestamp,vh.i_to_n,vh.i_to_e,vh.i_to_psi\n\
                  40,0,0,0\n190,0,0,0\n290,1.25,-0.75,0.5\n";
        let expected = InsCorrection {
            snapshot_index: 7,
            n_from: 1.5,
            e_from: -0.5,
            psi_from: 0.25,
            n_to: 1.25,
            e_to: -0.75,
            psi_to: 0.5,
        };
        assert_eq!(messages(&[from, to]).corrections, [(200, expected)]);
    }

    #[test]
    fn a_vector_without_its_source_is_neither_visual_nor_odometry() {
        let log = "Timestamp,vh.v_to_n,vh.v_to_e,vh.v_from_n,vh.v_from_e\n0,0,0,0,0\n100,1,2,3,4\n";
        let vectors = messages(&[log]).vectors;
        assert_eq!(vectors.len(), 1);
        assert_eq!(vectors[0].1.source(), None);
        assert_eq!((vectors[0].1.target_e, vectors[0].1.start_n), (2.0, 3.0));
    }
}
