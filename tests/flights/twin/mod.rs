//! The published flight app's twin on the native board: its peculiarities on the link and its scripted experiments,
//! flown whole.

mod experiments;
mod quirks;
mod rig;
