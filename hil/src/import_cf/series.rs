//! A variable over time.

use std::collections::BTreeMap;

use super::clock::Clock;
use super::table::Table;

/// Two rows farther apart than this have a gap between them, ms: the slowest log configuration has 2.55 s (a byte of
/// 10 ms; crazyflie-firmware `log`), the usual ones 10 to 100 ms.
pub const GAP_MS: u64 = 3_000;

/// The samples of one variable.
#[derive(Clone, Debug, Default)]
pub struct Series {
    /// Flight time in ms and value, in the order of time; all finite.
    samples: Vec<(u64, f64)>,
}

impl Series {
    #[cfg(test)]
    pub fn of(samples: &[(u64, f64)]) -> Self {
        Self {
            samples: samples.to_vec(),
        }
    }

    /// Flight times, ms.
    pub fn times(&self) -> impl Iterator<Item = u64> {
        self.samples.iter().map(|(ms, _)| *ms)
    }

    /// The samples on both sides of a time, the same one twice where it is met; none outside and in a gap.
    pub fn around(&self, ms: u64) -> Option<[(u64, f64); 2]> {
        let next = self.samples.partition_point(|sample| sample.0 < ms);
        let after = *self.samples.get(next)?;
        if after.0 == ms {
            return Some([after, after]);
        }
        let before = *self.samples.get(next.checked_sub(1)?)?;
        (after.0 - before.0 <= GAP_MS).then_some([before, after])
    }

    /// The value at a time, on the straight line between two samples; none outside and in a gap.
    pub fn between(&self, ms: u64) -> Option<f64> {
        let [before, after] = self.around(ms)?;
        Some(before.1 + share([before.0, after.0], ms) * (after.1 - before.1))
    }

    /// What a message that was seen at a time left in this variable: the next sample, or where none is near, the last.
    /// Each log configuration has its own rhythm: of the samples around `ms` only the next one surely is not older
    /// than the message.
    pub fn left_by(&self, ms: u64) -> Option<f64> {
        let next = self.samples.partition_point(|sample| sample.0 < ms);
        let ahead = self
            .samples
            .get(next)
            .filter(|after| after.0 - ms <= GAP_MS);
        let sample = ahead.or_else(|| self.samples.get(next.checked_sub(1)?))?;
        Some(sample.1)
    }
}

/// How far a time is from the first to the second of two others, 0..=1.
pub fn share([from, to]: [u64; 2], ms: u64) -> f64 {
    if to == from {
        return 0.0;
    }
    (ms - from) as f64 / (to - from) as f64
}

/// All variables by name.
#[derive(Clone, Debug, Default)]
pub struct Variables(BTreeMap<String, Series>);

impl Variables {
    /// The variables of all files on one clock. One that stands in several files has the samples of all.
    pub fn of(tables: &[Table], clock: &Clock) -> Self {
        let mut all: BTreeMap<String, Series> = BTreeMap::new();
        for (file, table) in tables.iter().enumerate() {
            for (column, name) in table.variables.iter().enumerate() {
                let series = all.entry(name.clone()).or_default();
                let samples = table
                    .rows
                    .iter()
                    .map(|row| (clock.ms(file, row.ms), row.values[column]));
                series
                    .samples
                    .extend(samples.filter(|(_, value)| value.is_finite()));
            }
        }
        for series in all.values_mut() {
            series.samples.sort_by_key(|(ms, _)| *ms);
        }
        Self(all)
    }

    /// A variable; none where no file has it, or no value of it.
    pub fn get(&self, name: &str) -> Option<&Series> {
        self.0.get(name).filter(|series| !series.samples.is_empty())
    }

    /// Whether any variable is one that can be drawn.
    pub fn are_known(&self) -> bool {
        const GROUPS: [&str; 4] = ["vh.", "stateEstimate.", "stateEstimateZ.", "kalman."];
        let known = |name: &String| GROUPS.iter().any(|group| name.starts_with(group));
        self.0.keys().any(known)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_two_samples_a_value_lies_on_the_straight_line() {
        let series = Series::of(&[(100, 1.0), (200, 3.0)]);
        assert_eq!(series.between(100), Some(1.0));
        assert_eq!(series.between(150), Some(2.0));
        assert_eq!(series.between(201), None);
        assert_eq!(series.between(99), None);
    }

    #[test]
    fn nothing_is_known_in_a_gap() {
        let series = Series::of(&[(0, 1.0), (GAP_MS + 1, 3.0)]);
        assert_eq!(series.between(1), None);
    }

    #[test]
    fn a_message_is_read_from_the_next_sample_of_each_variable() {
        let series = Series::of(&[(95, 1.0), (195, 2.0)]);
        assert_eq!(series.left_by(100), Some(2.0));
        assert_eq!(series.left_by(195), Some(2.0));
        assert_eq!(series.left_by(300), Some(2.0));
    }
}
