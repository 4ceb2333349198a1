//! Visual route following in a few bytes per metre, as a pure room: no hardware, no clock, no
//! allocation. Time and measurements are arguments, decisions are return values.
//!
//! The way of the data (van Dijk et al., "Visual route following for tiny autonomous robots",
//! Science Robotics 2024):
//!
//! ```text
//! frame -> PanoramaMap -> Horizon (128 values) -> Spectrum -> Snapshot (16 bytes)
//!                                                    |            |
//!                                                    +-> homing <-+-> Route <-> Navigator
//! ```
//!
//! # Conventions
//!
//! Positions are metres, x north, y west. Headings and bearings are radians, counter-clockwise seen
//! from above, zero at north. The panorama I(θ) has the real Fourier coefficients a_k = 2 Re F_k and
//! b_k = -2 Im F_k, F = DFT / 128, and the complex shorthand c_k = a_k - i b_k. Turning the viewer
//! counter-clockwise by s turns I(θ) into I(θ + s) and c_k into c_k e^{iks}.
//!
//! # Determinism
//!
//! All arithmetic is f32 with software functions (`libm`, nalgebra's `libm-force`) and without fused
//! multiply-add, so that a host and a Cortex-M4F agree to the bit.
#![no_std]

pub mod calibration;
mod cosine;
pub mod derotation;
pub mod exposure;
pub mod homing;
pub mod horizon;
pub mod methods;
pub mod navigator;
mod pair;
pub mod panorama;
pub mod pose;
pub mod route;
pub mod snapshot;
pub mod spectrum;

pub use calibration::{BearingDirection, CalibrationError, LensCalibration, RecordError};
pub use derotation::{Derotation, Tilt};
pub use exposure::{Exposure, ExposureController, ExposureParameters, LumaHistogram};
pub use homing::{HomingParameters, HomingVector, NoVectorReason};
pub use horizon::Horizon;
pub use navigator::{
    Arrival, Correction, Event, MapEntry, Mode, Navigator, Parameters, Recording, SetPoint, Source,
    Step, UnknownCommand,
};
pub use panorama::{FrameLayout, PanoramaMap};
pub use pose::Pose;
pub use route::{OdometryVector, Route, RouteFull, StoredSnapshot};
pub use snapshot::{Snapshot, SnapshotFormat};
pub use spectrum::Spectrum;
