//! How far dead reckoning strays, over few seeds: `hil drift` flies the many.

use fake_sensors::motion::{FlowModel, ImuModel, RangeModel, SensorModel};
use hil::drift::{Row, fly, rows, verdict};

fn drift(model: &SensorModel, seeds: u64, distances_m: &[f64]) -> Vec<Row> {
    let flights: Vec<_> = (1..=seeds)
        .map(|seed| fly(model, seed, distances_m))
        .collect();
    rows(distances_m, &flights)
}

/// Whether an RMS over so many seeds is the expected one, within 25 % or four standard errors.
fn near(found: f64, expected: f64, seeds: u64) -> bool {
    let chance = 4.0 / (2.0 * seeds as f64).sqrt();
    (found / expected - 1.0).abs() <= chance.max(0.25)
}

#[test]
fn the_nominal_sensors_drift_as_the_firmwares_filter_does() {
    let rows = drift(&SensorModel::default(), 60, &[1.0, 2.0, 5.0]);
    assert!(verdict(&rows), "{rows:?}");
}

#[test]
fn each_error_by_itself_drifts_as_it_does_in_the_firmwares_filter() {
    const SEEDS: u64 = 30;
    let ideal = SensorModel::ideal();
    let flow = |flow: FlowModel| SensorModel { flow, ..ideal };
    let flow_noise = flow(FlowModel {
        noise_counts: 2.0,
        ..ideal.flow
    });
    let flow_scale = flow(FlowModel {
        scale_sd: 0.05,
        ..ideal.flow
    });
    let flow_yaw = flow(FlowModel {
        mounting_yaw_sd_rad: 1_f64.to_radians(),
        ..ideal.flow
    });
    let gyro_bias = SensorModel {
        imu: ImuModel {
            gyro_bias_sd_deg_s: 0.1,
            ..ideal.imu
        },
        ..ideal
    };
    let range_offset = SensorModel {
        range: RangeModel {
            offset_sd_m: 0.01,
            ..ideal.range
        },
        ..ideal
    };
    // Firmware's filter, 50 seeds, at 5 m: RMS across or along, metres.
    type Of = fn(&Row) -> f64;
    let cross: Of = |row| row.cross_rms_m;
    let along: Of = |row| row.along_rms_m;
    for (name, model, of, expected) in [
        ("flow noise, across", flow_noise, cross, 0.061),
        ("flow noise, along", flow_noise, along, 0.073),
        ("gyro bias, across", gyro_bias, cross, 0.090),
        ("flow yaw, across", flow_yaw, cross, 0.072),
        ("flow scale, along", flow_scale, along, 0.246),
        ("range offset, along", range_offset, along, 0.112),
    ] {
        let found = of(&drift(&model, SEEDS, &[5.0])[0]);
        assert!(
            near(found, expected, SEEDS),
            "{name}: {found} m, not {expected}"
        );
    }
}

#[test]
fn a_seed_drifts_the_same_wherever_its_flight_is_looked_at() {
    let model = SensorModel::default();
    let [_, at_two] = fly(&model, 3, &[1.0, 2.0])[..] else {
        panic!("two distances")
    };
    assert_eq!(fly(&model, 3, &[2.0]), [at_two]);
    assert_ne!(fly(&model, 4, &[2.0]), [at_two]);
}
