//! What the route memory is made of, in bytes.

use maud::{Markup, html};

use crate::record::Recording;
use crate::report::number;

/// The sums with and without the counts, and the share of each kind as a bar.
pub fn totals(recording: &Recording, outbound_m: f64) -> Markup {
    let shares = recording.memory();
    let per_metre = |bytes: usize| number::fixed(bytes as f64 / outbound_m, 1);
    let bytes = |bytes: usize| number::grouped(bytes as u64);
    let rows = [
        (
            "b-snapshot",
            shares.snapshots,
            "snapshots",
            recording.snapshots.len(),
        ),
        (
            "b-count",
            shares.counts,
            "odometry counts",
            recording.snapshots.len(),
        ),
        (
            "b-vector",
            shares.vectors,
            "odometry vectors",
            usize::from(recording.odometry_stored),
        ),
    ];
    html! {
        p {
            b { (bytes(shares.with_counts())) " bytes" }
            " with the odometry counts, " (per_metre(shares.with_counts())) " for each metre of the way out; "
            b { (bytes(shares.without_counts())) " bytes" }
            " without, " (per_metre(shares.without_counts())) " per metre."
        }
        div.shares aria-hidden="true" {
            @for (class, share, _, _) in rows {
                @if share > 0 { span class=(class) style=(format!("flex:{share}")) {} }
            }
        }
        ul.key {
            @for (class, share, label, count) in rows {
                li { i class=(class) {} (count) " " (label) ": " (bytes(share)) " B" }
            }
        }
    }
}
