//! Files in TOML that describe something: read, checked, and refused with the line where something is wrong.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;

/// A file that does not describe what it should.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The file cannot be read.
    #[error("{}: {source}", file.display())]
    Unreadable {
        /// Which.
        file: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The file says something that cannot be.
    #[error("{}:{line}: {reason}", file.display())]
    Mistake {
        /// Which.
        file: PathBuf,
        /// From 1.
        line: usize,
        /// What is wrong there.
        reason: String,
    },
}

/// What is wrong, and the bytes of the text that it is about.
pub type Mistake = (Range<usize>, String);

/// The text of a file.
///
/// # Errors
/// [`FileError::Unreadable`].
pub fn read(file: &Path) -> Result<String, FileError> {
    fs::read_to_string(file).map_err(|source| FileError::Unreadable {
        file: file.to_owned(),
        source,
    })
}

/// What a text says, as `check` understands it.
///
/// # Errors
/// [`FileError::Mistake`], where it is no TOML, has not that form, or does not stand the check.
pub fn parse<Form: DeserializeOwned, What>(
    file: &Path,
    text: &str,
    check: impl FnOnce(Form) -> Result<What, Mistake>,
) -> Result<What, FileError> {
    toml::from_str::<Form>(text)
        .map_err(|error| (error.span().unwrap_or_default(), error.message().to_owned()))
        .and_then(check)
        .map_err(|(span, reason)| FileError::Mistake {
            file: file.to_owned(),
            line: line_of(text, &span),
            reason,
        })
}

/// The line on which a span begins, from 1.
fn line_of(text: &str, span: &Range<usize>) -> usize {
    let before = text.bytes().take(span.start);
    1 + before.filter(|byte| *byte == b'\n').count()
}
