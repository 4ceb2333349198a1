//! Whole flights.

mod emulated;
mod eye;
mod faults;
mod native;
mod stabiliser;
mod twin;
