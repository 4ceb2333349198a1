//! What each peculiarity of the published client changes at the app's end of the wire.

use link::{Command, InsCorrection, Message, Vector};

use super::{Bench, FIRST_CYCLE_MS, FOLLOW, command, vector};
use crate::app::{DropReason, Outcome, Phase, Quirks, Script, Settings};
use crate::controller::SetPoint;
use crate::ekf::Measurement;

fn bench_with(quirks: Quirks) -> Bench {
    let settings = Settings {
        quirks,
        ..Settings::default()
    };
    Bench::new(Script::resume(), settings)
}

/// The command bytes of the first five cycles, against a camera that is deaf.
fn commands_to_a_deaf_camera(quirks: Quirks) -> Vec<Vec<u8>> {
    let mut bench = bench_with(quirks);
    let cycles = (0..5).map(|cycle| FIRST_CYCLE_MS + 100 * cycle);
    cycles
        .map(|cycle_ms| {
            bench.run(cycle_ms);
            bench.command_bytes_sent()
        })
        .collect()
}

#[test]
fn an_app_that_acknowledges_itself_says_each_command_once() {
    let quirks = Quirks {
        self_acknowledge: true,
        ..Quirks::PUBLISHED
    };
    let mut once = vec![vec![]; 5];
    once[0] = vec![FOLLOW];
    assert_eq!(commands_to_a_deaf_camera(quirks), once);
    assert_eq!(
        commands_to_a_deaf_camera(Quirks::PUBLISHED),
        vec![vec![FOLLOW]; 5]
    );
}

#[test]
fn an_app_that_acknowledges_itself_repeats_a_command_when_the_camera_says_another_mode() {
    let mut bench = bench_with(Quirks {
        self_acknowledge: true,
        ..Quirks::PUBLISHED
    });
    bench.run(FIRST_CYCLE_MS + 300);
    bench.send(&command(0x03));
    bench.run(FIRST_CYCLE_MS + 400);
    assert_eq!(bench.command_bytes_sent(), [FOLLOW]);
    bench.run(FIRST_CYCLE_MS + 500);
    assert_eq!(bench.command_bytes_sent(), [], "once, again");
}

/// Measurements for the filter out of what arrived on the ground, and what was dropped of it.
fn from_the_ground(quirks: Quirks) -> (usize, Vec<(&'static str, DropReason)>) {
    let mut bench = bench_with(quirks);
    bench.send(&Message::InsCorrection(InsCorrection {
        snapshot_index: 3,
        n_to: 1.0,
        ..InsCorrection::default()
    }));
    bench.run(2_000);
    let mut measurements = 0;
    while bench.now_ms < FIRST_CYCLE_MS + 100 {
        measurements += bench.tick().measurements.len();
    }
    let dropped = bench.app.take_dropped().into_iter();
    let dropped = dropped.map(|dropped| (dropped.message, dropped.why));
    (measurements, dropped.collect())
}

#[test]
fn a_correction_that_came_on_the_ground_is_applied_in_the_air_unless_it_is_thrown_away() {
    assert_eq!(from_the_ground(Quirks::PUBLISHED), (2, vec![]));
    let quirks = Quirks {
        keeps_ground_bytes: false,
        ..Quirks::PUBLISHED
    };
    let dropped = vec![("INS_CORRECTION", DropReason::NotRead)];
    assert_eq!(from_the_ground(quirks), (0, dropped));
}

#[test]
fn a_repeated_correction_is_applied_once_and_only_for_its_index() {
    let applied = |quirks| {
        let mut bench = bench_with(quirks);
        bench.run(FIRST_CYCLE_MS);
        bench.send(&Message::InsCorrection(InsCorrection {
            snapshot_index: 3,
            n_to: 1.0,
            ..InsCorrection::default()
        }));
        let mut measurements: Vec<Measurement> = Vec::new();
        while bench.now_ms < FIRST_CYCLE_MS + 300 {
            measurements.extend(bench.tick().measurements);
        }
        (measurements.len(), bench.app.counters().repeats)
    };
    // The second of ten calls receives it, the third handles it, and the seven behind that again.
    assert_eq!(applied(Quirks::PUBLISHED), (2, 7));
    assert_eq!(applied(Quirks::NONE), (2, 0));
}

#[test]
fn a_leftover_on_the_stack_is_handled_in_the_next_cycle() {
    // The tenth message of a cycle is the only vector.
    let target = |quirks| {
        let mut bench = bench_with(quirks);
        bench.run(FIRST_CYCLE_MS);
        bench.send(&command(FOLLOW));
        bench.run(FIRST_CYCLE_MS + 299);
        for _ in 0..9 {
            bench.send(&command(FOLLOW));
        }
        bench.send(&vector(1.0, 0.0));
        bench.run(FIRST_CYCLE_MS + 1_000);
        bench.position_m.x
    };
    assert_eq!(target(Quirks::PUBLISHED), 0.0);
    let quirks = Quirks {
        stack_leftovers: true,
        ..Quirks::PUBLISHED
    };
    assert_eq!(target(quirks), 1.0);
}

/// The set-point that a target of NaN leads to, and the phase.
fn flown_to_nan(quirks: Quirks) -> (bool, Phase) {
    let mut bench = bench_with(quirks);
    bench.run(FIRST_CYCLE_MS);
    bench.send(&command(FOLLOW));
    bench.run(FIRST_CYCLE_MS + 300);
    bench.send(&vector(f32::NAN, 0.0));
    let mut all_finite = true;
    for now_ms in bench.now_ms..bench.now_ms + 2_000 {
        let inbound = std::mem::take(&mut bench.inbound);
        let hover = super::estimate(nalgebra::Vector3::new(0.0, 0.0, 0.5));
        let output = bench.app.tick(now_ms, &hover, &inbound);
        if let SetPoint::Hold { position_m, .. } = output.set_point {
            all_finite &= position_m.iter().all(|value| value.is_finite());
        }
    }
    (all_finite, bench.app.phase())
}

#[test]
fn a_target_that_is_no_number_lands_the_drone_or_reaches_the_set_point() {
    assert_eq!(
        flown_to_nan(Quirks::PUBLISHED),
        (true, Phase::Landed(Outcome::BrokenMessage))
    );
    let quirks = Quirks {
        unchecked_values: true,
        ..Quirks::PUBLISHED
    };
    assert_eq!(flown_to_nan(quirks), (false, Phase::Following));
}

#[test]
fn absurd_targets_and_corrections_end_the_flight_before_anything_sees_them() {
    let absurd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e9, f32::MAX];
    let messages = absurd.into_iter().flat_map(|value| {
        let correction = |change: fn(&mut InsCorrection, f32)| {
            let mut correction = InsCorrection {
                snapshot_index: 9,
                ..InsCorrection::default()
            };
            change(&mut correction, value);
            Message::InsCorrection(correction)
        };
        [
            vector(value, 0.0),
            vector(0.0, value),
            correction(|c, v| c.n_from = v),
            correction(|c, v| c.e_to = v),
            correction(|c, v| c.psi_from = v),
            correction(|c, v| c.psi_to = v),
        ]
    });
    for message in messages {
        let mut bench = bench_with(Quirks::PUBLISHED);
        bench.run(FIRST_CYCLE_MS);
        bench.send(&command(FOLLOW));
        bench.run(FIRST_CYCLE_MS + 300);
        bench.send(&message);
        while bench.now_ms < FIRST_CYCLE_MS + 3_000 {
            let output = bench.tick();
            assert_eq!(output.measurements, [], "{message:?}");
            if let SetPoint::Hold { position_m, .. } = output.set_point {
                assert!(position_m.norm() < 1.0, "{message:?}: {position_m}");
            }
            if matches!(bench.app.phase(), Phase::Landed(_)) {
                break;
            }
        }
        assert_eq!(
            bench.app.phase(),
            Phase::Landed(Outcome::BrokenMessage),
            "{message:?}"
        );
    }
}

#[test]
fn a_frame_in_front_of_which_a_start_byte_strayed_is_found_only_by_a_receiver_that_searches_again()
{
    let received = |published_receiver| {
        let mut bench = bench_with(Quirks {
            published_receiver,
            ..Quirks::PUBLISHED
        });
        bench.run(FIRST_CYCLE_MS);
        // Claims 40 bytes, most of them those of the vector behind it.
        bench.inbound.extend([0x99, 40]);
        bench.send(&vector(1.0, 0.0));
        bench.send(&command(FOLLOW));
        bench.send(&command(FOLLOW));
        bench.run(FIRST_CYCLE_MS + 300);
        let received = bench.app.take_received().into_iter();
        let names: Vec<_> = received.map(|received| received.message.name()).collect();
        let dropped: Vec<_> = bench.app.take_dropped();
        let dropped: Vec<_> = dropped
            .iter()
            .map(|dropped| (dropped.message, dropped.bytes, dropped.why.to_string()))
            .collect();
        (names, dropped)
    };
    let (names, dropped) = received(true);
    // 36 data bytes: the vector and seven of the command; the eighth is no sum.
    assert_eq!(names, ["COMMAND"]);
    let refused = |bytes, why: &str| ("?", bytes, format!("refused: {why}"));
    let swallowed = |name, bytes| (name, bytes, "swallowed by a broken frame".to_owned());
    assert_eq!(
        dropped,
        [
            refused(39, "checksum"),
            swallowed("VECTOR", 29),
            swallowed("COMMAND", 10),
        ]
    );
    let (names, dropped) = received(false);
    assert_eq!(names, ["VECTOR", "COMMAND", "COMMAND"]);
    assert_eq!(dropped, [refused(2, "class")]);
}

#[test]
fn every_frame_that_does_not_fit_the_buffer_is_named() {
    let mut bench = bench_with(Quirks::PUBLISHED);
    for _ in 0..7 {
        bench.send(&Message::Vector(Vector::default()));
    }
    bench.send(&Message::Command(Command::default()));
    bench.run(FIRST_CYCLE_MS + 50);
    let dropped = bench.app.take_dropped().into_iter();
    let dropped: Vec<_> = dropped
        .map(|dropped| (dropped.at_ms, dropped.message, dropped.bytes, dropped.why))
        .collect();
    // 6 * 29 = 174 bytes of 200; the seventh is cut by three.
    assert_eq!(
        dropped,
        [
            (0, "VECTOR", 29, DropReason::BufferFull),
            (0, "COMMAND", 10, DropReason::BufferFull),
        ]
    );
    assert_eq!(bench.app.take_received().len(), 6);
    // The stump of the seventh still eats what comes next.
    bench.send(&command(FOLLOW));
    bench.run(FIRST_CYCLE_MS + 150);
    assert_eq!(bench.app.take_received(), []);
    let dropped = bench.app.take_dropped();
    assert_eq!(dropped.len(), 1, "the stump itself has been reported");
    assert_eq!(
        (dropped[0].message, dropped[0].why),
        ("COMMAND", DropReason::Swallowed)
    );
}

#[test]
fn what_comes_while_the_drone_lands_is_reported_as_not_read() {
    let mut bench = bench_with(Quirks::PUBLISHED);
    bench.run(FIRST_CYCLE_MS + 50);
    bench.app.command_landing();
    bench.tick();
    bench.send(&vector(1.0, 0.0));
    bench.run(FIRST_CYCLE_MS + 2_000);
    let dropped = bench.app.take_dropped();
    assert_eq!(dropped.len(), 1);
    assert_eq!(
        (dropped[0].message, dropped[0].why),
        ("VECTOR", DropReason::NotRead)
    );
}
