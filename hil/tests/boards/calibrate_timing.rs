//! The kernels on the emulated core, and held against the log of a board. The image is built first.

use std::fs;
use std::process::Command;
use std::sync::OnceLock;

use emulator::soc::FlashAssumption;
use hil::board::timing::TimingModel;
use hil::calibrate_timing::{self, Comparison, EXAMPLE, NOTHING, Timing};
use hil::image;

fn timings() -> &'static [Timing] {
    static TIMINGS: OnceLock<Vec<Timing>> = OnceLock::new();
    TIMINGS.get_or_init(|| assuming(TimingModel::default()))
}

fn assuming(model: TimingModel) -> Vec<Timing> {
    static ELF: OnceLock<Vec<u8>> = OnceLock::new();
    let elf = ELF.get_or_init(|| {
        let elf = image::build_example(EXAMPLE, &|line| eprintln!("{line}"));
        fs::read(elf.expect("the example builds")).expect("the image is there")
    });
    calibrate_timing::emulate(elf, model).expect("kernels that end")
}

fn with_flash(flash: FlashAssumption) -> Vec<Timing> {
    assuming(TimingModel {
        flash,
        ..TimingModel::default()
    })
}

fn round(name: &str) -> Vec<&'static Timing> {
    let timings = timings().iter();
    timings.filter(|timing| timing.round == name).collect()
}

/// ARM DDI0439 §3.3 and table 7-1: instructions whose cost depends on nothing, in kernels that fit
/// the instruction cache.
#[test]
fn an_instruction_costs_what_the_manual_says() {
    let comparison = Comparison::modelled(timings().to_vec());
    let find = |kernel: &str| {
        let pairs = comparison.kernels.iter();
        let mut found = pairs.filter(|pair| pair.modelled.kernel == kernel);
        found.next().expect("a kernel of this name")
    };
    let nothing = find(NOTHING).modelled.then;
    for (kernel, cycles) in [
        ("branch not taken", 1.0),
        ("it and one conditional", 2.0),
        ("str, in a row", 1.0),
        ("ldm of four", 5.0),
        ("vadd, independent", 1.0),
        // Fourteen, and one because the next needs the result.
        ("vdiv, each on the last", 15.0),
    ] {
        let modelled = find(kernel).per_item(nothing);
        let share = modelled / cycles;
        assert!((0.95..1.05).contains(&share), "{kernel}: {modelled}");
    }
}

#[test]
fn prefetch_and_caches_never_make_a_kernel_slower() {
    let rounds = ["accelerated", "cached", "bare"].map(round);
    let [accelerated, cached, bare] = &rounds;
    assert!(accelerated.len() > 40);
    assert_eq!(accelerated.len(), cached.len());
    assert_eq!(accelerated.len(), bare.len());
    for ((fast, slow), slowest) in accelerated.iter().zip(cached).zip(bare) {
        assert!(fast.then <= slow.then, "{fast} and {slow}");
        assert!(slow.then <= slowest.then, "{slow} and {slowest}");
    }
}

#[test]
fn no_wait_states_cost_less_than_five_and_more_than_five_cost_more() {
    let all = |wait_states| {
        with_flash(FlashAssumption {
            wait_states: Some(wait_states),
            ..FlashAssumption::default()
        })
    };
    let (none, five, seven) = (all(0), all(5), all(7));
    assert_eq!(five, timings());
    let sum = |timings: &[Timing]| timings.iter().map(|timing| timing.then).sum::<u32>();
    assert!(sum(&none) < sum(&five) && sum(&five) < sum(&seven));
    // A read of a slow bus waits for the bus's clock: what goes before shifts it by less than a period.
    let waits = |timing: &&Timing| timing.kernel.starts_with("read of a register on APB");
    let computes = |timings: Vec<Timing>| timings.into_iter().filter(|timing| !waits(&timing));
    for (none, five) in computes(none).zip(computes(five)) {
        assert!(none.then <= five.then, "{none} and {five}");
    }
}

/// The image programs the bare flash in its last round; the assumption makes every round that one.
#[test]
fn a_flash_without_accelerator_is_the_bare_one_whatever_is_programmed() {
    let assumed = with_flash(FlashAssumption {
        without_accelerator: true,
        ..FlashAssumption::default()
    });
    let of = |name: &str| -> Vec<(&str, u32)> {
        let timings = assumed.iter().filter(|timing| timing.round == name);
        timings
            .map(|timing| (timing.kernel.as_str(), timing.then))
            .collect()
    };
    let bare: Vec<(&str, u32)> = round("bare")
        .into_iter()
        .map(|timing| (timing.kernel.as_str(), timing.then))
        .collect();
    for name in ["accelerated", "cached", "bare"] {
        assert_eq!(of(name), bare, "{name}");
    }
}

/// What a board would have logged that takes `fifths` of the model's cycles, as probe-rs prints it.
fn log_of_a_board(fifths: u32) -> String {
    let line = |timing: &Timing| {
        let Timing {
            round,
            kernel,
            items,
            first,
            then,
        } = timing;
        let then = then * fifths / 5;
        format!(
            "[INFO ] kernel {round} {kernel} items {items} first {first} then {then} (kernels main.rs:91)\n"
        )
    };
    timings().iter().map(line).collect()
}

#[test]
fn a_board_that_is_a_fifth_slower_fails_the_comparison_and_one_that_is_as_fast_holds() {
    let folder = std::env::temp_dir().join(format!("hil-calibrate-timing-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    let compare = |log: &str| {
        timings();
        let path = folder.join("board.log");
        fs::write(&path, log).expect("a log");
        let mut command = Command::new(env!("CARGO_BIN_EXE_hil"));
        let output = command
            .args(["calibrate-timing", "--json", "--board"])
            .arg(&path)
            .output();
        let output = output.expect("the command runs");
        let json = serde_json::from_slice(&output.stdout).unwrap_or(serde_json::Value::Null);
        (output.status.code(), json)
    };
    let (code, json) = compare(&log_of_a_board(6));
    assert_eq!(code, Some(1));
    let worst = json["worst_ratio"].as_f64().expect("a ratio");
    assert!((worst - 5.0 / 6.0).abs() < 0.01, "{worst}");

    assert_eq!(compare(&log_of_a_board(5)).0, Some(0));
    let (code, _) = compare("nothing of the kind");
    assert_eq!(code, Some(2));
    fs::remove_dir_all(folder).expect("the folder is ours");
}
