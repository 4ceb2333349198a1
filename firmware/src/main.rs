//! The camera board's firmware: what runs on the STM32F407.
//!
//! The pure rooms do the thinking: `sensor` knows the camera, `link` the autopilot's language,
//! `pilot` what to do. Here are the pins, the peripherals and the tasks that connect them:
//!
//! ```text
//! DCMI, DMA -> capture -> camera  --+
//!                                   +--> vision (pilot) --> link_tx -> DMA, USART2
//! USART2, DMA -> link_rx -----------+        |
//!                                            +------------> exposure -> I2C2
//! health: the watchdog is fed when all of them live
//! ```
//!
//! In a rig image (cargo feature `rig`) frames may come over USART3 in the camera's place; the task
//! `serial_frames` then stands where `camera` does, and hands on to it while no host asks.
#![no_std]
#![no_main]

mod board;
mod capture;
mod check_in;
mod clocks;
mod counters;
mod executors;
mod identity;
mod lens_page;
mod link_port;
mod log;
mod retained;
mod sensor_power;
#[cfg(feature = "rig")]
mod serial_port;
mod tasks;
mod wires;

use board::Board;
use capture::Capture;
use defmt_rtt as _;
use embassy_executor::Spawner;
use panic_probe as _;
use pilot::{Parameters, Pilot};
use retained::Retained;

/// Sets up the board and starts the tasks. What can fail here fails on every boot of the same
/// image: it is a defect of the build, and panics.
#[embassy_executor::main]
async fn main(spawner: Spawner) {
    let peripherals = embassy_stm32::init(clocks::config());
    clocks::enable_flash_accelerator();
    clocks::enable_cycle_counter();
    log::boot();

    let board = Board::new(peripherals);
    let (tx, rx) = defmt::unwrap!(link_port::open(board.link));
    let parameters = Parameters {
        lens: lens_page::lens(),
        ..Parameters::DEFAULT
    };
    let pilot = match Retained::open(|| Pilot::new(&parameters)) {
        Ok((pilot, kept)) => {
            log::memory(kept);
            pilot
        }
        // Which parameter it is, a test on the host says; to print it here costs 20 KB of flash.
        Err(_) => defmt::panic!("the pilot refuses its parameters"),
    };

    let urgent = executors::start_urgent();
    urgent.spawn(defmt::unwrap!(tasks::link_rx::link_rx(rx)));
    urgent.spawn(defmt::unwrap!(tasks::link_tx::link_tx(tx)));
    urgent.spawn(defmt::unwrap!(tasks::exposure::exposure(
        board.sensor,
        pilot.pilot().exposure()
    )));
    let capture = Capture::start(board.camera);
    #[cfg(not(feature = "rig"))]
    urgent.spawn(defmt::unwrap!(tasks::camera::camera(capture)));
    #[cfg(feature = "rig")]
    urgent.spawn(defmt::unwrap!(tasks::serial_frames::serial_frames(
        capture,
        defmt::unwrap!(serial_port::open(board.serial)),
        pilot.pilot().exposure()
    )));
    spawner.spawn(defmt::unwrap!(tasks::vision::vision(pilot)));
    spawner.spawn(defmt::unwrap!(tasks::health::health(board.watchdog)));
}
