//! The speed of the rig: the busy core, and a flight on either board.
//!
//!     cargo bench -p hil --bench rig
//!
//! The rates are instructions, and milliseconds of flight, a second.

use std::time::Duration;

use criterion::{Criterion, SamplingMode, Throughput};
use emulator::time::Nanos;
use emulator::wiring::Unwired;
use hil::bench::EXAMPLE;
use hil::board::emulated::Firmware;
use hil::scenario::{Conditions, Homing, Route, Scenario, Spacing, Storage};
use hil::{flight, image};

/// Of the busy core's time, 16 million cycles a second.
const SLICE: Nanos = Nanos::from_millis(100);

fn busy(criterion: &mut Criterion) {
    let elf = image::build_example(EXAMPLE, &|line| eprintln!("{line}")).expect("it builds");
    let elf = std::fs::read(elf).expect("the image");
    let firmware = Firmware::parse(&elf).expect("an image");
    let mut machine = firmware.machine(Unwired).expect("a chip");
    let mut slice = || {
        let before = machine.instructions();
        let until = machine.now() + SLICE;
        machine.run_until(until).expect("a run without end");
        machine.instructions() - before
    };
    // Slices differ by the little that one passes its end.
    let instructions = slice();
    let mut group = criterion.benchmark_group("core");
    group.throughput(Throughput::Elements(instructions));
    group.bench_function("busy", |bencher| bencher.iter(&mut slice));
    group.finish();
}

fn flights(criterion: &mut Criterion) {
    let elf = image::build(&|line| eprintln!("{line}")).expect("it builds");
    let elf = std::fs::read(elf).expect("the image");
    let corner = Scenario {
        route: Route::Corner,
        world: "arena-panels".to_owned(),
        seed: 1,
        spacing: Spacing::DEFAULT,
        storage: Storage::PAPER,
        homing: Homing::default(),
        conditions: Conditions::default(),
    };
    let native = || flight::fly_native(&corner, &mut |_| {}).expect("a flight");
    let emulated = || flight::fly_emulated(&corner, &elf, &mut |_| {}).expect("a flight");
    let flown_ms = native().summary.flight_s * 1_000.0;
    let mut group = criterion.benchmark_group("flight");
    group
        .sampling_mode(SamplingMode::Flat)
        .sample_size(10)
        .measurement_time(Duration::from_secs(20))
        .throughput(Throughput::Elements(flown_ms as u64));
    group.bench_function("native", |bencher| bencher.iter(native));
    group.bench_function("emulated", |bencher| bencher.iter(emulated));
    group.finish();
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    busy(&mut criterion);
    flights(&mut criterion);
    criterion.final_summary();
}
