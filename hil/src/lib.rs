//! The rig: flies the firmware in closed loop, on an emulated board or natively, and reports.
//!
//! ```text
//! scenario -> flight loop <-> board (emulated or native)
//!                |
//!             record -> summary, report, folder
//! ```

pub mod bench;
pub mod board;
pub mod calibrate;
pub mod calibrate_timing;
pub mod camera_faults;
pub mod catchment;
pub mod cli;
pub mod drift;
pub mod ekf_replay;
pub mod experiments;
pub mod exposure;
pub mod flight;
pub mod folder;
pub mod gdb;
pub mod homing_check;
pub mod homing_cycles;
pub mod homing_test;
pub mod image;
pub mod import_cf;
pub mod link_check;
pub mod live;
pub mod look;
pub mod metrics;
pub mod parallel;
pub mod profile;
pub mod record;
pub mod recorder;
pub mod report;
pub mod rig;
pub mod scenario;
pub mod sensing;
pub mod size;
pub mod steps;
pub mod summary;
pub mod sweep;
pub mod toml_file;
