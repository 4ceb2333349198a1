//! What is known of a board by what was said on its link.

use frames::Shape;
use hil::record::{Deed, Side, What};
use hil::rig::transcript::{Order, Snapshots, Transcript, snapshots_said};
use link::{Command, Map, Message, Mode};

fn sent(t_ms: u64, by: Side, message: Message) -> Deed {
    let what = What::Sent { by, message };
    Deed { t_ms, what }
}

/// The board names its latest snapshot.
fn map(index: u16, coefficients: &[i8]) -> Message {
    Message::Map(Map {
        snapshot_index: index,
        snapshot_ak_bk: coefficients.iter().copied().collect(),
        ..Map::default()
    })
}

fn follow() -> Message {
    Message::Command(Command {
        command: Mode::Follow.byte(),
        ..Command::default()
    })
}

#[test]
fn a_snapshot_counts_once_it_was_said_whether_the_app_used_the_message_or_not() {
    // Nobody has used these two: there is no mark of either in a recording.
    let deeds = [
        sent(10, Side::Camera, map(0, &[1, 2])),
        sent(20, Side::Camera, map(1, &[3, 4])),
    ];
    let expected = [(0, vec![1, 2]), (1, vec![3, 4])];
    assert_eq!(snapshots_said(&deeds), expected.into());
}

#[test]
fn what_the_board_says_while_it_follows_is_no_snapshot_taken() {
    let deeds = [
        sent(10, Side::Camera, map(0, &[1, 2])),
        sent(20, Side::Autopilot, follow()),
        sent(30, Side::Camera, map(0, &[5, 6])),
    ];
    assert_eq!(snapshots_said(&deeds), [(0, vec![1, 2])].into());
}

#[test]
fn the_autopilots_own_words_are_no_snapshots_of_the_board() {
    let deeds = [
        sent(10, Side::Autopilot, map(0, &[1, 2])),
        sent(20, Side::Camera, map(0, &[])),
    ];
    assert!(snapshots_said(&deeds).is_empty());
}

#[test]
fn a_snapshot_that_only_the_board_took_is_a_difference_and_named() {
    let shape = Shape {
        width: 128,
        height: 96,
        bytes_per_pixel: 2,
        luma_offset: 0,
    };
    let nothing = Transcript::merge(&Order::default(), vec![], vec![], shape).expect("an order");
    let difference = |of_board: &Snapshots| nothing.difference(of_board).expect("a lens");
    assert_eq!(difference(&Snapshots::new()), None);
    let said = difference(&[(7, vec![1, 2])].into()).expect("a difference");
    for words in ["the first is 7", "[1, 2] there and none here"] {
        assert!(said.contains(words), "{words}: {said}");
    }
}
