//! The capture by itself: how to use it, and what becomes of slow readers, of futures that are
//! dropped and of the capture when it is.
//!
//! The camera on the port must be sending already, 25 frames a second or more. Each step tells its
//! outcome in the log.
#![no_std]
#![no_main]

#[path = "../src/capture/mod.rs"]
mod capture;
#[expect(
    dead_code,
    reason = "the flight image measures cycles, this one does not"
)]
#[path = "../src/clocks.rs"]
mod clocks;

use capture::{Capture, Frame, Port};
use defmt_rtt as _;
use embassy_executor::Spawner;
use embassy_futures::select::{Either, select};
use embassy_stm32::{Peripherals, bind_interrupts};
use embassy_time::{Duration, Instant, Timer, block_for};
use panic_probe as _;

bind_interrupts!(
    struct Irqs {
        DCMI => capture::InterruptHandler;
        DMA2_STREAM1 => capture::DmaInterruptHandler;
    }
);

/// Half the time of a frame, and the time of more than two.
const HALF_A_FRAME: Duration = Duration::from_millis(20);
const FRAMES: Duration = Duration::from_millis(100);

#[embassy_executor::main]
async fn main(_spawner: Spawner) {
    let mut capture = Capture::start(port(embassy_stm32::init(clocks::config())));
    capture.expect_signal(Instant::now() + FRAMES);

    read(next(&mut capture).await, "quick", Duration::from_ticks(0));
    read(next(&mut capture).await, "steady", HALF_A_FRAME);
    read(next(&mut capture).await, "slow", FRAMES);
    let frame = next(&mut capture).await;
    defmt::info!("missed {=bool}", frame.missed() > 0);

    let before = frame.number();
    match select(capture.next(), Timer::after(Duration::from_millis(1))).await {
        Either::First(_) => defmt::info!("nothing to cancel"),
        Either::Second(()) => {
            let after = next(&mut capture).await.number();
            defmt::info!("cancelled, then the next {=bool}", after == before + 1);
        }
    }

    capture.expect_silence();
    // In the middle of a frame.
    Timer::after(HALF_A_FRAME).await;
    drop(capture);
    defmt::info!("dropped");
    Timer::after(FRAMES).await;
    defmt::info!("still");

    // SAFETY: the capture that had the peripherals is gone.
    let mut capture = Capture::start(port(unsafe { Peripherals::steal() }));
    capture.expect_signal(Instant::now() + FRAMES);
    read(next(&mut capture).await, "again", HALF_A_FRAME);
    loop {
        next(&mut capture).await;
    }
}

/// The pins of the flight board.
fn port(p: Peripherals) -> Port {
    let pins = [
        capture::pin(p.PC6),
        capture::pin(p.PC7),
        capture::pin(p.PC8),
        capture::pin(p.PC9),
        capture::pin(p.PC11),
        capture::pin(p.PB6),
        capture::pin(p.PB8),
        capture::pin(p.PB9),
        capture::pin(p.PB7),
        capture::pin(p.PA4),
        capture::pin(p.PA6),
    ];
    Port::new(p.DCMI, p.DMA2_CH1, pins)
}

/// The next frame, whatever faults come before it.
async fn next(capture: &mut Capture) -> Frame {
    loop {
        match capture.next().await {
            Ok(frame) => return frame,
            Err(fault) => defmt::warn!("capture fault {=str}", fault.name()),
        }
    }
}

/// Reads a frame for so long.
fn read(frame: Frame, pace: &str, time: Duration) {
    let newest = frame.is_newest();
    let (changed, integrity) = frame.read(|bytes| {
        let before = checksum(bytes);
        block_for(time);
        checksum(bytes) != before
    });
    let intact = integrity == capture::Integrity::Intact;
    defmt::info!(
        "{=str}: newest {=bool}, changed {=bool}, intact {=bool}",
        pace,
        newest,
        changed,
        intact
    );
}

/// Fletcher's, over bytes that the DMA may be writing to: read one by one, as they are in memory.
fn checksum(bytes: &[u8]) -> (u32, u32) {
    bytes.iter().fold((0, 0), |(sum, sums), byte| {
        // SAFETY: a reference is valid for reads.
        let byte = u32::from(unsafe { core::ptr::from_ref(byte).read_volatile() });
        let sum = (sum + byte) % 65_521;
        (sum, (sums + sum) % 65_521)
    })
}
