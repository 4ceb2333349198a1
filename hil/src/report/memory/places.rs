//! The route memory where only the places of the snapshots are known.

use maud::{Markup, html};

use super::{hops, vectors};
use crate::record::{Recording, SnapshotMark};
use crate::report::number;

/// A row for each snapshot: where, when, and the vectors that lead back to it.
pub fn places(recording: &Recording) -> Markup {
    let snapshots = &recording.snapshots;
    let before = snapshots
        .first()
        .map_or(usize::MAX, |first| usize::from(first.odometry_count));
    let unseen = usize::from(recording.odometry_stored).saturating_sub(recording.odometry.len());
    let first = vectors(&recording.odometry, 0, before);
    html! {
        p.note {
            "The coefficients of the snapshots are not known. A place is where the snapshot was believed to be; the vectors are those that lead back to it, in the order in which they are followed."
            @if unseen > 0 { " " (unseen) " of the vectors were not seen to be followed one by one and are not listed." }
        }
        div.scroll { table.drops {
            thead { tr {
                th.count { "snapshot" } th.count { "at, s" } th.count { "x, m" } th.count { "y, m" }
                th.count { "vectors below" } th { "vectors back to it: x, y in m" }
            } }
            tbody {
                @if !first.is_empty() {
                    tr { td colspan="5" { "before the first snapshot" } td.hops.mono { (hops(&first)) } }
                }
                @for (place, mark) in snapshots.iter().enumerate() {
                    @let above = snapshots.get(place + 1).map_or(usize::MAX, |next| usize::from(next.odometry_count));
                    (row(mark, recording, above))
                }
            }
        } }
    }
}

fn row(mark: &SnapshotMark, recording: &Recording, above: usize) -> Markup {
    let back = vectors(&recording.odometry, usize::from(mark.odometry_count), above);
    html! {
        tr {
            td.count { (mark.index) }
            td.count { (number::fixed(mark.t, 1)) }
            td.count { (number::fixed(mark.believed.x, 2)) }
            td.count { (number::fixed(mark.believed.y, 2)) }
            td.count { (mark.odometry_count) }
            td.hops.mono { (hops(&back)) }
        }
    }
}
