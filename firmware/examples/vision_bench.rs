//! What each stage of vision costs on the core that flies.
//!
//! The stages of the flight image and nothing else, with its flash and wait states. A debug probe (or
//! the emulator) writes a frame into [`FRAME`], a heading into [`HEADING`] (the bits of an f32) and a
//! snapshot into [`SNAPSHOT`], and one into [`GO`], which becomes zero when all stages have run. The
//! time of a stage is that between entry and return of its function here; what came out lies in
//! [`RESULT`], so that it can be held against the same stages on another machine.
#![no_std]
#![no_main]

#[path = "common/flight_flash.rs"]
mod flight_flash;

use core::hint::black_box;
use core::sync::atomic::{AtomicI8, AtomicU8, AtomicU32, Ordering};

use cortex_m::asm;
use defmt_rtt as _;
use nav::homing::{self, FLAT_WEIGHTS, ImageDifference};
use nav::snapshot::SNAPSHOT_BYTES;
use nav::spectrum::StoredCoefficients;
use nav::{
    HomingParameters, HomingVector, Horizon, NoVectorReason, PanoramaMap, Snapshot, Spectrum,
};
use panic_probe as _;
use pilot::{FRAME_LAYOUT, Frame, FrameReport, Parameters, Pilot};
use static_cell::StaticCell;

/// The frame to look at.
#[unsafe(no_mangle)]
static FRAME: [AtomicU8; FRAME_LAYOUT.bytes()] = [const { AtomicU8::new(0) }; FRAME_LAYOUT.bytes()];

/// The heading at which it was taken, radians: the bits of an f32.
#[unsafe(no_mangle)]
static HEADING: AtomicU32 = AtomicU32::new(0);

/// The snapshot to compare it with.
#[unsafe(no_mangle)]
static SNAPSHOT: [AtomicI8; SNAPSHOT_BYTES] = [const { AtomicI8::new(0) }; SNAPSHOT_BYTES];

/// Not zero: run.
#[unsafe(no_mangle)]
static GO: AtomicU32 = AtomicU32::new(0);

/// What came out, as bits: nine coefficients, real before imaginary part; the best of all rotations;
/// x, y, rotation and difference of the homing vector, zeros where there is none.
#[unsafe(no_mangle)]
static RESULT: [AtomicU32; 23] = [const { AtomicU32::new(0) }; 23];

#[cortex_m_rt::entry]
fn main() -> ! {
    flight_flash::set_up();
    // In SRAM, as in flight.
    static BYTES: StaticCell<Frame> = StaticCell::new();
    static MAP: StaticCell<PanoramaMap> = StaticCell::new();
    static PILOT: StaticCell<Pilot> = StaticCell::new();
    let frame = BYTES.init_with(|| [0; FRAME_LAYOUT.bytes()]);
    let map = MAP.init_with(map);
    let pilot = PILOT.init_with(pilot);
    loop {
        if GO.load(Ordering::Acquire) == 0 {
            asm::nop();
            continue;
        }
        for (byte, source) in frame.iter_mut().zip(&FRAME) {
            *byte = source.load(Ordering::Relaxed);
        }
        see(map, frame);
        *pilot = self::pilot();
        look(pilot, frame);
        GO.store(0, Ordering::Release);
    }
}

fn map() -> PanoramaMap {
    defmt::unwrap!(PanoramaMap::new(&Parameters::DEFAULT.lens, &FRAME_LAYOUT).ok())
}

fn pilot() -> Pilot {
    defmt::unwrap!(Pilot::new(&Parameters::DEFAULT).ok())
}

/// From the frame to the homing vector, stage by stage.
fn see(map: &PanoramaMap, frame: &Frame) {
    let heading = f32::from_bits(HEADING.load(Ordering::Relaxed));
    let snapshot = Snapshot(core::array::from_fn(|n| {
        SNAPSHOT[n].load(Ordering::Relaxed)
    }));
    let (horizon, _) = unwrap(map, frame, heading);
    let view = spectrum(&horizon);
    black_box(quantise(&view));
    let mut stored = snapshot.dequantise();
    let rotation = align_all(&view, &stored);
    let steps = align(&view, &stored);
    nav::spectrum::rotate(
        &mut stored,
        -f32::from(steps) * nav::horizon::BEARING_STEP_RAD,
    );
    let _ = black_box(solve(&view, &stored));
    let vector = home(&view, &snapshot);

    let parts = view.coefficients().iter().flat_map(|c| [c.re, c.im]);
    let vector = vector.map_or([0.0; 4], |vector| {
        let [x, y] = vector.displacement.into();
        [x, y, vector.rotation, vector.difference]
    });
    let words = parts
        .map(f32::to_bits)
        .chain([u32::from(rotation)])
        .chain(vector.map(f32::to_bits));
    for (place, word) in RESULT.iter().zip(words) {
        place.store(word, Ordering::Relaxed);
    }
}

/// A pilot's first two frames. The first decides on an exposure; the second waits for it to show, and
/// costs what nearly all of a flight's cost.
fn look(pilot: &mut Pilot, frame: &Frame) {
    black_box(whole_frame(pilot, frame));
    black_box(whole_frame(pilot, frame));
}

#[unsafe(no_mangle)]
#[inline(never)]
fn unwrap(map: &PanoramaMap, frame: &Frame, heading: f32) -> (Horizon, f32) {
    map.horizon_and_band(frame, heading)
}

#[unsafe(no_mangle)]
#[inline(never)]
fn spectrum(horizon: &Horizon) -> Spectrum {
    Spectrum::of(horizon)
}

#[unsafe(no_mangle)]
#[inline(never)]
fn quantise(view: &Spectrum) -> Snapshot {
    Snapshot::quantise(view)
}

#[unsafe(no_mangle)]
#[inline(never)]
fn align_all(view: &Spectrum, stored: &StoredCoefficients) -> u8 {
    homing::align128(view, stored, &FLAT_WEIGHTS)
}

#[unsafe(no_mangle)]
#[inline(never)]
fn align(view: &Spectrum, stored: &StoredCoefficients) -> i8 {
    let bound = HomingParameters::DEFAULT.rotation_bound;
    homing::align_within(view, stored, &FLAT_WEIGHTS, bound)
}

#[unsafe(no_mangle)]
#[inline(never)]
fn solve(
    view: &Spectrum,
    stored: &StoredCoefficients,
) -> Result<nalgebra::Vector3<f32>, NoVectorReason> {
    ImageDifference::between(view, stored, &FLAT_WEIGHTS).minimum()
}

#[unsafe(no_mangle)]
#[inline(never)]
fn home(view: &Spectrum, snapshot: &Snapshot) -> Result<HomingVector, NoVectorReason> {
    homing::home(view, snapshot, &HomingParameters::DEFAULT)
}

#[unsafe(no_mangle)]
#[inline(never)]
fn whole_frame(pilot: &mut Pilot, frame: &Frame) -> FrameReport {
    pilot.on_frame(frame)
}
