//! How fast the rig itself is on this machine.

use std::time::Instant;

use emulator::time::Nanos;
use emulator::wiring::Unwired;
use serde::Serialize;

use crate::board::BoardError;
use crate::board::emulated::Firmware;
use crate::flight::{self, FlightError};
use crate::scenario::{Conditions, Homing, Route, Scenario, Spacing, Storage};

/// The firmware's example that keeps the core busy.
pub const EXAMPLE: &str = "busy";

/// How long the busy core runs, by its own clock: a good second here.
const BUSY: Nanos = Nanos::from_millis(15_000);

/// What `--json` prints.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// Million instructions of the emulated core in a second of ours, where it never sleeps.
    pub busy_mips: f64,
    /// Seconds of the default flight in one of ours, on the emulated board.
    pub emulated_realtime_factor: f64,
    /// The same on the native one.
    pub native_realtime_factor: f64,
}

/// Million instructions a second of an image that never sleeps.
///
/// # Errors
/// [`BoardError`] where the image cannot be run.
pub fn busy_mips(elf: &[u8]) -> Result<f64, BoardError> {
    let firmware = Firmware::parse(elf)?;
    let mut machine = firmware.machine(Unwired)?;
    let started = Instant::now();
    machine.run_until(BUSY)?;
    Ok(machine.instructions() as f64 / started.elapsed().as_secs_f64() / 1e6)
}

/// Seconds of the default flight in one of ours: on the emulated board if there is an image, else on
/// the native one. Building world and board is part of it.
///
/// # Errors
/// [`FlightError`] where it cannot be flown.
pub fn realtime_factor(elf: Option<&[u8]>) -> Result<f64, FlightError> {
    let scenario = Scenario {
        route: Route::default(),
        world: "arena-panels".to_owned(),
        seed: 1,
        spacing: Spacing::DEFAULT,
        storage: Storage::PAPER,
        homing: Homing::default(),
        conditions: Conditions::default(),
    };
    let flown = match elf {
        Some(elf) => flight::fly_emulated_alone(&scenario, elf, &mut |_| {}),
        None => flight::fly_native(&scenario, &mut |_| {}),
    }?;
    Ok(flown.summary.realtime_factor)
}
