//! A fixed set of small computations, timed by the core's own cycle counter: on a board and on the
//! emulator, so that the two can be compared kernel by kernel.
//!
//! Clock, wait states and flash accelerator are the flight image's; a second and a third round leave
//! out what the accelerator does. Every kernel runs with interrupts off, once to warm the caches and
//! once more, and tells its cycles in the log.
#![no_std]
#![no_main]

#[path = "../../src/clocks.rs"]
mod clocks;
mod instructions;
mod library;

use defmt_rtt as _;
use embassy_executor::Spawner;
use embassy_stm32::pac;
use embassy_time::{Duration, Timer};
use panic_probe as _;
use static_cell::ConstStaticCell;

/// One computation.
pub struct Kernel {
    /// What it is called, in the log and in the table.
    name: &'static str,
    /// What it does so many times: instructions, iterations, bytes. A whole is 1.
    items: u32,
    /// The computation.
    run: fn(&mut Scratch),
}

/// Memory that kernels work in: in SRAM, while the stack is core-coupled.
pub struct Scratch {
    words: [u32; WORDS],
    copy: [u32; WORDS],
    samples: [f32; 128],
}

/// Words of each of the scratch areas.
const WORDS: usize = 1024;

static SCRATCH: ConstStaticCell<Scratch> = ConstStaticCell::new(Scratch {
    words: [0x0102_0304; WORDS],
    copy: [0; WORDS],
    samples: [0.0; 128],
});

/// How the flash is read in a round.
struct Round {
    name: &'static str,
    prefetch: bool,
    caches: bool,
}

/// The first is the flight image's.
const ROUNDS: [Round; 3] = [
    Round {
        name: "accelerated",
        prefetch: true,
        caches: true,
    },
    Round {
        name: "cached",
        prefetch: false,
        caches: true,
    },
    Round {
        name: "bare",
        prefetch: false,
        caches: false,
    },
];

/// From a line of the log to the next: a probe that reads slowly loses none.
const PAUSE: Duration = Duration::from_millis(2);

#[embassy_executor::main]
async fn main(_spawner: Spawner) {
    embassy_stm32::init(clocks::config());
    clocks::enable_flash_accelerator();
    clocks::enable_cycle_counter();
    defmt::info!("kernels at {=u32} Hz", clocks::CORE_HZ);
    let scratch = SCRATCH.take();
    for round in &ROUNDS {
        pac::FLASH.acr().modify(|acr| {
            acr.set_prften(round.prefetch);
            acr.set_icen(round.caches);
            acr.set_dcen(round.caches);
        });
        let compiled = library::KERNELS.iter();
        let sets = instructions::KERNELS
            .iter()
            .chain(&instructions::FLASH_KERNELS);
        for kernel in sets.chain(compiled) {
            let [first, then] = time(kernel, scratch);
            Timer::after(PAUSE).await;
            defmt::info!(
                "kernel {=str} {=str} items {=u32} first {=u32} then {=u32}",
                round.name,
                kernel.name,
                kernel.items,
                first,
                then
            );
        }
    }
    defmt::info!("kernels done");
}

/// Cycles of the first and of the second run.
fn time(kernel: &Kernel, scratch: &mut Scratch) -> [u32; 2] {
    [(); 2].map(|()| {
        critical_section::with(|_| {
            let start = clocks::cycles();
            (kernel.run)(scratch);
            clocks::cycles().wrapping_sub(start)
        })
    })
}
