//! What is measured without flying a scenario: the list of it, and the shorter measurements.

use autopilot::vehicle::PAPER_MASS_KG;
use emulator::memory::{CCM_BYTES, SRAM_BYTES};
use fake_sensors::motion::SensorModel;

use super::claims::what;
use super::{ExperimentError, Row, catchments, drift_model, measured, moved_objects, scaling};
use crate::drift;
use crate::homing_test::{self, Verdict};
use crate::parallel;

/// Seeds of the odometry, where nothing is said.
const DRIFT_SEEDS: u64 = 200;
/// Seeds of Fig. 4, nine runs each: where nothing is said, and at most. More take minutes and tell
/// nothing new.
const HOMING_SEEDS: u64 = 20;
/// The paper's cross-track error of odometry after 5 m (Fig. 5B), centimetres.
const PAPER_CROSS_TRACK_CM: f64 = 13.0;
/// How far off it ours may be over many seeds, centimetres: as `hil drift` has it.
const CROSS_TRACK_MARGIN_CM: f64 = 2.0;

/// How much of a measurement is wanted, and who hears how far it has come.
pub struct Order<'o> {
    /// How many seeds, or snapshots of each room; as many as the measurement deems enough if nothing is said.
    pub seeds: Option<u64>,
    /// Hears the share that is done, 0..=1.
    pub progress: &'o mut dyn FnMut(f64),
}

/// Something that is measured without flying a scenario.
#[derive(Clone, Copy, Debug)]
pub struct Computed {
    /// Its name.
    pub name: &'static str,
    /// The claims that its rows are about; none where they go beyond the paper's numbers.
    pub claims: &'static [u8],
    /// Measures it.
    pub rows: fn(&mut Order<'_>) -> Result<Vec<Row>, ExperimentError>,
}

/// All of them, the quick ones first.
pub const COMPUTED: [Computed; 8] = [
    Computed {
        name: "board",
        claims: &[1, 3],
        rows: board,
    },
    Computed {
        name: "elsewhere",
        claims: &[36],
        rows: elsewhere,
    },
    Computed {
        name: "drift-model",
        claims: &[28],
        rows: model,
    },
    Computed {
        name: "drift",
        claims: &[26, 27],
        rows: odometry,
    },
    Computed {
        name: "moved-objects",
        claims: &[],
        rows: moved_objects::rows,
    },
    Computed {
        name: "scaling",
        claims: &[35],
        rows: scaling::rows,
    },
    Computed {
        name: "catchment",
        claims: &[20, 21, 22, 23],
        rows: catchments::rows,
    },
    Computed {
        name: "homing-test",
        claims: &[24],
        rows: homing,
    },
];

/// Claims 1 and 3: what drone and board are.
fn board(_: &mut Order<'_>) -> Result<Vec<Row>, ExperimentError> {
    let grams = 1_000.0 * PAPER_MASS_KG;
    let ram = SRAM_BYTES + CCM_BYTES;
    Ok(vec![
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
    ])
}

/// Claim 36: what cannot be measured here.
fn elsewhere(_: &mut Order<'_>) -> Result<Vec<Row>, ExperimentError> {
    Ok(vec![Row {
        kept: None,
        ..Row::of(
            what(36),
            "0.35 m",
            "quoted from another study: nothing of it is here",
        )
        .about(36)
    }])
}

/// Claim 28: the paper's simulation of drift, with as many runs as its reference had.
fn model(_: &mut Order<'_>) -> Result<Vec<Row>, ExperimentError> {
    const RUNS: u32 = 200_000;
    /// The row of 5 m.
    const LEG: usize = 4;
    let found = drift_model::run(RUNS, 1);
    let (ours, reference) = (&found[LEG], &drift_model::REFERENCE[LEG]);
    Ok(vec![Row {
        seeds: RUNS as usize,
        kept: Some(drift_model::agrees(&found, RUNS)),
        ..Row::of(
            what(28),
            format!(
                "{:.3} m (its parameters, another implementation)",
                reference.cross_rms_m
            ),
            format!(
                "{:.3} m; along {:.3} m ({:.3} m)",
                ours.cross_rms_m, ours.along_rms_m, reference.along_rms_m
            ),
        )
        .about(28)
    }])
}

/// Claims 26 and 27: how far dead reckoning strays on a leg of 5 m.
fn odometry(order: &mut Order<'_>) -> Result<Vec<Row>, ExperimentError> {
    const LEG_M: f64 = 5.0;
    let seeds = order.seeds.unwrap_or(DRIFT_SEEDS);
    let model = SensorModel::default();
    let all: Vec<u64> = (1..=seeds).collect();
    let fly = |seed: &u64| drift::fly(&model, *seed, &[LEG_M]);
    let flights = parallel::map(&all, fly, |done| {
        (order.progress)(done as f64 / seeds as f64);
    });
    let rows = drift::rows(&[LEG_M], &flights);
    let [row] = rows.as_slice() else {
        return Ok(Vec::new());
    };
    let (cross, along) = (100.0 * row.cross_rms_m, 100.0 * row.along_rms_m);
    // The relative standard error of an RMS over n seeds is 1 / √(2n): over few seeds, three of those.
    let chance_cm = 3.0 * PAPER_CROSS_TRACK_CM / (2.0 * seeds as f64).sqrt();
    let margin_cm = chance_cm.max(CROSS_TRACK_MARGIN_CM);
    let along_text =
        format!("{cross:.1} cm across, {along:.1} cm along: the flow sensor's scale error leads");
    Ok(vec![
        measured(
            26,
            "13 cm",
            (cross, format!("{cross:.1} cm")),
            &(PAPER_CROSS_TRACK_CM - margin_cm..=PAPER_CROSS_TRACK_CM + margin_cm),
            row.seeds,
        ),
        measured(
            27,
            "cross > along at the end of a leg",
            (cross / along, along_text),
            &(1.0..=f64::INFINITY),
            row.seeds,
        ),
    ])
}

/// Claim 24: homing to one snapshot from nine starts (`hil homing-test`).
fn homing(order: &mut Order<'_>) -> Result<Vec<Row>, ExperimentError> {
    let seeds = order.seeds.unwrap_or(HOMING_SEEDS).min(HOMING_SEEDS);
    let total = (seeds as usize * homing_test::STARTS) as f64;
    let runs = homing_test::fly_all("arena", 1..=seeds, |done| {
        (order.progress)(done as f64 / total);
    })?;
    let verdict = Verdict::on(&runs);
    let ours = format!(
        "{} of {} within 0.5 m, at least {} of 9 on a seed",
        verdict.home, verdict.runs, verdict.fewest
    );
    Ok(vec![measured(
        24,
        "8 of 9 runs within 0.5 m",
        (verdict.home as f64 / verdict.runs as f64, ours),
        &(8.0 / 9.0..=1.0),
        seeds as usize,
    )])
}
