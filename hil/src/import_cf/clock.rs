//! One clock for all files: milliseconds since their first row.

use super::error::{Fault, ImportError};
use super::table::{TICKS, Table};

/// Where the files' own times stand on the common clock.
#[derive(Clone, Debug)]
pub struct Clock {
    /// For each file: what is added to its times, ms.
    shifts: Vec<u64>,
    /// The first row of all, ms after the shift.
    zero_ms: u64,
}

impl Clock {
    /// The clock that all files share.
    pub fn of(tables: &[Table]) -> Result<Self, ImportError> {
        let reference = tables
            .iter()
            .find(|table| table.wrapped)
            .and_then(Table::span_ms);
        let shifts: Vec<u64> = tables.iter().map(|table| shift(table, reference)).collect();
        let firsts = tables.iter().zip(&shifts);
        let zero_ms = firsts
            .filter_map(|(table, shift)| Some(table.span_ms()?.0 + shift))
            .min();
        match (zero_ms, tables.first()) {
            (Some(zero_ms), _) => Ok(Self { shifts, zero_ms }),
            (None, first) => {
                let name = first.map_or("", |table| table.name.as_str());
                Err(Fault::NoRows.at(name, 1, 1))
            }
        }
    }

    /// Flight time of a row of a file, ms.
    pub fn ms(&self, file: usize, ms: u64) -> u64 {
        ms + self.shifts[file] - self.zero_ms
    }

    /// Flight time of a file's first and last row, ms.
    pub fn span_ms(&self, file: usize, table: &Table) -> Option<(u64, u64)> {
        let (first, last) = table.span_ms()?;
        Some((self.ms(file, first), self.ms(file, last)))
    }
}

/// A file that begins after the tick has wrapped in another one is one wrap later than its own times say.
fn shift(table: &Table, reference: Option<(u64, u64)>) -> u64 {
    match (reference, table.span_ms()) {
        (Some(reference), Some(span)) if !table.wrapped => {
            let later = (span.0 + TICKS, span.1 + TICKS);
            if distance(reference, later) < distance(reference, span) {
                TICKS
            } else {
                0
            }
        }
        _ => 0,
    }
}

/// Time between two spans; zero where they meet.
fn distance(a: (u64, u64), b: (u64, u64)) -> u64 {
    b.0.saturating_sub(a.1).max(a.0.saturating_sub(b.1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import_cf::LogFile;

    fn table(times: &[u64]) -> Table {
        let rows: String = times.iter().map(|time| format!("{time},0\n")).collect();
        let file = LogFile {
            name: "a.csv".into(),
            bytes: format!("Timestamp,x\n{rows}").into(),
        };
        Table::parse(&file).expect("a log")
    }

    #[test]
    fn flight_time_begins_with_the_first_row_of_all_files() {
        let tables = [table(&[5000, 6000]), table(&[4900, 6100])];
        let clock = Clock::of(&tables).expect("rows");
        assert_eq!(clock.span_ms(0, &tables[0]), Some((100, 1100)));
        assert_eq!(clock.span_ms(1, &tables[1]), Some((0, 1200)));
    }

    #[test]
    fn a_file_that_begins_after_the_wrap_of_another_is_later_by_a_wrap() {
        let tables = [table(&[16_777_000, 84, 5000]), table(&[1000, 2000])];
        let clock = Clock::of(&tables).expect("rows");
        assert_eq!(clock.span_ms(1, &tables[1]), Some((1216, 2216)));
    }

    #[test]
    fn files_without_rows_are_an_error() {
        let error = Clock::of(&[table(&[])]).expect_err("nothing");
        assert_eq!(error.to_string(), "a.csv:1:1: no file has a row of values");
    }
}
