//! Flights on the emulated board, over pseudo-terminals, with frames over serial.

use std::path::Path;

use emulator::machine::Machine;
use emulator::time::Nanos;
use emulator::wiring::Unwired;
use frames::{Reply, Request, Source, Verdict};
use hil::board::emulated::Firmware;
use hil::board::serial_frames::SerialFrames;
use hil::live::LiveError;
use hil::live::Stop;
use hil::rig::canary::canary;
use hil::rig::file::Rig;
use hil::rig::transcript::{Said, Snapshots, Taken, Transcript};
use hil::rig::{BoardFlight, BoardSetup, Unready, fly_board, probe};
use hil::scenario::{Route, Scenario, Spacing, Storage};

use super::bench::{OnDesk, rig_image};

/// As fast as the clock.
pub const SPEED: f64 = 1.0;
/// The UART that the autopilot is on.
const LINK_USART: u8 = 2;
const MILLISECOND: Nanos = Nanos::from_millis(1);

/// The shortest route, a snapshot every half metre.
pub fn corner() -> Scenario {
    Scenario {
        route: Route::Corner,
        world: "arena-panels".to_owned(),
        seed: 1,
        spacing: Spacing::from_metres(0.5).expect("a spacing"),
        storage: Storage::PAPER,
        homing: Default::default(),
        conditions: Default::default(),
    }
}

/// Flies the corner on a rig.
pub fn fly(rig: &Rig, elf: &Path) -> Result<BoardFlight, LiveError> {
    fly_until(rig, elf, &Stop::default())
}

/// Flies the corner on a rig, until somebody asks to end.
pub fn fly_until(rig: &Rig, elf: &Path, stop: &Stop) -> Result<BoardFlight, LiveError> {
    let bytes = std::fs::read(elf).expect("an image");
    let firmware = Firmware::parse(&bytes).expect("an image");
    let setup = BoardSetup {
        rig,
        image: probe::Image {
            elf,
            firmware: &firmware,
        },
        identity: hil::image::identity(&bytes).ok(),
        scenario: corner(),
        speed: SPEED,
        stop,
    };
    fly_board(&setup, &|notice| eprintln!("flight: {notice:?}"))
}

/// What is missing, or what broke.
pub fn unready(flown: Result<BoardFlight, LiveError>) -> Unready {
    match flown {
        Err(LiveError::Rig(unready)) => unready,
        Err(error) => panic!("{error}"),
        Ok(flight) => panic!("flew: {}", flight.flown.summary.outcome),
    }
}

#[test]
fn a_route_is_flown_home_on_a_board_and_its_snapshots_are_those_of_the_same_frames_elsewhere() {
    let desk = OnDesk::with(rig_image(), SPEED);
    let flight = fly(&desk.rig, rig_image()).unwrap_or_else(|error| panic!("{error}"));
    let summary = &flight.flown.summary;
    assert!(summary.completed, "{}", summary.outcome);
    assert_eq!(summary.backend, "board");
    assert!(summary.home_error_m < 0.5, "{}", summary.home_error_m);
    let cycles = summary.cycles_per_frame.expect("the board's own counts");
    assert!(cycles.p50 > 10_000 && cycles.emulator_p50.is_none());
    // As many as the paper's firmware looks at.
    let frames_per_s = summary.frames_sent as f64 / summary.flight_s;
    assert!(frames_per_s > 10.0, "{frames_per_s}");

    let taken = flight.snapshots();
    assert!(taken.len() >= 6, "{}", taken.len());
    let transcript = flight.transcript.expect("frames over serial");
    let transcript = transcript.unwrap_or_else(|gap| panic!("{gap}"));
    eprintln!(
        "{frames_per_s:.1} frames/s, {} dropped",
        summary.frames_dropped
    );
    assert_eq!(transcript.snapshots(), Ok(taken.clone()), "natively");
    assert_eq!(
        replayed(&transcript, rig_image()),
        taken,
        "on the emulator, in virtual time"
    );
}

/// The snapshots of an emulated board in virtual time, without ports or clocks, that is shown and told
/// the same in the same order.
fn replayed(transcript: &Transcript, elf: &Path) -> Snapshots {
    let bytes = std::fs::read(elf).expect("an image");
    let firmware = Firmware::parse(&bytes).expect("an image");
    let mut machine = firmware.machine(Unwired).expect("a machine");
    let mut frames = SerialFrames::new();
    let mut said = Said::default();
    run(&mut machine, 300);
    let fresh_ms = u16::MAX;
    frames.ask(&mut machine, Request::Begin { fresh_ms });
    wait_for(&mut machine, &mut frames, Reply::Source(Source::Serial));
    let begun = machine.now();
    for taken in &transcript.taken {
        match taken {
            Taken::Frame(used) => {
                frames.send(&mut machine, &used.wire);
                wait_for_verdict(&mut machine, &mut frames, used.number);
            }
            Taken::Message { t_ms, message } => {
                let due = begun + Nanos::from_millis(*t_ms);
                machine.run_until(due).expect("it runs");
                said.on_sent(message);
                let now = machine.now();
                machine.usart_send(LINK_USART, now, &message.encode());
                run(&mut machine, 4);
                let answer = machine.usart_received(LINK_USART);
                let answer: Vec<u8> = answer.into_iter().map(|(_, byte)| byte).collect();
                said.on_answer(&answer);
            }
        }
    }
    said.into_snapshots()
}

fn run(machine: &mut Machine<Unwired>, ms: u64) {
    let until = machine.now() + Nanos::from_millis(ms);
    machine.run_until(until).expect("it runs");
}

fn wait_for(machine: &mut Machine<Unwired>, frames: &mut SerialFrames, wanted: Reply) {
    for _ in 0..1_000 {
        run(machine, 1);
        if frames.replies(machine).contains(&wanted) {
            return;
        }
    }
    panic!("no {wanted:?}");
}

fn wait_for_verdict(machine: &mut Machine<Unwired>, frames: &mut SerialFrames, wanted: u32) {
    for _ in 0..1_000 {
        let until = machine.now() + MILLISECOND;
        machine.run_until(until).expect("it runs");
        for reply in frames.replies(machine) {
            if let Reply::Verdict {
                number, verdict, ..
            } = reply
            {
                assert_eq!((number, verdict), (wanted, Verdict::Used));
                return;
            }
        }
    }
    panic!("no word of frame {wanted}");
}

#[test]
fn the_canary_dies_on_a_board_that_refuses_a_broken_frame() {
    let desk = OnDesk::with(rig_image(), 1.0);
    let elf = std::fs::read(rig_image()).expect("an image");
    let firmware = Firmware::parse(&elf).expect("an image");
    let image = probe::Image {
        elf: rig_image(),
        firmware: &firmware,
    };
    let identity = hil::image::identity(&elf).ok();
    let sung = canary(&desk.rig, &image, identity.as_ref()).expect("a rig that is ready");
    assert_eq!(sung.whole, Some(Verdict::Used));
    assert_ne!(sung.broken, Some(Verdict::Used));
}
