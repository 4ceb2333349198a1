//! Frames over serial: rig images on the emulated board take them as they take the camera's, and flight
//! images do not take them at all. The images are built first.

mod bench;

use bench::{Bench, FRAME_MS, elf, firmware, seen_from};
use emulator::image::Image;
use emulator::wiring::Pin;
use frames::{BoardName, Counts, Identity, ImageKind, Pieces, Reply, Request, Source, Verdict};
use hil::board::serial_frames::{SERIAL_USART, SHAPE};
use hil::image::{Variant, identity};
use link::{Command, Message, Mode, Record, State};
use pilot::{Outbox, Parameters, Pilot};

const DISCOVERY: Variant = Variant {
    board: BoardName::Discovery,
    ..Variant::RIG
};

/// The records of a frame on the wire.
fn pieces(number: u32, frame: &pilot::Frame) -> Vec<Vec<u8>> {
    let pieces = Pieces::of(number, frame, &SHAPE);
    pieces.map(|piece| piece.to_vec()).collect()
}

fn verdicts(replies: &[Reply]) -> Vec<(u32, Verdict)> {
    let verdicts = replies.iter().filter_map(|reply| match reply {
        Reply::Verdict {
            number, verdict, ..
        } => Some((*number, *verdict)),
        _ => None,
    });
    verdicts.collect()
}

#[test]
fn twenty_frames_over_serial_are_the_same_route_as_the_same_frames_without_a_board() {
    let firmware = firmware(Variant::RIG);
    let mut bench = Bench::begin(&firmware, 100);
    assert_eq!(bench.replies, [Reply::Source(Source::Serial)]);
    let mut pilot = Pilot::new(&Parameters::DEFAULT).expect("a lens");
    let (mut outbox, mut link) = (Outbox::new(), Vec::new());
    let record = Message::Command(Command {
        command: Mode::Record(Record::ROUTE).byte(),
        ..Command::default()
    });
    let mut say = |bench: &mut Bench<'_>, pilot: &mut Pilot, message: &Message| {
        let now_ms = (bench.machine.now().as_secs_f64() * 1e3) as u32;
        bench.say(message);
        pilot.on_message(now_ms, message, &mut outbox);
        link.extend_from_slice(outbox.bytes());
        outbox.clear();
    };
    say(&mut bench, &mut pilot, &record);
    let mut lumas = Vec::new();
    for number in 1..=20 {
        let north_m = 0.25 * number as f32;
        // The rig exposes with the shutter that the last answer asked for.
        let shutter = pilot.exposure().shutter_lines;
        let frame = seen_from(north_m, shutter, number);
        bench.replies.clear();
        bench.show(number, &frame);
        lumas.push(pilot.on_frame(&frame).mean_luma);
        let wanted = pilot.exposure();
        let used = Reply::Verdict {
            number,
            verdict: Verdict::Used,
            shutter_lines: wanted.shutter_lines,
            gain: wanted.gain,
        };
        assert_eq!(bench.replies, [used]);
        let state = Message::State(State {
            ins_n: north_m,
            ..State::default()
        });
        say(&mut bench, &mut pilot, &state);
    }
    let looked_at: Vec<f32> = bench.frames().iter().map(|frame| frame.luma).collect();
    assert_eq!(looked_at, lumas);
    assert!(lumas.iter().all(|luma| *luma > 10.0));
    // The mode, and a snapshot every 2 m with its 16 bytes, twice over on either wire.
    assert!(link.len() > 100, "{} bytes", link.len());
    assert_eq!(bench.link, link);
    assert_eq!(pilot.navigator().route().snapshots().len(), 3);
}

#[test]
fn whatever_is_not_a_frame_in_time_is_dropped_counted_and_answered_by_name_and_never_seen() {
    let firmware = firmware(Variant::RIG);
    let mut bench = Bench::boot(&firmware);
    let frame = seen_from(0.0, 135, 1);
    let whole = |number| pieces(number, &frame).concat();
    let mut corrupt = whole(6);
    corrupt[5_000] ^= 0x20;
    let mut torn = pieces(7, &frame);
    torn.remove(4);
    let slow = pieces(8, &frame);
    let (head, tail) = slow.split_at(6);

    // Before the session there is the camera.
    bench.host.send(&mut bench.machine, &whole(3));
    bench.run_ms(FRAME_MS);
    bench.ask(Request::Begin { fresh_ms: 80 });
    for bytes in [whole(5), corrupt, torn.concat(), whole(5), whole(4)] {
        bench.host.send(&mut bench.machine, &bytes);
        bench.run_ms(FRAME_MS);
    }
    bench.host.send(&mut bench.machine, &head.concat());
    bench.run_ms(100);
    bench.host.send(&mut bench.machine, &tail.concat());
    bench.run_ms(FRAME_MS);
    bench
        .host
        .send(&mut bench.machine, b"garbage\0\0more of it");
    bench.show(9, &frame);
    bench.ask(Request::Count);

    let expected = [
        (3, Verdict::Busy),
        (5, Verdict::Used),
        (6, Verdict::Torn),
        (7, Verdict::Torn),
        (5, Verdict::Repeated),
        (4, Verdict::Late),
        (8, Verdict::Late),
        (9, Verdict::Used),
    ];
    assert_eq!(verdicts(&bench.replies), expected);
    assert_eq!(bench.frames().len(), 2, "what is not used is not seen");
    let counts = Counts {
        whole: 2,
        torn: 2,
        late: 2,
        repeated: 1,
        busy: 1,
        corrupt: 3,
    };
    assert_eq!(bench.replies.last(), Some(&Reply::Counts(counts)));
    bench.run_ms(1_000);
    let health = "serial frames whole 2 torn 2 late 2 repeated 1 busy 1 corrupt records 3";
    assert!(bench.lines().contains(&health), "{:?}", bench.lines());
}

#[test]
fn frames_pass_as_fast_as_the_wire_and_a_session_ends_with_the_camera() {
    let firmware = firmware(Variant::RIG);
    let mut bench = Bench::begin(&firmware, 100);
    let frame = seen_from(0.0, 135, 1);
    for number in 1..=10 {
        bench.host.send_frame(&mut bench.machine, number, &frame);
    }
    // 25.64 frames a second are 390 ms for ten.
    bench.run_ms(390);
    let used = (1..=10).map(|number| (number, Verdict::Used));
    assert_eq!(verdicts(&bench.replies), used.collect::<Vec<_>>());
    bench.ask(Request::End);
    assert_eq!(bench.replies.last(), Some(&Reply::Source(Source::Camera)));
    bench.show(11, &frame);
    assert_eq!(verdicts(&bench.replies).last(), Some(&(11, Verdict::Busy)));
    bench.ask(Request::Begin { fresh_ms: 100 });
    bench.show(1, &frame);
    assert_eq!(verdicts(&bench.replies).last(), Some(&(1, Verdict::Used)));
}

#[test]
fn a_flight_image_does_nothing_with_frames_over_serial() {
    let firmware = firmware(Variant::FLIGHT);
    let mut bench = Bench::boot(&firmware);
    let frame = seen_from(0.0, 135, 1);
    bench.ask(Request::Identify);
    bench.ask(Request::Begin { fresh_ms: 100 });
    bench.show(1, &frame);
    bench.ask(Request::Count);
    assert_eq!(bench.replies, []);
    assert_eq!(bench.frames(), []);
    let counters = bench.machine.usart_counters(SERIAL_USART);
    assert_eq!((counters.received, counters.sent), (0, 0));
    assert!(counters.lost > 8_000);
}

#[test]
fn an_image_says_what_it_is_in_its_file_in_its_log_and_over_the_wire() {
    for (variant, baud) in [
        (Variant::FLIGHT, 0),
        (Variant::RIG, 3_000_000),
        (DISCOVERY, 3_000_000),
    ] {
        let file = elf(variant);
        let found = identity(file).expect("an identification");
        let lens_page = Image::parse(file).expect("an image").symbol("_lens_page");
        let expected = Identity::new(
            variant.kind,
            variant.board,
            SHAPE,
            baud,
            lens_page.expect("a page").address,
            env!("CARGO_PKG_VERSION"),
        );
        assert_eq!(found, expected);

        let firmware = firmware(variant);
        let mut bench = Bench::boot(&firmware);
        let (kind, board) = (variant.kind.name(), variant.board.name());
        let boot = format!("boot, {kind} image for the {board} board, clock 168000000 Hz");
        let said = bench.lines().iter().any(|line| line.ends_with(&boot));
        assert!(said, "{:?}", bench.lines());
        bench.ask(Request::Identify);
        if variant.kind == ImageKind::Rig {
            assert_eq!(bench.replies, [Reply::Identity(expected)]);
        }
    }
}

#[test]
fn the_code_that_takes_frames_over_serial_is_in_rig_images_alone() {
    let has = |variant, symbol: &str| {
        elf(variant)
            .windows(symbol.len())
            .any(|bytes| bytes == symbol.as_bytes())
    };
    // The task, the capture's way around the DMA, and the protocol's receiver; the names of the
    // debug information's sources count.
    for symbol in ["serial_frames", "injection", "unstuff"] {
        assert!(has(Variant::RIG, symbol), "{symbol}");
        assert!(!has(Variant::FLIGHT, symbol), "{symbol}");
    }
}

#[test]
fn on_a_discovery_board_the_sensors_clock_is_on_pa8_and_its_neighbours_are_silent() {
    let firmware = firmware(DISCOVERY);
    let mut bench = Bench::begin(&firmware, 100);
    bench.show(1, &seen_from(0.0, 135, 1));
    assert_eq!(verdicts(&bench.replies), [(1, Verdict::Used)]);
    let pin = |port, number| Pin { port, number };
    let pins = bench.machine.wiring();
    assert_eq!(pins.clocks.get(&pin('A', 8)), Some(&Some(21e6)));
    assert_eq!(pins.clocks.get(&pin('A', 7)), None);
    // Motion sensor deselected, audio DAC in reset.
    assert_eq!(pins.levels.get(&pin('E', 3)), Some(&true));
    assert_ne!(pins.levels.get(&pin('D', 4)), Some(&true));
}
