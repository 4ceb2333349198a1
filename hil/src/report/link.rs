//! What was lost on the link: every frame that its receiver dropped, by whom and why.

use maud::{Markup, html};

use super::number;
use super::plot::{Strip, TimeAxis};
use crate::record::{LinkDrop, Recording, Side};
use crate::summary::{DirectionFigures, Summary};

/// Up to so many drops have a row each; more are folded by side, message and reason.
const MOST_ROWS: usize = 50;

/// Rows of the folded table; reasons may hold numbers.
const MOST_KINDS: usize = 200;

/// Drops that have side, message and reason in common.
struct Kind<'r> {
    first: &'r LinkDrop,
    last: &'r LinkDrop,
    count: usize,
}

/// Figures of both directions, when drops happened, and what was dropped.
pub fn link(recording: &Recording, summary: &Summary, time: &TimeAxis) -> Markup {
    let drops = &recording.link_drops;
    html! {
        section.long {
            h2 { "Link" }
            (figures(summary))
            @if drops.is_empty() {
                p { "No frame of the link was dropped." }
            } @else {
                figure { (strip(drops).render(time)) }
                @if drops.len() <= MOST_ROWS { (each(drops)) } @else { (folded(drops)) }
            }
        }
    }
}

/// Frames sent and dropped, each way; nothing where none was counted.
fn figures(summary: &Summary) -> Markup {
    let link = &summary.link;
    let rows = [
        ("autopilot → camera board", link.to_camera),
        ("camera board → autopilot", link.to_autopilot),
    ];
    let row = |(label, direction): (&str, DirectionFigures)| {
        html! { tr {
            td { (label) }
            td.count { (number::grouped(direction.frames_sent)) }
            td.count { (number::grouped(direction.frames_dropped)) }
        } }
    };
    html! {
        @if rows.iter().any(|(_, direction)| *direction != DirectionFigures::default()) {
            table.drops {
                thead { tr { th { "direction" } th.count { "frames sent" } th.count { "dropped" } } }
                tbody { @for direction in rows { (row(direction)) } }
            }
        }
    }
}

fn strip(drops: &[LinkDrop]) -> Strip {
    let times = |side| {
        let of_side = drops.iter().filter(move |drop| drop.side == side);
        of_side.map(|drop| drop.t).collect()
    };
    Strip {
        title: "Frames dropped",
        rows: [Side::Camera, Side::Autopilot]
            .map(|side| (label(side), times(side)))
            .to_vec(),
    }
}

/// A row for each drop.
fn each(drops: &[LinkDrop]) -> Markup {
    html! {
        div.scroll { table.drops {
            thead { tr { th.count { "time, s" } th { "dropped by" } th { "message" } th { "why" } } }
            tbody { @for drop in drops { tr {
                td.count { (number::fixed(drop.t, 3)) }
                td { (label(drop.side)) }
                td.mono { (drop.message) }
                td { (drop.why) }
            } } }
        } }
    }
}

/// A row for each kind, the most frequent first.
fn folded(drops: &[LinkDrop]) -> Markup {
    let mut kinds = kinds(drops);
    kinds.sort_by_key(|kind| core::cmp::Reverse(kind.count));
    let left_out = kinds.len().saturating_sub(MOST_KINDS);
    html! {
        p.note {
            (number::grouped(drops.len() as u64)) " drops, folded by side, message and reason; each with its time is in the log below and in recording.json, link_drops."
            @if left_out > 0 { " " (number::grouped(left_out as u64)) " rare kinds are left out here." }
        }
        div.scroll { table.drops {
            thead { tr {
                th.count { "times" } th { "dropped by" } th { "message" } th { "why" }
                th.count { "first, s" } th.count { "last, s" }
            } }
            tbody { @for kind in kinds.iter().take(MOST_KINDS) { tr {
                td.count { (number::grouped(kind.count as u64)) }
                td { (label(kind.first.side)) }
                td.mono { (kind.first.message) }
                td { (kind.first.why) }
                td.count { (number::fixed(kind.first.t, 1)) }
                td.count { (number::fixed(kind.last.t, 1)) }
            } } }
        } }
    }
}

/// The kinds in the order of their first drop.
fn kinds(drops: &[LinkDrop]) -> Vec<Kind<'_>> {
    let mut kinds: Vec<Kind<'_>> = Vec::new();
    for drop in drops {
        let same = |kind: &&mut Kind<'_>| {
            kind.first.side == drop.side
                && kind.first.message == drop.message
                && kind.first.why == drop.why
        };
        match kinds.iter_mut().find(same) {
            Some(kind) => {
                kind.count += 1;
                kind.last = drop;
            }
            None => kinds.push(Kind {
                first: drop,
                last: drop,
                count: 1,
            }),
        }
    }
    kinds
}

fn label(side: Side) -> &'static str {
    match side {
        Side::Camera => "camera board",
        Side::Autopilot => "autopilot",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::ticks::Range;
    use crate::summary::LinkFigures;

    fn drop(t: f64, side: Side, message: &str, why: &str) -> LinkDrop {
        LinkDrop {
            t,
            side,
            message: message.into(),
            why: why.into(),
        }
    }

    fn page(drops: Vec<LinkDrop>) -> String {
        let recording = Recording {
            link_drops: drops,
            ..Recording::default()
        };
        let summary = Summary {
            link: LinkFigures {
                to_camera: DirectionFigures {
                    frames_sent: 1234,
                    frames_dropped: 5,
                },
                ..LinkFigures::default()
            },
            ..Summary::default()
        };
        let time = TimeAxis {
            range: Range {
                low: 0.0,
                high: 10.0,
            },
            phases: Vec::new(),
        };
        link(&recording, &summary, &time).into_string()
    }

    #[test]
    fn a_link_without_drops_says_so_beside_its_figures() {
        let page = page(Vec::new());
        assert!(page.contains("No frame of the link was dropped."));
        assert!(page.contains("autopilot → camera board</td><td class=\"count\">1\u{202f}234</td><td class=\"count\">5<"));
    }

    #[test]
    fn every_drop_is_named_with_time_side_message_and_reason() {
        let page = page(vec![
            drop(1.25, Side::Camera, "STATE", "checksum"),
            drop(2.5, Side::Autopilot, "?", "a <b> byte"),
        ]);
        for cell in [
            "1.250",
            "camera board",
            "STATE",
            "checksum",
            "2.500",
            "autopilot",
            "?",
            "a &lt;b&gt; byte",
        ] {
            assert!(page.contains(&format!(">{cell}</td>")), "{cell}");
        }
        assert!(!page.contains("No frame"));
    }

    #[test]
    fn many_drops_are_folded_with_their_counts_the_most_frequent_first() {
        let mut drops = vec![drop(0.5, Side::Camera, "STATE", "checksum")];
        drops.extend((0..70).map(|k| drop(1.0 + f64::from(k), Side::Autopilot, "MAP", "cut")));
        let page = page(drops);
        assert!(page.contains("71 drops, folded"));
        let (map, state) = (page.find(">MAP<"), page.find(">STATE<"));
        assert!(map < state && map.is_some());
        assert!(page.contains("<td class=\"count\">70</td>"));
        assert!(
            page.contains("<td class=\"count\">70.0</td>"),
            "the last one's time"
        );
    }
}
