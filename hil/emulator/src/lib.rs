//! A Cortex-M4F and an STM32F407 in software. Knows nothing of drones.

pub mod core;
pub mod image;
pub mod machine;
pub mod memory;
pub mod soc;
pub mod time;
pub mod trace;
pub mod wiring;
