//! One log file as numbers.

use csv::{ByteRecord, ReaderBuilder, StringRecord};

use super::LogFile;
use super::error::{Fault, ImportError};

/// Name of the first column.
const TIME_COLUMN: &str = "Timestamp";

/// The tick is sent with so many values (crazyflie-lib-python `log`: three bytes).
pub const TICKS: u64 = 1 << 24;

/// A tick that falls from within this time of its largest value to within this time of zero has wrapped, ms. Rows
/// are 2.55 s apart at most, and nobody restarts a Crazyflie in the minute in which it has run for 4 h 39 min.
const WRAP_MS: u64 = 60_000;

/// One packet of a log configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The Crazyflie's tick, milliseconds; goes on where the low 24 bits wrap.
    pub ms: u64,
    /// A value for each variable; what was no finite number is NaN.
    pub values: Vec<f64>,
}

/// A log file.
#[derive(Clone, Debug)]
pub struct Table {
    /// What errors and notes call it.
    pub name: String,
    /// The columns without the time.
    pub variables: Vec<String>,
    /// In the order of time.
    pub rows: Vec<Row>,
    /// Whether the tick wrapped between two rows.
    pub wrapped: bool,
    /// Whether the last line was cut off, and is left out: cfclient writes in blocks.
    pub cut: bool,
}

impl Table {
    /// Reads a log file.
    pub fn parse(file: &LogFile) -> Result<Self, ImportError> {
        let (bytes, cut) = whole_lines(&file.bytes);
        let mut reader = ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .quoting(false)
            .from_reader(bytes);
        let mut records = reader.byte_records();
        let at = |fault: Fault, line| fault.at(&file.name, line, 1);
        let header = match records.next() {
            Some(Ok(record)) => text(&record).map_err(|fault| at(fault, 1))?,
            // Reading from memory: nothing else can fail.
            Some(Err(_)) | None => return Err(at(Fault::NotALog(String::new()), 1)),
        };
        let mut table = Self {
            name: file.name.clone(),
            variables: variables(&header)
                .map_err(|(fault, column)| fault.at(&file.name, 1, column))?,
            rows: Vec::new(),
            wrapped: false,
            cut,
        };
        let mut wraps = 0;
        for (index, record) in records.enumerate() {
            let Ok(record) = record else { continue };
            let line = record
                .position()
                .map_or(index as u64 + 2, csv::Position::line);
            table
                .push(&record, &mut wraps)
                .map_err(|(fault, column)| fault.at(&file.name, line, column))?;
        }
        table.wrapped = wraps > 0;
        Ok(table)
    }

    /// First and last time, milliseconds.
    pub fn span_ms(&self) -> Option<(u64, u64)> {
        Some((self.rows.first()?.ms, self.rows.last()?.ms))
    }

    /// Whether a variable is one of its columns.
    pub fn has(&self, variable: &str) -> bool {
        self.variables.iter().any(|name| name == variable)
    }

    /// The usual time between two rows, ms: the median.
    pub fn period_ms(&self) -> Option<u64> {
        let steps = self.rows.windows(2).map(|pair| pair[1].ms - pair[0].ms);
        let mut steps: Vec<u64> = steps.collect();
        steps.sort_unstable();
        steps.get(steps.len() / 2).copied()
    }

    fn push(&mut self, record: &ByteRecord, wraps: &mut u64) -> Result<(), (Fault, u64)> {
        let record = text(record).map_err(|fault| (fault, 1))?;
        let expected = self.variables.len() + 1;
        if record.len() != expected {
            let (expected, found) = (expected as u64, record.len() as u64);
            return Err((Fault::WrongCount { expected, found }, 1));
        }
        let tick = tick(&record[0]).ok_or_else(|| (Fault::NotATime(record[0].to_owned()), 1))?;
        let ms = self.unwrapped(tick, wraps).map_err(|fault| (fault, 1))?;
        let mut values = Vec::with_capacity(self.variables.len());
        for (index, variable) in self.variables.iter().enumerate() {
            let text = &record[index + 1];
            let Ok(value) = text.trim().parse::<f64>() else {
                let (variable, text) = (variable.clone(), text.to_owned());
                let fault = Fault::NotANumber { variable, text };
                return Err((fault, column(&record, index + 1)));
            };
            values.push(if value.is_finite() { value } else { f64::NAN });
        }
        self.rows.push(Row { ms, values });
        Ok(())
    }

    /// The time of a row on a clock that does not wrap.
    fn unwrapped(&self, tick: u64, wraps: &mut u64) -> Result<u64, Fault> {
        let ms = |wraps| wraps * TICKS + tick;
        let Some(before) = self.rows.last().map(|row| row.ms) else {
            return Ok(tick);
        };
        if ms(*wraps) >= before {
            return Ok(ms(*wraps));
        }
        let last_tick = before - *wraps * TICKS;
        if tick < WRAP_MS && (TICKS - WRAP_MS..TICKS).contains(&last_tick) {
            *wraps += 1;
            return Ok(ms(*wraps));
        }
        Err(Fault::Restarted {
            from_ms: last_tick,
            to_ms: tick,
        })
    }
}

/// The bytes up to the last line's end, and whether something stood behind it. A single line counts as whole.
fn whole_lines(bytes: &[u8]) -> (&[u8], bool) {
    match bytes.iter().rposition(|byte| *byte == b'\n') {
        Some(end) => (&bytes[..=end], end + 1 < bytes.len()),
        None => (bytes, false),
    }
}

fn text(record: &ByteRecord) -> Result<StringRecord, Fault> {
    StringRecord::from_byte_record(record.clone()).map_err(|_| Fault::NotText)
}

/// The names behind the time column; or what is wrong, and in which column.
fn variables(header: &StringRecord) -> Result<Vec<String>, (Fault, u64)> {
    let first = header.get(0).unwrap_or_default();
    // A spreadsheet may have put its byte order mark in front.
    if first.trim_start_matches('\u{feff}') != TIME_COLUMN {
        return Err((Fault::NotALog(shortened(first)), 1));
    }
    let names: Vec<String> = header.iter().skip(1).map(str::to_owned).collect();
    for (index, name) in names.iter().enumerate() {
        if names[..index].contains(name) {
            return Err((Fault::TwoColumns(name.clone()), column(header, index + 1)));
        }
    }
    Ok(names)
}

/// What stands there, for a message: a file that is none of ours can have a very long first line.
fn shortened(text: &str) -> String {
    const MOST: usize = 40;
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

/// A tick as the Crazyflie counts it: 32 bits, of which cfclient's library passes on 24.
fn tick(text: &str) -> Option<u64> {
    text.trim().parse::<u32>().ok().map(u64::from)
}

/// Where a field begins in its line, from 1.
fn column(record: &StringRecord, field: usize) -> u64 {
    let before: usize = record.iter().take(field).map(|text| text.len() + 1).sum();
    before as u64 + 1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Table, String> {
        let file = LogFile {
            name: "a.csv".into(),
            bytes: text.into(),
        };
        Table::parse(&file).map_err(|error| error.to_string())
    }

    fn times(text: &str) -> Vec<u64> {
        let table = parse(text).expect("a log");
        table.rows.iter().map(|row| row.ms).collect()
    }

    #[test]
    fn a_row_is_its_time_and_a_value_for_each_variable() {
        let table = parse("Timestamp,vh.v_to_n,vh.v_source\n1234,-0.5,1\n1334,1e-05,0\n").unwrap();
        assert_eq!(table.variables, ["vh.v_to_n", "vh.v_source"]);
        assert_eq!(table.rows[0].values, [-0.5, 1.0]);
        assert_eq!(table.rows[1].values, [1e-5, 0.0]);
        assert_eq!(table.span_ms(), Some((1234, 1334)));
    }

    #[test]
    fn an_error_names_file_line_and_column() {
        for (text, message) in [
            (
                "t,x\n1,2\n",
                "a.csv:1:1: not a log of cfclient: the first column is called `t`",
            ),
            (
                "Timestamp,x,x\n",
                "a.csv:1:13: the column `x` is there twice",
            ),
            (
                "Timestamp,x\n1,2\n2,two\n",
                "a.csv:3:3: `two` is no number (column `x`)",
            ),
            (
                "Timestamp,x\n\n1,2\n1.5,2\n",
                "a.csv:4:1: `1.5` is no time stamp",
            ),
            (
                "Timestamp,x\n1,2,3\n",
                "a.csv:2:1: 3 values where the header names 2 columns",
            ),
            (
                "Timestamp,x\n90000,2\n100,2\n",
                "a.csv:3:1: the time falls from 90000 ms to 100 ms",
            ),
            ("", "a.csv:1:1: not a log of cfclient"),
        ] {
            let error = parse(text).expect_err(text);
            assert!(error.starts_with(message), "{error}");
        }
    }

    #[test]
    fn the_time_goes_on_where_its_24_bits_wrap() {
        let wrapping = "Timestamp,x\n16777116,1\n16777200,1\n84,1\n184,1\n";
        assert_eq!(
            times(wrapping),
            [16_777_116, 16_777_200, 16_777_300, 16_777_400]
        );
        assert!(parse(wrapping).unwrap().wrapped);
    }

    #[test]
    fn a_line_that_was_cut_off_is_left_out_and_told() {
        let table = parse("Timestamp,x\n1,2.5\n2,3.").unwrap();
        assert_eq!(table.rows.len(), 1);
        assert!(table.cut);
    }

    #[test]
    fn lines_may_end_as_on_windows() {
        assert_eq!(times("Timestamp,x\r\n1,2.5\r\n2,3.5\r\n"), [1, 2]);
    }

    #[test]
    fn what_is_not_finite_is_no_value() {
        let table = parse("Timestamp,x,y\n1,nan,-inf\n").unwrap();
        assert!(table.rows[0].values.iter().all(|value| value.is_nan()));
    }
}
