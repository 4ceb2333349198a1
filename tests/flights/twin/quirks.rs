//! Each peculiarity of the published client, flown with and without: what it changes, and that the camera board leads
//! home all the same.

use autopilot::app::{DropReason, Dropped, Outcome, Phase, Quirks, Route, Script, Settings};
use link::{Camera, InsCorrection, Message, Record, Vector, WorldPoint};

use super::rig::{self, Flown, To, Wire};

/// The command that begins recording.
const RECORD: u8 = 0x03;
/// How near to where recording began a flight must end, m: the paper's radius for homing (Fig. 4).
const HOME_M: f64 = 0.5;
/// How long the wire is disturbed on the way back, ms.
const DISTURBED_MS: u64 = 2_000;

/// Two metres south with a snapshot each metre, and back.
fn fly(quirks: Quirks, touch: impl FnMut(&mut Wire<'_>)) -> Flown {
    let places = [(0.0, 0.0), (-2.0, 0.0)];
    let places = places.map(|(north, east)| WorldPoint::from_north_east(north, east));
    let decimetres = 10;
    let script = Script::record_and_return(&Route::through(&places), Record::ROUTE, &[decimetres]);
    let settings = Settings {
        quirks,
        ..Settings::default()
    };
    rig::fly(script, settings, ("arena-panels", [0.0, 0.0]), touch)
}

/// The published client with one peculiarity on or off.
fn published(change: impl FnOnce(&mut Quirks)) -> Quirks {
    let mut quirks = Quirks::PUBLISHED;
    change(&mut quirks);
    quirks
}

/// A disturbance of what the camera says, for a while from the second second of the way back on.
fn on_the_way_back(mut disturb: impl FnMut(&mut Wire<'_>)) -> impl FnMut(&mut Wire<'_>) {
    let mut following_ms = 0;
    move |wire| {
        if wire.phase == Phase::Following && wire.to == To::App {
            following_ms += 1;
            if (1_000..1_000 + DISTURBED_MS).contains(&following_ms) {
                disturb(wire);
            }
        }
    }
}

#[track_caller]
fn assert_home(flown: &Flown) {
    assert_eq!(flown.outcome, Outcome::Completed);
    let error_m = flown.home_error_m(RECORD);
    assert!(error_m < HOME_M, "{error_m} m from the start");
}

/// Vectors dropped for a reason.
fn vectors(dropped: &[Dropped], why: DropReason) -> usize {
    let lost = |dropped: &&Dropped| dropped.message == "VECTOR" && dropped.why == why;
    dropped.iter().filter(lost).count()
}

/// Vectors that the camera sends while the wire is disturbed: one for each STATE.
const VECTORS: usize = (DISTURBED_MS / 100) as usize;

fn chatter(coefficients: usize) -> Message {
    Message::Camera(Camera {
        snapshot_ak_bk: std::iter::repeat_n(1, coefficients).collect(),
    })
}

#[test]
fn on_an_undisturbed_link_the_published_client_flies_to_the_bit_as_one_without_bugs() {
    let flights = [
        Quirks::PUBLISHED,
        published(|quirks| quirks.repeats_last_message = false),
        Quirks::NONE,
    ]
    .map(|quirks| fly(quirks, |_| ()));
    for flown in &flights {
        assert_home(flown);
        assert_eq!(flown.track, flights[0].track);
        assert_eq!(flown.received, flights[0].received);
        assert_eq!(flown.dropped, []);
    }
    let repeats = flights.each_ref().map(|flown| flown.counters.repeats);
    // The last message of a period is handled up to nine times.
    assert!(repeats[0] > 500, "{repeats:?}");
    assert_eq!(repeats[1..], [0, 0]);
    let applied = flights.map(|flown| flown.counters.corrections_applied);
    // One where each of two to four snapshots is taken, and one where it is left.
    assert!((4..=8).contains(&applied[0]), "{applied:?}");
    assert_eq!(applied, [applied[0]; 3], "each once, repeated or not");
}

/// When the record command leaves the app, ms; the first is lost on the wire.
fn record_commands(quirks: Quirks) -> (Vec<u64>, Flown) {
    let mut sent_ms = Vec::new();
    let flown = fly(quirks, |wire| {
        let frame = Message::Command(link::Command {
            command: RECORD,
            args: [10].into_iter().collect(),
        })
        .encode();
        let holds = wire.bytes.windows(frame.len()).any(|bytes| *bytes == frame);
        if wire.to == To::Camera && holds {
            sent_ms.push(wire.now_ms);
            if sent_ms.len() == 1 {
                wire.bytes.clear();
            }
        }
    });
    (sent_ms, flown)
}

#[test]
fn a_command_that_is_lost_is_made_good_by_a_retry_or_by_the_camera_saying_its_mode() {
    let (sent_ms, flown) = record_commands(Quirks::PUBLISHED);
    assert_eq!(sent_ms[1] - sent_ms[0], 100);
    assert_home(&flown);
    let (sent_ms, flown) = record_commands(published(|quirks| quirks.self_acknowledge = true));
    // Taken for echoed at once. The camera, which still clears, says so within a second.
    let waited_ms = sent_ms[1] - sent_ms[0];
    assert!((200..=1_200).contains(&waited_ms), "{waited_ms} ms");
    assert_eq!(sent_ms.len(), 2);
    assert_home(&flown);
}

#[test]
fn an_app_that_acknowledges_itself_flies_to_the_bit_as_others_where_nothing_is_lost() {
    let other = fly(Quirks::PUBLISHED, |_| ());
    let flown = fly(published(|quirks| quirks.self_acknowledge = true), |_| ());
    assert_home(&flown);
    // The board echoes within the window of the cycle that sent the command: as early as the app itself.
    assert_eq!(flown.heard, other.heard);
    assert_eq!(flown.track, other.track);
}

/// Eight messages that nobody needs in front of every vector that comes alone: the first call of the window comes too
/// early for any of them, and the vector is left for the tenth. The flight, and how many vectors came alone.
fn with_eight_in_front(quirks: Quirks) -> (Flown, usize) {
    let vector = Message::Vector(Vector::default()).encode();
    let eight = [(); 8].map(|()| chatter(0));
    let mut alone = 0;
    let disturb = |wire: &mut Wire<'_>| {
        if wire.bytes.len() == vector.len() {
            alone += 1;
            wire.precede_with(&eight);
        }
    };
    let flown = fly(quirks, on_the_way_back(disturb));
    assert_home(&flown);
    (flown, alone)
}

#[test]
fn what_the_tenth_call_brings_is_lost_unless_the_stack_still_holds_it_or_the_app_looks() {
    let tenth = |flown: &Flown| vectors(&flown.dropped, DropReason::TenthMessage);
    let (lost, alone) = with_eight_in_front(Quirks::PUBLISHED);
    // Once a second the camera's mode comes behind the vector, and where the pose is realigned a correction.
    assert!(alone >= VECTORS / 2, "{alone}");
    assert_eq!(tenth(&lost), alone);
    assert_eq!(lost.dropped.len(), tenth(&lost), "nothing else is lost");
    let (leftover, _) = with_eight_in_front(published(|quirks| quirks.stack_leftovers = true));
    assert_eq!(leftover.dropped, []);
    let (used, _) = with_eight_in_front(published(|quirks| quirks.drops_tenth_message = false));
    assert_eq!(used.dropped, []);
}

/// Eight messages of 29 bytes in the middle of each period: more than 200 bytes before the app reads.
fn with_232_bytes_between_windows(quirks: Quirks) -> Flown {
    let eight = [(); 8].map(|()| chatter(20));
    let disturb = |wire: &mut Wire<'_>| {
        if wire.now_ms % 100 == 50 {
            wire.precede_with(&eight);
        }
    };
    let flown = fly(quirks, on_the_way_back(disturb));
    assert_home(&flown);
    flown
}

#[test]
fn a_full_buffer_cuts_a_frame_and_the_stump_eats_the_vector_behind_it() {
    let short = with_232_bytes_between_windows(Quirks::PUBLISHED);
    let cut =
        |dropped: &&Dropped| dropped.message == "CAMERA" && dropped.why == DropReason::BufferFull;
    let cut = short.dropped.iter().filter(cut).count();
    assert_eq!(cut, 2 * VECTORS, "the seventh and the eighth each time");
    assert_eq!(vectors(&short.dropped, DropReason::Swallowed), VECTORS);
    let long = with_232_bytes_between_windows(published(|quirks| quirks.short_buffer = false));
    // The vector is the ninth; what comes behind it may be the tenth.
    let tenth = |dropped: &Dropped| dropped.why == DropReason::TenthMessage;
    assert!(long.dropped.iter().all(tenth), "{:?}", long.dropped);
    assert_eq!(vectors(&long.dropped, DropReason::TenthMessage), 0);
}

/// A correction by a metre that comes while the drone stands on the ground.
fn with_a_correction_on_the_ground(quirks: Quirks) -> Flown {
    let correction = Message::InsCorrection(InsCorrection {
        snapshot_index: 99,
        n_to: 1.0,
        ..InsCorrection::default()
    });
    let flown = fly(quirks, |wire| {
        if wire.now_ms == 500 && wire.to == To::App {
            wire.precede_with(std::slice::from_ref(&correction));
        }
    });
    assert_home(&flown);
    flown
}

#[test]
fn what_comes_on_the_ground_moves_the_route_unless_it_is_thrown_away() {
    let began_at_m = |flown: &Flown| flown.at(flown.first_heard(RECORD)).x;
    let kept = with_a_correction_on_the_ground(Quirks::PUBLISHED);
    // The filter believes to be a metre north of where it is, and the script goes back to its origin.
    assert!(
        (began_at_m(&kept) + 1.0).abs() < 0.3,
        "{}",
        began_at_m(&kept)
    );
    assert_eq!(kept.dropped, []);
    let thrown =
        with_a_correction_on_the_ground(published(|quirks| quirks.keeps_ground_bytes = false));
    assert!(began_at_m(&thrown).abs() < 0.3, "{}", began_at_m(&thrown));
    assert_eq!(thrown.dropped.len(), 1);
    assert_eq!(thrown.dropped[0].why, DropReason::NotRead);
}

/// Two stray bytes, a start byte and a length of 20, in front of everything the camera says.
fn with_false_starts(quirks: Quirks) -> Flown {
    let disturb = |wire: &mut Wire<'_>| {
        if !wire.bytes.is_empty() {
            wire.bytes.splice(..0, [0x99, 20]);
        }
    };
    let flown = fly(quirks, on_the_way_back(disturb));
    assert_home(&flown);
    flown
}

#[test]
fn a_broken_frame_takes_the_vector_behind_it_down_unless_the_receiver_searches_again() {
    let lost = with_false_starts(Quirks::PUBLISHED);
    assert_eq!(vectors(&lost.dropped, DropReason::Swallowed), VECTORS);
    let found = with_false_starts(published(|quirks| quirks.published_receiver = false));
    let swallowed = |dropped: &&Dropped| dropped.why == DropReason::Swallowed;
    assert_eq!(found.dropped.iter().filter(swallowed).count(), 0);
    // The false starts themselves.
    assert!(found.dropped.len() >= VECTORS);
    assert!(found.dropped.iter().all(|dropped| dropped.bytes == 2));
}

/// One target that is no number.
fn with_a_target_of_nan(quirks: Quirks) -> Flown {
    let nowhere = Message::Vector(Vector {
        target_n: f32::NAN,
        ..Vector::default()
    });
    let mut told = false;
    fly(
        quirks,
        on_the_way_back(move |wire| {
            if !wire.bytes.is_empty() && !std::mem::replace(&mut told, true) {
                wire.bytes.clear();
                wire.precede_with(std::slice::from_ref(&nowhere));
            }
        }),
    )
}

#[test]
fn a_target_that_is_no_number_ends_the_flight_unless_nobody_looks() {
    let checked = with_a_target_of_nan(Quirks::PUBLISHED);
    assert_eq!(checked.outcome, Outcome::BrokenMessage);
    assert!(checked.finite);
    let unchecked = with_a_target_of_nan(published(|quirks| quirks.unchecked_values = true));
    assert!(!unchecked.finite, "the set-point was no number");
    assert_ne!(unchecked.outcome, Outcome::BrokenMessage);
}
