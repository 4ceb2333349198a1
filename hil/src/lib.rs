//! The rig: flies the firmware in closed loop, on an emulated board or natively, and reports.

pub mod record;
pub mod report;
pub mod summary;
