//! What a frame costs the core, stage by stage: the flight's own code on the emulated Cortex-M4 with
//! the flash and the wait states of the flight. And that it sees there what it sees here, to the bit.
//!
//! The table is printed with `cargo test --test cycles vision -- --nocapture`.

mod bench;
mod sights;

use bench::{Bench, Outcome, RESULT_WORDS, STAGES};
use nav::homing::{FLAT_WEIGHTS, align128, home};
use nav::{HomingParameters, PanoramaMap, Snapshot, Spectrum};
use pilot::{FRAME_LAYOUT, Frame, Parameters};
use sights::Sight;
use tests::Budgets;

/// What the same code makes of a sight here: the words of the image's `RESULT`.
fn words(map: &PanoramaMap, sight: &Sight, snapshot: &Snapshot) -> [u32; RESULT_WORDS] {
    let view = Spectrum::of(&map.horizon(&sight.frame[..], sight.heading));
    let rotation = align128(&view, &snapshot.dequantise(), &FLAT_WEIGHTS);
    let vector = home(&view, snapshot, &HomingParameters::DEFAULT);
    let vector = vector.map_or([0.0; 4], |vector| {
        let [x, y] = vector.displacement.into();
        [x, y, vector.rotation, vector.difference]
    });
    let parts = view.coefficients().iter().flat_map(|c| [c.re, c.im]);
    let mut words = parts
        .map(f32::to_bits)
        .chain([u32::from(rotation)])
        .chain(vector.map(f32::to_bits));
    std::array::from_fn(|_| words.next().expect("as many as the image has"))
}

/// The budget of a stage: cycles of its dearest call.
fn budget(stage: &str) -> String {
    format!("vision_{stage}_cycles")
}

#[test]
fn each_stage_of_vision_keeps_its_budget_and_sees_what_it_sees_on_the_host() {
    let budgets = Budgets::load();
    let mut bench = Bench::boot();
    let map = PanoramaMap::new(&Parameters::DEFAULT.lens, &FRAME_LAYOUT).expect("a lens");
    let there: Frame = *sights::arena_from_the_middle();
    let snapshot = Snapshot::quantise(&Spectrum::of(&map.horizon(&there[..], 0.0)));
    let mut worst = [0; STAGES.len()];
    for sight in sights::all() {
        let Outcome {
            words: seen,
            cycles,
        } = bench.see(&sight.frame, sight.heading, &snapshot);
        assert_eq!(seen, words(&map, &sight, &snapshot), "{}", sight.name);
        for (worst, stage) in worst.iter_mut().zip(STAGES) {
            let of_stage = cycles.iter().filter(|(name, _)| *name == stage);
            *worst = of_stage.map(|(_, cycles)| *cycles).fold(*worst, u64::max);
        }
    }
    for (stage, cycles) in STAGES.iter().zip(worst) {
        println!("{stage:<14}{cycles:>8} cycles at most");
    }
    for (stage, cycles) in STAGES.iter().zip(worst) {
        budgets.hold(&budget(stage), cycles as f64);
    }
}
