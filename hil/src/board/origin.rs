//! Where a record of the firmware's log comes from: when, and from which line of the sources.

use std::fmt;
use std::path::{Component, Path};

use defmt_decoder::Location;
use serde::Serialize;

/// The package that all folders of the image's own sources lie in.
const OUR_FOLDER: &str = "firmware";
/// Under it cargo keeps the sources of other packages: `registry/src/INDEX/PACKAGE-VERSION`.
const REGISTRY: &str = "registry";
/// Folders from [`REGISTRY`] to the package's own.
const REGISTRY_DEPTH: usize = 3;

/// When and where the firmware logged something.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Origin {
    /// The firmware's own time stamp as its image formats it: seconds since boot, to the microsecond.
    pub stamp: String,
    /// The log statement; none where the image has no debug information.
    pub place: Option<Place>,
}

/// A log statement in the sources.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Place {
    /// Crate, modules and function: `firmware::log::boot`.
    pub module: String,
    /// The file: relative to the checkout, or from its package's folder on where it is another's.
    /// Whoever built the image, and where, does not show.
    pub file: String,
    /// The line in it, from 1.
    pub line: u64,
}

impl From<Location> for Place {
    fn from(location: Location) -> Self {
        Self {
            module: location.module,
            file: without_builder(&location.file),
            line: location.line,
        }
    }
}

/// As probe-rs prints it behind the `└─` of a log line.
impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} @ {}:{}", self.module, self.file, self.line)
    }
}

/// What of a path is the same on every machine.
fn without_builder(path: &Path) -> String {
    let names: Vec<_> = path
        .components()
        .filter(|component| matches!(component, Component::Normal(_)))
        .map(|component| component.as_os_str().to_string_lossy())
        .collect();
    let last = |folder: &str| names.iter().rposition(|name| name == folder);
    let from = match (last(REGISTRY), last(OUR_FOLDER)) {
        (Some(registry), _) => registry + REGISTRY_DEPTH,
        (None, Some(ours)) => ours,
        (None, None) => 0,
    };
    names.get(from..).unwrap_or(&names).join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_source_of_ours_is_told_from_the_checkout_on_wherever_that_is() {
        for checkout in ["/home/ann/cataglyphis", "/", "/src/firmware"] {
            let path = Path::new(checkout).join("firmware/src/log.rs");
            assert_eq!(without_builder(&path), "firmware/src/log.rs");
        }
    }

    #[test]
    fn a_source_of_another_package_is_told_with_its_version() {
        let path =
            "/home/ann/.cargo/registry/src/index.crates.io-1949cf8c/panic-probe-1.0.0/src/lib.rs";
        assert_eq!(
            without_builder(Path::new(path)),
            "panic-probe-1.0.0/src/lib.rs"
        );
        assert_eq!(without_builder(Path::new("/a/b.rs")), "a/b.rs");
    }

    #[test]
    fn a_place_reads_as_under_probe_rs() {
        let place = Place {
            module: "firmware::log::boot".to_owned(),
            file: "firmware/src/log.rs".to_owned(),
            line: 31,
        };
        assert_eq!(
            place.to_string(),
            "firmware::log::boot @ firmware/src/log.rs:31"
        );
    }
}
