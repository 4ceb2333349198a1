//! Catchment areas: from where a snapshot of so many bytes brings a robot home (paper, Fig. 3).
//!
//! ```text
//! place -> survey (a view from each position of a grid, under a condition) -> field of homing vectors
//!       -> trajectories through the interpolated vectors -> area from which they end near the snapshot
//! ```
//!
//! The procedure is the paper's ("Comparison of homing methods"): snapshots throughout the room, vectors
//! at all positions of a 12.7 cm grid, each method tuned for each size by a grid search.

pub mod condition;
pub mod crossing;
pub mod field;
pub mod grid;
pub mod judge;
pub mod markdown;
pub mod measure;
pub mod pictures;
pub mod place;
pub mod plots;
pub mod render;
mod search_vectors;
pub mod settings;
pub mod survey;

pub use condition::Condition;
pub use measure::{Area, Row, Task, evaluate, tune, tune_among};
pub use place::{Named, Place, PlaceError};
pub use settings::{Method, Settings};
pub use survey::Survey;

#[cfg(test)]
mod tests;
