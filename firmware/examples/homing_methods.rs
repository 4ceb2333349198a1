//! What each homing method costs on the core that flies, and what it answers there.
//!
//! Nothing but the methods, on the flash of the flight image and with its wait states. A debug probe
//! (or the emulator) writes a view into [`VIEW`], the view at home into [`GOAL`], both as the bits of
//! floats, and the number of a method and the bytes of its memory into [`METHOD`]; that starts the
//! run. The number becomes zero when the answer stands in [`ANSWER`]; the time is that between entry
//! and return of `see_and_home`.
#![no_std]
#![no_main]

#[path = "common/flight_flash.rs"]
mod flight_flash;

use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::asm;
use defmt_rtt as _;
use nav::NoVectorReason;
use nav::horizon::BEARINGS;
use nav::methods::{
    Fourier, Homeward, HomingMethod, Luma, Memory, Mfdid, Resolution, Search, WarpSearch, presets,
};
use panic_probe as _;
use static_cell::ConstStaticCell;

/// The current view, bits of floats.
#[unsafe(no_mangle)]
static VIEW: [AtomicU32; BEARINGS] = [const { AtomicU32::new(0) }; BEARINGS];

/// The view that is remembered.
#[unsafe(no_mangle)]
static GOAL: [AtomicU32; BEARINGS] = [const { AtomicU32::new(0) }; BEARINGS];

/// 256 times the method's number, from 1, and the bytes of its memory.
#[unsafe(no_mangle)]
static METHOD: AtomicU32 = AtomicU32::new(0);

/// x, y, rotation and quality, bits of floats; all NaN where there is no vector.
#[unsafe(no_mangle)]
static ANSWER: [AtomicU32; 4] = [const { AtomicU32::new(0) }; 4];

/// The tables of the largest fill a fifth of the memory: they have a place of their own.
static WARPS: ConstStaticCell<WarpSearch> = ConstStaticCell::new(WarpSearch::blank());

/// One method at a time.
#[expect(
    clippy::large_enum_variant,
    reason = "one of them, on the stack: there is no heap to put the largest in"
)]
enum Method<'a> {
    Fourier(Fourier),
    Search(Search),
    Mfdid(Mfdid),
    Warp(&'a WarpSearch),
}

impl<'a> Method<'a> {
    #[inline(never)]
    fn numbered(number: u32, bytes: u8, warps: &'a mut WarpSearch) -> Option<Self> {
        Some(match number {
            1 => Self::Fourier(Fourier::new(presets::fourier(bytes))),
            2 => Self::Search(Search::new(presets::search(bytes, Resolution::Memory))),
            3 => Self::Search(Search::new(presets::search(bytes, Resolution::Full))),
            4 => Self::Mfdid(Mfdid::new(presets::mfdid(bytes))),
            5 => {
                warps.adopt(presets::default(bytes, 0));
                Self::Warp(warps)
            }
            _ => return None,
        })
    }

    fn remember(&self, view: &Luma) -> Memory {
        match self {
            Self::Fourier(method) => method.remember(view),
            Self::Search(method) => method.remember(view),
            Self::Mfdid(method) => method.remember(view),
            Self::Warp(method) => method.remember(view),
        }
    }
}

#[cortex_m_rt::entry]
fn main() -> ! {
    flight_flash::set_up();
    let warps = WARPS.take();
    loop {
        let wanted = METHOD.load(Ordering::Acquire);
        if wanted == 0 {
            asm::nop();
            continue;
        }
        let answer = Method::numbered(wanted >> 8, wanted as u8, warps).map(|method| {
            let memory = method.remember(&luma(&GOAL));
            see_and_home(&method, &luma(&VIEW), &memory)
        });
        let numbers = match answer {
            Some(Ok(way)) => [
                way.displacement.x,
                way.displacement.y,
                way.rotation,
                way.quality,
            ],
            Some(Err(_)) | None => [f32::NAN; 4],
        };
        for (place, number) in ANSWER.iter().zip(numbers) {
            place.store(number.to_bits(), Ordering::Relaxed);
        }
        METHOD.store(0, Ordering::Release);
    }
}

fn luma(view: &[AtomicU32; BEARINGS]) -> Luma {
    core::array::from_fn(|n| f32::from_bits(view[n].load(Ordering::Relaxed)))
}

/// All that a frame costs: from the view to the vector.
#[unsafe(no_mangle)]
#[inline(never)]
fn see_and_home(
    method: &Method<'_>,
    view: &Luma,
    memory: &Memory,
) -> Result<Homeward, NoVectorReason> {
    match method {
        Method::Fourier(method) => method.home(&method.see(view), memory),
        Method::Search(method) => method.home(&method.see(view), memory),
        Method::Mfdid(method) => method.home(&method.see(view), memory),
        Method::Warp(method) => method.home(&method.see(view), memory),
    }
}
