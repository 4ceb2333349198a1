//! Numbers by column name out of a CSV file without quotes, and the errors that name file and line.

use std::path::{Path, PathBuf};

/// Why a recording cannot be replayed.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// A file cannot be read.
    #[error("cannot read {}", path.display())]
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
    /// The header lacks a column.
    #[error("no column {0:?}")]
    NoColumn(&'static str),
    /// The row ends before this column.
    #[error("column {0:?} is missing")]
    Missing(&'static str),
    /// The text is not a number of the kind the column holds.
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

    /// Turns every row into a value; a fault is reported with this file and the row's line.
    pub(super) fn rows<T>(
        &self,
        mut convert: impl FnMut(&Row<'_>) -> Result<T, RowFault>,
    ) -> Result<Vec<T>, ReplayError> {
        let header: Vec<&str> = self.text.lines().next().unwrap_or("").split(',').collect();
        let lines = self.text.lines().zip(1..).skip(1);
        lines
            .map(|(text, line)| {
                let row = Row {
                    header: &header,
                    fields: text.split(',').collect(),
                };
                convert(&row).map_err(|fault| ReplayError::Row {
                    path: self.path.clone(),
                    line,
                    fault,
                })
            })
            .collect()
    }
}

/// One line of a file.
pub(super) struct Row<'a> {
    header: &'a [&'a str],
    fields: Vec<&'a str>,
}

impl Row<'_> {
    /// The text in a column.
    pub(super) fn text(&self, column: &'static str) -> Result<&str, RowFault> {
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

    /// The number in a column.
    pub(super) fn number<T: std::str::FromStr>(&self, column: &'static str) -> Result<T, RowFault> {
        let text = self.text(column)?;
        text.parse().map_err(|_| RowFault::NotANumber {
            column,
            text: text.to_owned(),
        })
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
