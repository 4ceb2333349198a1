//! Every frame that arrives is used or reported, once.

use link::{Camera, Command, Message, Parser};
use proptest::prelude::*;

use super::{Bench, FIRST_CYCLE_MS, FOLLOW, command};
use crate::app::{DropReason, Phase, Quirks, Script, Settings};

/// What arrives at one moment: when, in ms after take-off; messages by the length of their arrays;
/// bytes that arrive as others, by place.
type Arrival = (u64, Vec<usize>, Vec<(usize, u8)>);

fn arrivals() -> impl Strategy<Value = Vec<Arrival>> {
    let messages = prop::collection::vec(0_usize..40, 0..12);
    let changes = prop::collection::vec((0_usize..400, any::<u8>()), 0..4);
    prop::collection::vec((0_u64..1_500, messages, changes), 1..12)
}

fn quirks() -> impl Strategy<Value = Quirks> {
    any::<[bool; 7]>().prop_map(|on| Quirks {
        self_acknowledge: on[0],
        stack_leftovers: on[1],
        repeats_last_message: on[2],
        drops_tenth_message: on[3],
        short_buffer: on[4],
        keeps_ground_bytes: on[5],
        published_receiver: on[6],
        unchecked_values: false,
    })
}

fn bytes((_, lengths, changes): &Arrival) -> Vec<u8> {
    let messages = lengths.iter().map(|len| match len % 2 {
        0 => Message::Camera(Camera {
            // No start bytes in the arrays: a false start is the changes' business.
            snapshot_ak_bk: std::iter::repeat_n(7, *len).collect(),
        }),
        _ => Message::Command(Command {
            command: FOLLOW,
            args: std::iter::repeat_n(3, *len).collect(),
        }),
    });
    let mut bytes: Vec<u8> = messages.flat_map(|message| message.encode()).collect();
    for (place, byte) in changes {
        if let Some(changed) = bytes.get_mut(*place) {
            *changed = *byte;
        }
    }
    bytes
}

proptest! {
    #[test]
    fn every_good_frame_is_handled_or_named_as_dropped_and_never_both(
        mut arrivals in arrivals(),
        quirks in quirks(),
    ) {
        arrivals.sort_by_key(|arrival| arrival.0);
        let settings = Settings { quirks, ..Settings::default() };
        let mut bench = Bench::new(Script::resume(), settings);
        let mut witness = Parser::new();
        let mut good = 0;
        let mut send = |bench: &mut Bench, bytes: &[u8]| {
            good += witness.frames(bytes).count();
            bench.inbound.extend(bytes);
        };
        bench.run(FIRST_CYCLE_MS - 300);
        for arrival in &arrivals {
            let at_ms = FIRST_CYCLE_MS - 200 + arrival.0;
            if bench.now_ms < at_ms {
                bench.run(at_ms - 1);
            }
            send(&mut bench, &bytes(arrival));
        }
        // A frame may still be held back by a broken one's claim: silence, then many good ones.
        bench.run(FIRST_CYCLE_MS + 2_000);
        for _ in 0..30 {
            send(&mut bench, &command(FOLLOW).encode());
            let until_ms = bench.now_ms + 49;
            bench.run(until_ms);
        }
        bench.app.command_landing();
        bench.run(FIRST_CYCLE_MS + 8_000);
        prop_assert!(matches!(bench.app.phase(), Phase::Landed(_)));
        let handled = bench.app.take_received().len();
        let dropped = bench.app.take_dropped();
        let named = dropped.iter().filter(|dropped| match dropped.why {
            DropReason::BufferFull => dropped.message != "?",
            DropReason::TenthMessage | DropReason::Swallowed | DropReason::NotRead => true,
            DropReason::Refused(_) | DropReason::NoStart => false,
        });
        prop_assert_eq!(good, handled + named.count(), "{:#?}", dropped);
    }
}
