//! Numbers by column name out of a CSV file without quotes, and the errors that name file and line.

use std::path::{Path, PathBuf};

/// Why a recording cannot be replayed.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// A file cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A row, or the header, does not hold what the format asks for.
    #[error("{}:{line}: {fault}", path.display())]
    Row {
        /// The file.
        path: PathBuf,
        /// Line number, the header being 1.
        line: usize,
        /// What is wrong with it.
        fault: RowFault,
    },
    /// One tick holds more events than the filter's queue takes.
    #[error("tick {tick_ms}: more events than the filter's queue holds")]
    TooManyEvents {
        /// The tick, ms.
        tick_ms: u64,
    },
}

/// What is wrong with one row.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum RowFault {
    /// The file is empty.
    #[error("the header is missing")]
    NoHeader,
    /// There is a header and nothing below it.
    #[error("there is no row below the header")]
    NoRows,
    /// The header lacks a column.
    #[error("no column {0:?}")]
    NoColumn(&'static str),
    /// The row ends before this column.
    #[error("column {0:?} is missing")]
    Missing(&'static str),
    /// The row goes on behind the header's last column.
    #[error("{found} fields under {columns} columns")]
    TooManyFields {
        /// Fields of the row.
        found: usize,
        /// Columns of the header.
        columns: usize,
    },
    /// The text is not a finite number of the kind the column holds.
    #[error("column {column:?} holds {text:?}, not a number of its kind")]
    NotANumber {
        /// The column.
        column: &'static str,
        /// What it holds.
        text: String,
    },
    /// The event is of no known kind.
    #[error("unknown event {0:?}")]
    UnknownEvent(String),
    /// The row's tick is before the previous row's.
    #[error("tick {0} ms comes after a later one")]
    OutOfOrder(u64),
    /// The row's tick is behind the last IMU sample: the filter never gets there.
    #[error("tick {tick_ms} ms is behind the last of {imu_rows} IMU rows")]
    BehindTheImu {
        /// The row's tick, ms.
        tick_ms: u64,
        /// IMU rows, one a millisecond.
        imu_rows: usize,
    },
}

/// A file's text.
pub(in crate::ekf) struct Source {
    path: PathBuf,
    text: String,
}

impl Source {
    pub(super) fn read(path: &Path) -> Result<Self, ReplayError> {
        let text = std::fs::read_to_string(path).map_err(|source| ReplayError::Read {
            path: path.to_owned(),
            source,
        })?;
        Ok(Self {
            path: path.to_owned(),
            text,
        })
    }

    #[cfg(test)]
    pub(in crate::ekf) fn of(name: &str, text: &str) -> Self {
        Self {
            path: name.into(),
            text: text.into(),
        }
    }

    /// Turns every row into a value; a fault is reported with this file and the row's line. Blank lines at the end
    /// are no rows.
    pub(super) fn rows<T>(
        &self,
        mut convert: impl FnMut(&Row<'_>) -> Result<T, RowFault>,
    ) -> Result<Vec<T>, ReplayError> {
        let mut lines = self.text.trim_end().lines();
        let header: Vec<&str> = match lines.next() {
            Some(header) => fields(header),
            None => return Err(self.fault(1, RowFault::NoHeader)),
        };
        (2..)
            .zip(lines)
            .map(|(line, text)| {
                Row::under(&header, text)
                    .and_then(|row| convert(&row))
                    .map_err(|fault| self.fault(line, fault))
            })
            .collect()
    }

    /// As [`Source::rows`]; there must be some.
    pub(super) fn some_rows<T>(
        &self,
        convert: impl FnMut(&Row<'_>) -> Result<T, RowFault>,
    ) -> Result<Vec<T>, ReplayError> {
        let rows = self.rows(convert)?;
        if rows.is_empty() {
            return Err(self.fault(1, RowFault::NoRows));
        }
        Ok(rows)
    }

    fn fault(&self, line: usize, fault: RowFault) -> ReplayError {
        ReplayError::Row {
            path: self.path.clone(),
            line,
            fault,
        }
    }
}

fn fields(line: &str) -> Vec<&str> {
    line.split(',').map(str::trim).collect()
}

/// One line of a file.
pub(super) struct Row<'a> {
    header: &'a [&'a str],
    fields: Vec<&'a str>,
}

impl<'a> Row<'a> {
    fn under(header: &'a [&'a str], line: &'a str) -> Result<Self, RowFault> {
        let fields = fields(line);
        if fields.len() > header.len() {
            return Err(RowFault::TooManyFields {
                found: fields.len(),
                columns: header.len(),
            });
        }
        Ok(Self { header, fields })
    }

    /// The text in a column.
    pub(super) fn text(&self, column: &'static str) -> Result<&'a str, RowFault> {
        let index = self
            .header
            .iter()
            .position(|name| *name == column)
            .ok_or(RowFault::NoColumn(column))?;
        match self.fields.get(index) {
            Some(text) if !text.is_empty() => Ok(text),
            _ => Err(RowFault::Missing(column)),
        }
    }

    /// The whole number of milliseconds in a column.
    pub(super) fn milliseconds(&self, column: &'static str) -> Result<u64, RowFault> {
        let text = self.text(column)?;
        text.parse().map_err(|_| not_a_number(column, text))
    }

    /// The finite number in a column.
    pub(super) fn number(&self, column: &'static str) -> Result<f32, RowFault> {
        let text = self.text(column)?;
        text.parse()
            .ok()
            .filter(|value: &f32| value.is_finite())
            .ok_or_else(|| not_a_number(column, text))
    }

    /// The numbers in several columns.
    pub(super) fn numbers<const N: usize>(
        &self,
        columns: [&'static str; N],
    ) -> Result<[f32; N], RowFault> {
        let mut values = [0.0; N];
        for (value, column) in values.iter_mut().zip(columns) {
            *value = self.number(column)?;
        }
        Ok(values)
    }
}

fn not_a_number(column: &'static str, text: &str) -> RowFault {
    RowFault::NotANumber {
        column,
        text: text.to_owned(),
    }
}
