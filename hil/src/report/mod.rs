//! The flight as one page to read and one picture to show.
//!
//! [`html`] is a single file that opens without a network: figures are inline SVG, style and the
//! little script for read-outs are inside. [`picture`] is the world from above by itself. Both are
//! functions of the recording and the summary alone: equal flights give equal bytes, apart from
//! the wall time that the summary brings along.

mod charts;
mod conditions;
mod errors;
mod figures;
pub(crate) mod histogram;
pub(crate) mod horizon;
mod key_figures;
mod link;
mod log;
mod map;
mod memory;
pub(crate) mod number;
mod page;
mod phase;
mod plot;
#[cfg(test)]
pub(crate) mod sample;
pub(crate) mod style;
pub(crate) mod svg;
#[cfg(test)]
mod tests;
pub(crate) mod ticks;

use crate::record::Recording;
use crate::summary::Summary;

/// `report.html`: the whole flight, complete in itself.
///
/// An empty recording gives a valid page that says what is missing; values that are not finite
/// leave gaps. Long flights are thinned to what a screen can resolve, so that the file stays below
/// 1.5 MB.
pub fn html(recording: &Recording, summary: &Summary) -> String {
    page::page(recording, summary).into_string()
}

/// The world from above with the flight in it, as a stand-alone SVG on a light background,
/// legible from 900 pixels of width.
pub fn picture(recording: &Recording, summary: &Summary) -> String {
    map::picture(recording, summary).into_string()
}
