//! What the operator's switches, the drone's health and the two published versions change.

use link::{InsCorrection, Message, Mode, Record, State, WorldPoint};
use nalgebra::Vector3;

use super::{Bench, FIRST_CYCLE_MS, FOLLOW, command, vector};
use crate::app::{
    CorrectionSd, Experiment, Outcome, Output, Phase, Script, Settings, Signals, Step, Until,
};
use crate::controller::SetPoint;
use crate::ekf::{Measurement, Position, YawError};

fn following_with(settings: Settings) -> Bench {
    Bench::new(Script::resume(), settings)
}

/// How a flight ends in which the signals change in the air.
fn ends_with(settings: Settings, signals: Signals) -> Phase {
    let mut bench = following_with(settings);
    bench.run(FIRST_CYCLE_MS + 50);
    bench.app.set_signals(signals);
    bench.run(FIRST_CYCLE_MS + 2_000);
    bench.app.phase()
}

const RADIO_LOST: Signals = Signals {
    radio_up: false,
    ..ALL_WELL
};
const BATTERY_LOW: Signals = Signals {
    battery_low: true,
    ..ALL_WELL
};
const DISABLED: Signals = Signals {
    enabled: false,
    ..ALL_WELL
};
const ALL_WELL: Signals = Signals {
    enabled: true,
    dry_run: false,
    radio_up: true,
    battery_low: false,
};

#[test]
fn a_lost_radio_a_low_battery_and_the_enable_switch_each_land_the_drone() {
    let settings = Settings::default();
    let landed = |outcome| Phase::Landed(outcome);
    assert_eq!(ends_with(settings, RADIO_LOST), landed(Outcome::RadioLost));
    assert_eq!(
        ends_with(settings, BATTERY_LOW),
        landed(Outcome::BatteryLow)
    );
    assert_eq!(
        ends_with(settings, DISABLED),
        landed(Outcome::LandCommanded)
    );
    assert_eq!(ends_with(settings, ALL_WELL), Phase::Following);
}

#[test]
fn the_app_of_2022_watches_neither_radio_nor_battery() {
    let settings = Settings::MASTER_2022_08;
    assert_eq!(ends_with(settings, RADIO_LOST), Phase::Following);
    assert_eq!(ends_with(settings, BATTERY_LOW), Phase::Following);
    assert_eq!(
        ends_with(settings, DISABLED),
        Phase::Landed(Outcome::LandCommanded)
    );
}

#[test]
fn a_danger_lands_in_the_next_cycle_and_is_not_called_off() {
    let mut bench = Bench::following();
    bench.run(FIRST_CYCLE_MS + 50);
    bench.app.set_signals(RADIO_LOST);
    bench.run(FIRST_CYCLE_MS + 99);
    assert_eq!(bench.app.phase(), Phase::Following);
    bench.run(FIRST_CYCLE_MS + 100);
    assert_eq!(bench.app.phase(), Phase::Landing);
    bench.app.set_signals(ALL_WELL);
    bench.run(FIRST_CYCLE_MS + 1_700);
    assert_eq!(bench.app.phase(), Phase::Landed(Outcome::RadioLost));
}

#[test]
fn the_drone_waits_on_the_ground_until_it_is_enabled_and_fit() {
    for unfit in [RADIO_LOST, BATTERY_LOW, DISABLED] {
        let mut bench = Bench::following();
        bench.app.set_signals(unfit);
        bench.run(20_000);
        assert_eq!(bench.app.phase(), Phase::Ground, "{unfit:?}");
        bench.app.set_signals(ALL_WELL);
        bench.tick();
        assert_eq!(bench.app.phase(), Phase::TakeOff);
    }
}

#[test]
fn each_version_has_its_fence() {
    let lands_at = |settings, x| {
        let mut bench = following_with(settings);
        bench.run(FIRST_CYCLE_MS);
        bench.position_m.x = x;
        bench.send(&command(FOLLOW));
        bench.send(&vector(x, 0.0));
        bench.run(FIRST_CYCLE_MS + 1_000);
        bench.app.phase() != Phase::Following
    };
    assert!(!lands_at(Settings::MASTER_2022_08, 3.9));
    assert!(lands_at(Settings::MASTER_2022_08, 4.1));
    assert!(!lands_at(Settings::VISUALHOMING_2023_06, 7.9));
    assert!(lands_at(Settings::VISUALHOMING_2023_06, 8.1));
}

/// What a correction by (1, 0) m and a quarter of a radian becomes.
fn correction_becomes(settings: Settings) -> Vec<Measurement> {
    let mut bench = following_with(settings);
    bench.run(FIRST_CYCLE_MS);
    bench.send(&Message::InsCorrection(InsCorrection {
        snapshot_index: 1,
        n_to: 1.0,
        psi_to: 0.25,
        ..InsCorrection::default()
    }));
    let outputs = (0..200).map(|_| bench.tick());
    outputs.flat_map(|output| output.measurements).collect()
}

fn fix(x: f32, sd: CorrectionSd, error_rad: f32) -> Vec<Measurement> {
    let position = Position {
        position_m: Vector3::new(x, 0.0, 0.5),
        sd_m: sd.position_m,
    };
    let yaw_error = YawError {
        error_rad,
        sd_rad: sd.yaw_rad,
    };
    vec![
        Measurement::Position(position),
        Measurement::YawError(yaw_error),
    ]
}

#[test]
fn corrections_overwrite_in_2023_and_average_with_half_the_turn_in_2022() {
    assert_eq!(
        correction_becomes(Settings::VISUALHOMING_2023_06),
        fix(1.0, CorrectionSd::OVERWRITE, 0.25)
    );
    assert_eq!(
        correction_becomes(Settings::MASTER_2022_08),
        fix(1.0, CorrectionSd::SOFT, 0.125)
    );
}

/// When the filter is told to be at the origin, and when it is reset.
fn zeroings(settings: Settings) -> (Vec<u64>, Option<u64>) {
    let mut bench = following_with(settings);
    bench.position_m = Vector3::new(0.3, -0.2, 0.04);
    let at_origin = Measurement::Position(Position {
        position_m: Vector3::new(0.0, 0.0, 0.04),
        sd_m: 0.001,
    });
    let mut zeroed_ms = Vec::new();
    let mut reset_ms = None;
    while bench.now_ms < FIRST_CYCLE_MS {
        let at_ms = bench.now_ms;
        let Output {
            measurements,
            reset_filter,
            ..
        } = bench.tick();
        for measurement in measurements {
            assert_eq!(measurement, at_origin);
            zeroed_ms.push(at_ms);
        }
        if reset_filter {
            reset_ms = Some(at_ms);
        }
    }
    (zeroed_ms, reset_ms)
}

#[test]
fn on_the_ground_the_filter_is_kept_at_the_origin_until_its_reset_and_not_after() {
    let every_100_ms: Vec<_> = (0..10).map(|cycle| 100 * cycle).collect();
    assert_eq!(
        zeroings(Settings::VISUALHOMING_2023_06),
        (every_100_ms, Some(1_000))
    );
    assert_eq!(zeroings(Settings::MASTER_2022_08), (vec![], Some(1_000)));
}

#[test]
fn a_dry_run_talks_to_the_camera_with_motors_that_stand_still() {
    let mut bench = Bench::new(Script::resume(), Settings::default());
    bench.app.set_signals(Signals {
        enabled: false,
        dry_run: true,
        ..Signals::default()
    });
    // Calibration and reset; there is nothing to climb for.
    bench.run(2_100);
    assert!(matches!(
        bench.sent[..],
        [Message::State(State { .. }), Message::Command(_)]
    ));
    bench.send(&command(FOLLOW));
    bench.send(&vector(1.0, 0.0));
    while bench.now_ms < 10_000 {
        assert_eq!(bench.tick().set_point, SetPoint::MotorsOff);
    }
    assert_eq!(bench.app.phase(), Phase::Following);
    assert_eq!(bench.app.take_received().len(), 2);
    bench.app.command_landing();
    bench.tick();
    assert_eq!(
        bench.app.phase(),
        Phase::Landed(Outcome::LandCommanded),
        "there is nowhere to land from"
    );
}

#[test]
fn every_button_of_the_operator_is_sent_until_its_echo() {
    let record = |snapshots, odometry, sequence| {
        Mode::Record(Record {
            snapshots,
            odometry,
            sequence,
        })
    };
    let buttons = [
        (Mode::Clear, 0x0f),
        (record(true, false, false), 0x01),
        (record(true, false, true), 0x05),
        (record(false, true, false), 0x02),
        (record(true, true, false), 0x03),
        (record(true, true, true), 0x07),
        (Mode::FollowAndStay, 0x11),
        (Mode::Follow, 0x12),
        (Mode::Idle, 0x00),
    ];
    let idle = Experiment::Idle.script(Experiment::REPEATS);
    let mut bench = Bench::new(idle, Settings::default());
    bench.run(FIRST_CYCLE_MS);
    assert_eq!(
        bench.command_bytes_sent(),
        [],
        "idle is where cameras begin"
    );
    let mut cycle_ms = FIRST_CYCLE_MS;
    for (button, byte) in buttons {
        bench.app.press(button);
        for _ in 0..2 {
            cycle_ms += 100;
            bench.run(cycle_ms);
            assert_eq!(bench.command_bytes_sent(), [byte]);
        }
        bench.send(&command(byte));
        cycle_ms += 100;
        bench.run(cycle_ms);
        assert_eq!(bench.command_bytes_sent(), []);
    }
}

#[test]
fn with_the_follow_button_the_drone_flies_where_the_camera_leads_and_with_others_it_hovers() {
    let idle = Experiment::Idle.script(Experiment::REPEATS);
    let mut bench = Bench::new(idle, Settings::default());
    let mut mode = 0;
    let mut fly = |bench: &mut Bench, button, until_ms| {
        bench.app.press(button);
        while bench.now_ms < until_ms {
            bench.tick();
            if let Some(byte) = bench.command_bytes_sent().first() {
                mode = *byte;
                bench.send(&command(mode));
            }
            if bench
                .sent
                .iter()
                .any(|sent| matches!(sent, Message::State(_)))
            {
                bench.send(&vector(1.0, 0.0));
            }
        }
        (bench.app.phase(), bench.position_m.x)
    };
    let record = Mode::Record(Record::ROUTE);
    assert_eq!(fly(&mut bench, record, 8_000), (Phase::Recording, 0.0));
    assert_eq!(
        fly(&mut bench, Mode::Follow, 9_000),
        (Phase::Following, 1.0)
    );
    assert_eq!(fly(&mut bench, Mode::Idle, 10_000), (Phase::Recording, 1.0));
    bench.app.command_landing();
    bench.run(12_000);
    assert_eq!(bench.app.phase(), Phase::Landed(Outcome::LandCommanded));
}

#[test]
fn a_script_realigns_the_filter_by_the_turn_that_the_last_vector_asked_for() {
    let place = WorldPoint { x: 0.5, y: 0.0 };
    let steps = vec![
        Step::Follow {
            mode: Mode::FollowAndStay,
            until: Until::Elapsed(1_000),
        },
        Step::Realign { place },
        Step::Buttons,
    ];
    let mut bench = Bench::new(Script { steps }, Settings::default());
    bench.run(FIRST_CYCLE_MS);
    bench.send(&command(0x11));
    bench.send(&Message::Vector(link::Vector {
        delta_yaw: 0.1,
        ..link::Vector::default()
    }));
    let mut measurements = Vec::new();
    while bench.now_ms < FIRST_CYCLE_MS + 3_000 {
        measurements.extend(bench.tick().measurements);
    }
    // psi += -delta_yaw.
    assert_eq!(measurements, fix(0.5, CorrectionSd::OVERWRITE, -0.1));
}

#[test]
fn a_script_that_was_never_led_has_nothing_to_realign_by() {
    let place = WorldPoint::default();
    let steps = vec![Step::Realign { place }];
    let mut bench = Bench::new(Script { steps }, Settings::default());
    let mut measurements = Vec::new();
    while bench.now_ms < FIRST_CYCLE_MS + 200 {
        measurements.extend(bench.tick().measurements);
        if bench.now_ms == 1_001 {
            measurements.clear();
        }
    }
    assert_eq!(measurements, []);
}

#[test]
fn an_app_that_starts_in_mid_flight_time_takes_off_and_follows_home() {
    let mut bench = Bench::new(Script::resume(), Settings::default());
    bench.now_ms = 123_456;
    bench.run(124_455);
    assert_eq!(bench.app.phase(), Phase::Ground, "a second of calibration");
    bench.run(124_456);
    assert_eq!(bench.app.phase(), Phase::TakeOff);
    let mut answers = 0;
    let outcome = bench.fly(200_000, |message| match message {
        Message::Command(_) => vec![message.clone()],
        Message::State(_) => {
            answers += 1;
            let map = Message::Map(link::Map::default());
            vec![vector(0.25, 0.0), map]
        }
        _ => Vec::new(),
    });
    assert_eq!(outcome, Outcome::Completed);
    assert!(answers > 100, "ten seconds of rest at the first snapshot");
}
