//! The paper's claims that can be checked, and those that take no flight of the whole drone.

use autopilot::vehicle::PAPER_MASS_KG;
use emulator::memory::{CCM_BYTES, SRAM_BYTES};
use fake_sensors::motion::SensorModel;

use super::{Row, drift_model, measured};
use crate::drift;
use crate::homing_test::{self, Verdict};
use crate::parallel;

/// Results and simulations of the paper by number (van Dijk et al. 2024, in the order of its text); the others are
/// definitions.
pub const CHECKABLE: [(u8, &str); 18] = [
    (1, "mass of the drone"),
    (2, "longest route, memory per metre"),
    (3, "RAM of the microcontroller"),
    (20, "largest catchment below 32 B: Fourier"),
    (21, "largest catchment per byte: Fourier, small"),
    (22, "Newton's descent makes little difference"),
    (23, "five components suffice, 10 B"),
    (24, "homing to one snapshot from 2 m (Fig. 4)"),
    (26, "odometry, cross-track after 5 m (Fig. 5B)"),
    (27, "odometry, cross-track beyond along-track (Fig. 5A)"),
    (28, "drift model, cross-track after 5 m"),
    (29, "back and forth, 100 m (Fig. 5C, D)"),
    (30, "length of the S (Fig. 6A)"),
    (31, "the U: length, snapshots, memory (Fig. 6B)"),
    (33, "sequence of snapshots, 0.25 m and 1 m apart (Fig. 6C)"),
    (34, "300 m through a forest (Fig. S2)"),
    (35, "catchment proportional to the surroundings"),
    (36, "spacing of steering teach and repeat"),
];

/// The name of a claim.
pub fn what(claim: u8) -> &'static str {
    let known = CHECKABLE.iter().find(|(number, _)| *number == claim);
    known.map_or("", |(_, what)| what)
}

/// Something that is measured without flying a scenario.
#[derive(Clone, Copy, Debug)]
pub struct Computed {
    /// Its name.
    pub name: &'static str,
    /// Measures it, over so many seeds where there is chance in it.
    pub rows: fn(seeds: u64) -> Vec<Row>,
}

/// All of them.
pub const COMPUTED: [Computed; 5] = [
    Computed {
        name: "board",
        rows: board,
    },
    Computed {
        name: "drift",
        rows: odometry,
    },
    Computed {
        name: "drift-model",
        rows: model,
    },
    Computed {
        name: "homing-test",
        rows: homing,
    },
    Computed {
        name: "elsewhere",
        rows: elsewhere,
    },
];

/// What drone and board are.
fn board(_: u64) -> Vec<Row> {
    let grams = 1_000.0 * PAPER_MASS_KG;
    let ram = SRAM_BYTES + CCM_BYTES;
    vec![
        measured(
            1,
            "56 g",
            (grams, format!("{grams:.0} g, the emulated drone")),
            &(55.9..=56.1),
            0,
        ),
        measured(
            3,
            "192 kB",
            (ram as f64, format!("{} KiB, the emulated chip", ram >> 10)),
            &(196_608.0..=196_608.0),
            0,
        ),
    ]
}

/// How far dead reckoning strays on a leg of 5 m.
fn odometry(seeds: u64) -> Vec<Row> {
    const LEG_M: f64 = 5.0;
    let model = SensorModel::default();
    let all: Vec<u64> = (1..=seeds).collect();
    let flights = parallel::map(&all, |seed| drift::fly(&model, *seed, &[LEG_M]), |_| ());
    let rows = drift::rows(&[LEG_M], &flights);
    let [row] = rows.as_slice() else {
        return Vec::new();
    };
    let (cross, along) = (100.0 * row.cross_rms_m, 100.0 * row.along_rms_m);
    // Over few seeds, an RMS is only known so well.
    let chance = 13.0 * (3.0 / (2.0 * seeds as f64).sqrt()).max(2.0 / 13.0);
    let along_text =
        format!("{cross:.1} cm across, {along:.1} cm along: the flow sensor's scale error leads");
    vec![
        measured(
            26,
            "13 cm",
            (cross, format!("{cross:.1} cm")),
            &(13.0 - chance..=13.0 + chance),
            row.seeds,
        ),
        measured(
            27,
            "cross > along at the end of a leg",
            (cross / along, along_text),
            &(1.0..=f64::INFINITY),
            row.seeds,
        ),
    ]
}

/// The paper's simulation of drift, with as many runs as its reference had.
fn model(_: u64) -> Vec<Row> {
    const RUNS: u32 = 200_000;
    /// The row of 5 m.
    const LEG: usize = 4;
    let found = drift_model::run(RUNS, 1);
    let (ours, reference) = (&found[LEG], &drift_model::REFERENCE[LEG]);
    vec![Row {
        claim: Some(28),
        what: what(28).to_owned(),
        paper: format!(
            "{:.3} m (its parameters, another implementation)",
            reference.cross_rms_m
        ),
        ours: format!(
            "{:.3} m; along {:.3} m ({:.3} m)",
            ours.cross_rms_m, ours.along_rms_m, reference.along_rms_m
        ),
        seeds: RUNS as usize,
        kept: Some(drift_model::agrees(&found, RUNS)),
    }]
}

/// Homing to one snapshot from nine starts (`hil homing-test`).
fn homing(seeds: u64) -> Vec<Row> {
    /// More say no more, and take minutes.
    const MOST_SEEDS: u64 = 20;
    let seeds = seeds.min(MOST_SEEDS);
    let (share, ours) = match homing_test::fly_all("arena", 1..=seeds, |_| ()) {
        Ok(runs) => {
            let verdict = Verdict::on(&runs);
            let share = verdict.home as f64 / verdict.runs as f64;
            let ours = format!(
                "{} of {} within 0.5 m, at least {} of 9 on a seed",
                verdict.home, verdict.runs, verdict.fewest
            );
            (share, ours)
        }
        Err(error) => (0.0, format!("could not be flown: {error}")),
    };
    let paper = 8.0 / 9.0;
    vec![measured(
        24,
        "8 of 9 runs within 0.5 m",
        (share, ours),
        &(paper..=1.0),
        seeds as usize,
    )]
}

/// What another command measures, and what nobody here can.
fn elsewhere(_: u64) -> Vec<Row> {
    let surveyed = "a survey: `hil catchment`, tables in docs/homing-lab.md";
    let rows = [
        (20, "Fourier below 32 B", surveyed),
        (21, "Fourier, at small sizes", surveyed),
        (22, "little difference", surveyed),
        (23, "10 B", surveyed),
        (35, "proportional", surveyed),
        (
            36,
            "0.35 m",
            "quoted from another study: nothing of it is here",
        ),
    ];
    let row = |(claim, paper, why): (u8, &str, &str)| Row {
        claim: Some(claim),
        what: what(claim).to_owned(),
        paper: paper.to_owned(),
        ours: why.to_owned(),
        seeds: 0,
        kept: None,
    };
    rows.map(row).to_vec()
}
