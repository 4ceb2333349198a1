//! What the app sends and reads, and when.

use link::{InsCorrection, Map, Message, WorldPoint};
use nalgebra::Vector3;

use super::{Bench, FIRST_CYCLE_MS, FOLLOW, command, vector};
use crate::app::{CorrectionSd, Script, Settings};
use crate::ekf::{Measurement, Position, YawError};

#[test]
fn the_link_is_silent_until_the_drone_hovers() {
    let mut bench = Bench::following();
    while bench.now_ms < FIRST_CYCLE_MS {
        bench.tick();
        assert_eq!(bench.sent, [], "at {} ms", bench.now_ms);
    }
    bench.tick();
    assert!(matches!(
        bench.sent[..],
        [Message::State(_), Message::Command(_)]
    ));
}

#[test]
fn the_loop_runs_every_100_ms_at_its_offset() {
    let settings = Settings {
        cycle_offset_ms: 37,
        ..Settings::default()
    };
    let script = Script::single_snapshot(WorldPoint::default());
    let mut bench = Bench::new(script, settings);
    let mut cycles = Vec::new();
    while bench.now_ms < 4_400 {
        let at_ms = bench.now_ms;
        bench.tick();
        if !bench.sent.is_empty() {
            cycles.push(at_ms);
        }
    }
    assert_eq!(cycles, [4_037, 4_137, 4_237, 4_337]);
}

#[test]
fn a_command_is_sent_every_cycle_until_its_echo() {
    let mut bench = Bench::following();
    bench.run(FIRST_CYCLE_MS);
    assert_eq!(bench.command_bytes_sent(), [FOLLOW]);
    bench.run(FIRST_CYCLE_MS + 100);
    assert_eq!(bench.command_bytes_sent(), [FOLLOW]);
    bench.send(&command(FOLLOW));
    bench.run(FIRST_CYCLE_MS + 200);
    assert_eq!(bench.command_bytes_sent(), [], "the echo came");
    bench.send(&command(0x00));
    bench.run(FIRST_CYCLE_MS + 300);
    assert_eq!(bench.command_bytes_sent(), [FOLLOW], "the camera idles");
    assert_eq!(bench.app.counters().commands_sent, 3);
}

#[test]
fn a_vector_is_flown_in_the_next_cycle_with_x_north_and_y_west() {
    let mut bench = Bench::following();
    bench.run(FIRST_CYCLE_MS);
    bench.send(&command(FOLLOW));
    bench.run(FIRST_CYCLE_MS + 300);
    bench.send(&vector(1.0, 2.0));
    // Received in the window of this cycle, decided in the next, issued when that one's window ends.
    let hover = Vector3::new(0.0, 0.0, 0.5);
    bench.run(FIRST_CYCLE_MS + 400 + 8);
    assert_eq!(bench.position_m, hover);
    bench.run(FIRST_CYCLE_MS + 400 + 9);
    assert_eq!(bench.position_m, Vector3::new(1.0, -2.0, 0.5));
}

#[test]
fn a_vector_is_not_flown_before_both_sides_agree_on_the_mode() {
    let mut bench = Bench::following();
    bench.run(FIRST_CYCLE_MS);
    bench.send(&vector(1.0, 2.0));
    bench.run(FIRST_CYCLE_MS + 500);
    assert_eq!(bench.position_m, Vector3::new(0.0, 0.0, 0.5));
}

#[test]
fn a_correction_becomes_two_measurements_once() {
    let mut bench = Bench::following();
    bench.run(FIRST_CYCLE_MS);
    let correction = Message::InsCorrection(InsCorrection {
        snapshot_index: 9,
        e_to: 0.25,
        n_to: -0.5,
        psi_to: 0.125,
        ..InsCorrection::default()
    });
    let mut measurements = Vec::new();
    for _ in 0..2 {
        bench.send(&correction);
        for _ in 0..100 {
            measurements.extend(bench.tick().measurements);
        }
    }
    let CorrectionSd {
        position_m: sd_m,
        yaw_rad: sd_rad,
    } = CorrectionSd::OVERWRITE;
    let position = Position {
        position_m: Vector3::new(-0.5, -0.25, 0.5),
        sd_m,
    };
    let yaw_error = YawError {
        error_rad: 0.125,
        sd_rad,
    };
    let expected = [
        Measurement::Position(position),
        Measurement::YawError(yaw_error),
    ];
    assert_eq!(measurements, expected);
    assert_eq!(bench.app.counters().corrections_ignored, 1);
}

/// Ten receive calls, one a millisecond: the last comes nine after the first.
const LAST_CALL_MS: u64 = 9;

#[test]
fn what_arrives_on_the_ground_waits_in_200_bytes_and_is_read_in_the_air() {
    let mut bench = Bench::following();
    for _ in 0..10 {
        bench.send(&vector(1.0, 2.0));
    }
    bench.run(FIRST_CYCLE_MS - 1);
    assert_eq!(bench.app.take_received(), []);
    assert_eq!(bench.app.counters().overflowed_bytes, 290 - 200);
    bench.run(FIRST_CYCLE_MS + 20);
    let received = bench.app.take_received();
    assert_eq!(received.len(), 6, "six of 29 bytes are whole");
    assert_eq!(received[0].at_ms, FIRST_CYCLE_MS + LAST_CALL_MS);
}

#[test]
fn maps_are_handed_to_the_recorder_with_their_time() {
    let mut bench = Bench::following();
    bench.run(FIRST_CYCLE_MS);
    let map = Message::Map(Map::default());
    bench.send(&map);
    bench.run(FIRST_CYCLE_MS + 50);
    let received = bench.app.take_received();
    assert_eq!(received.len(), 1);
    assert_eq!(received[0].message, map);
    assert_eq!(received[0].at_ms, FIRST_CYCLE_MS + LAST_CALL_MS);
    assert_eq!(bench.app.take_received(), []);
}
