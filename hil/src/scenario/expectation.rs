//! What a scenario expects of its flights, and whether it came true.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::sweep::{FlightFigures, Statistics};

/// A figure over all flights of a scenario, by its name in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Metric {
    /// Share of the flights that end within 0.5 m of home, having followed the route to its end, 0..=1.
    HomeWithinHalfMetreShare,
    /// Share of the flights that follow the route to its end and land, 0..=1.
    CompletedShare,
    /// Median of the distances from home, metres.
    #[serde(rename = "home_error_m.p50")]
    HomeErrorP50M,
    /// Their 95th percentile.
    #[serde(rename = "home_error_m.p95")]
    HomeErrorP95M,
    /// The largest of them.
    #[serde(rename = "home_error_m.max")]
    HomeErrorMaxM,
    /// Median of how far odometry alone would have ended from home on the same flights, metres.
    #[serde(rename = "odometry_only_error_m.p50")]
    OdometryOnlyErrorP50M,
    /// Distance of the way back from the way out, root mean square of a flight, mean over the flights, metres.
    CrossTrackRmsM,
    /// Route memory with its counts, mean, bytes.
    MemoryBytes,
    /// The same per metre of the way out.
    BytesPerM,
    /// Snapshots taken, mean.
    Snapshots,
    /// True length of the way out, mean, metres.
    OutboundM,
    /// Frames that the camera sent and the firmware did not use, mean.
    FramesDropped,
    /// Frames of the link that were dropped, both ways, mean.
    LinkDrops,
}

impl Metric {
    /// Its figure.
    pub fn of(self, statistics: &Statistics) -> f64 {
        let flights = statistics.flights as f64;
        match self {
            Self::HomeWithinHalfMetreShare => statistics.home_within_half_metre as f64 / flights,
            Self::CompletedShare => statistics.completed as f64 / flights,
            Self::HomeErrorP50M => statistics.home_error_m.p50,
            Self::HomeErrorP95M => statistics.home_error_m.p95,
            Self::HomeErrorMaxM => statistics.home_error_m.max,
            Self::OdometryOnlyErrorP50M => statistics.odometry_only_error_m.p50,
            Self::CrossTrackRmsM => statistics.cross_track_rms_m,
            Self::MemoryBytes => statistics.memory_bytes,
            Self::BytesPerM => statistics.bytes_per_m,
            Self::Snapshots => statistics.snapshots,
            Self::OutboundM => statistics.outbound_m,
            Self::FramesDropped => statistics.frames_dropped,
            Self::LinkDrops => statistics.link_drops,
        }
    }

    /// Its figure for people, with its unit.
    pub fn in_words(self, figure: f64) -> String {
        match self {
            Self::HomeWithinHalfMetreShare | Self::CompletedShare => {
                format!("{:.0} %", 100.0 * figure)
            }
            Self::HomeErrorP50M
            | Self::HomeErrorP95M
            | Self::HomeErrorMaxM
            | Self::OdometryOnlyErrorP50M
            | Self::CrossTrackRmsM => format!("{figure:.2} m"),
            Self::OutboundM => format!("{figure:.1} m"),
            Self::MemoryBytes => format!("{figure:.0} B"),
            Self::BytesPerM => format!("{figure:.1} B/m"),
            Self::Snapshots | Self::FramesDropped | Self::LinkDrops => format!("{figure:.1}"),
        }
    }

    /// Whether a bound says something of every single flight: a share from below, the largest from above.
    fn binds_each(self, bounds: &Bounds) -> bool {
        match self {
            Self::HomeWithinHalfMetreShare | Self::CompletedShare => bounds.at_least.is_some(),
            Self::HomeErrorMaxM => bounds.at_most.is_some(),
            _ => false,
        }
    }
}

/// What the figure is, for people.
impl fmt::Display for Metric {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::HomeWithinHalfMetreShare => "home within 0.5 m",
            Self::CompletedShare => "route followed to its end",
            Self::HomeErrorP50M => "home error, median",
            Self::HomeErrorP95M => "home error, 95th percentile",
            Self::HomeErrorMaxM => "home error, largest",
            Self::OdometryOnlyErrorP50M => "error of odometry alone, median",
            Self::CrossTrackRmsM => "way back from way out, RMS",
            Self::MemoryBytes => "route memory",
            Self::BytesPerM => "route memory per metre",
            Self::Snapshots => "snapshots",
            Self::OutboundM => "way out",
            Self::FramesDropped => "camera frames lost",
            Self::LinkDrops => "link frames dropped",
        })
    }
}

/// Between which figures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Bounds {
    /// The smallest that holds.
    pub at_least: Option<f64>,
    /// The largest that holds.
    pub at_most: Option<f64>,
}

impl Bounds {
    /// Whether a figure lies between them; NaN never does.
    pub fn hold(&self, figure: f64) -> bool {
        self.at_most.is_none_or(|limit| figure <= limit)
            && self.at_least.is_none_or(|limit| figure >= limit)
            && !figure.is_nan()
    }
}

/// One expectation of a scenario.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Expectation {
    /// Of which figure.
    pub metric: Metric,
    /// Between which.
    #[serde(flatten)]
    pub bounds: Bounds,
    /// The number of the paper's claim that it checks.
    pub claim: Option<u8>,
    /// The paper's figure, for people.
    pub paper: Option<String>,
    /// Why these bounds.
    pub reason: String,
}

/// An expectation and what was found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// What was expected.
    #[serde(flatten)]
    pub expectation: Expectation,
    /// The figure.
    pub found: f64,
    /// Whether it lies within the bounds.
    pub kept: bool,
}

impl Expectation {
    /// Holds it against the figures of all flights.
    pub fn judge(&self, statistics: &Statistics) -> Verdict {
        let found = self.metric.of(statistics);
        Verdict {
            expectation: self.clone(),
            found,
            kept: self.bounds.hold(found),
        }
    }

    /// Whether one flight breaks it, where it says something of each flight.
    pub fn is_broken_by(&self, flight: &FlightFigures) -> bool {
        let alone = Statistics::of(std::slice::from_ref(flight), &[]);
        self.metric.binds_each(&self.bounds) && !self.bounds.hold(self.metric.of(&alone))
    }
}

/// Expectation and figure, both of them.
impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Expectation {
            metric,
            bounds,
            reason,
            ..
        } = &self.expectation;
        let words = |figure: f64| metric.in_words(figure);
        write!(f, "{metric}: {}", words(self.found))?;
        if let Some(limit) = bounds.at_least {
            write!(f, ", at least {}", words(limit))?;
        }
        if let Some(limit) = bounds.at_most {
            write!(f, ", at most {}", words(limit))?;
        }
        if self.kept {
            return Ok(());
        }
        write!(f, ": BROKEN ({reason})")
    }
}
