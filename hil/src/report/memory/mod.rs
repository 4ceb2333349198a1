//! The route memory byte by byte: snapshots, odometry counts, odometry vectors.

mod places;
mod totals;

use maud::{Markup, html};
use nav::snapshot::COUNT_LUMA;
use nav::spectrum::STORED_FREQUENCIES;

use super::svg::px;
use super::{horizon, number};
use crate::record::{OdometryMark, Recording, Reference, SnapshotMark};

/// Metres of one count of an odometry vector (van Dijk et al. 2024, Fig. 8).
const METRES_PER_COUNT: f64 = 0.1;
/// Size of the bars above the bytes: user units per byte, and in height.
const BAR: [f64; 2] = [10.0, 30.0];

/// What all rows have in common, so that they can be compared.
#[derive(Clone, Copy)]
struct Scale {
    /// Columns of bytes.
    coefficients: usize,
    /// Count of the longest bar.
    largest: f64,
    /// Deviation of the horizon that is black or white, luma.
    full: f64,
    /// Whether the true places are known.
    is_truth: bool,
}

/// Totals, then every snapshot with the vectors that lead back to it.
pub fn memory(recording: &Recording, outbound_m: f64) -> Markup {
    if recording.memory().with_counts() == 0 {
        return html! { p { "Nothing was stored." } };
    }
    let snapshots = &recording.snapshots;
    let unseen = usize::from(recording.odometry_stored).saturating_sub(recording.odometry.len());
    let largest = largest_count(snapshots);
    let full = horizon::largest_deviation(snapshots.iter().map(|mark| &mark.coefficients[..]));
    let coefficients = snapshots
        .iter()
        .map(|mark| mark.coefficients.len())
        .max()
        .unwrap_or(0);
    if coefficients == 0 && recording.reference == Reference::Estimate {
        return html! { (totals::totals(recording, outbound_m)) (places::places(recording)) };
    }
    let is_truth = recording.reference == Reference::Truth;
    html! {
        (totals::totals(recording, outbound_m))
        p.note {
            "Each snapshot is a row: its coefficients as bars, as bytes, and as signed numbers. The remembered horizon is drawn from them alone "
            "(one count is " (number::fixed(COUNT_LUMA[0].into(), 2)) " luma at the first frequency and " (number::fixed(COUNT_LUMA[STORED_FREQUENCIES - 1].into(), 2)) " at the last; the mean is not stored). "
            "The count is the height of the odometry stack, low byte first; the vectors are those that lead back to the snapshot, in the order in which they are followed. "
            @if is_truth { "“Off” is how far the drone was from where it believed it was." }
            @if unseen > 0 {
                " " (unseen) " of the vectors are not listed: they were not followed, or several were left behind in one step."
            }
        }
        div.scroll { table.memory {
            (header(coefficients))
            @if let Some(first) = snapshots.first() {
                @let before = vectors(&recording.odometry, 0, usize::from(first.odometry_count));
                @if !before.is_empty() { (row_without_snapshot(&before, coefficients)) }
            }
            @for (place, mark) in snapshots.iter().enumerate() {
                @let above = snapshots.get(place + 1).map_or(usize::MAX, |next| usize::from(next.odometry_count));
                @let vectors = vectors(&recording.odometry, usize::from(mark.odometry_count), above);
                (row(mark, &vectors, Scale { coefficients, largest, full, is_truth }))
            }
            @if snapshots.is_empty() {
                (row_without_snapshot(&vectors(&recording.odometry, 0, usize::MAX), coefficients))
            }
        } }
    }
}

fn header(coefficients: usize) -> Markup {
    let half = coefficients / 2;
    html! {
        thead { tr {
            th { "snapshot" }
            th.strip { "remembered horizon" div.compass { @for wind in ["S", "W", "N", "E", "S"] { span { (wind) } } } }
            @for index in 0..coefficients {
                th class=(byte_class(index, half)) {
                    @if index < half { "a" sub { (index + 1) } } @else { "b" sub { (index + 1 - half) } }
                }
            }
            th.b1 { "count" br; "2 B" }
            th { "vectors back to it" br; "2 B each: x, y in m" }
        } }
    }
}

/// One snapshot: bars, bytes, and the same bytes as signed numbers.
fn row(mark: &SnapshotMark, vectors: &[OdometryMark], scale: Scale) -> Markup {
    let half = mark.coefficients.len() / 2;
    let count = mark.odometry_count.to_le_bytes();
    html! {
        tbody {
            tr {
                td.who rowspan="3" {
                    b { (mark.index) } br;
                    span {
                        (number::fixed(mark.truth.x, 2)) ", " (number::fixed(mark.truth.y, 2)) " m" br;
                        "at " (number::fixed(mark.t, 1)) " s" br;
                        @if scale.is_truth { (number::fixed(mark.believed.distance(&mark.truth), 2)) " m off" }
                    }
                }
                td.strip rowspan="3" { (horizon::glyph(&mark.coefficients, scale.full)) }
                td.bars colspan=(scale.coefficients) { (bars(&mark.coefficients, scale.largest)) }
                td.mono.b1 rowspan="3" {
                    (number::hex(count[0])) " " (number::hex(count[1])) br;
                    span.low { (mark.odometry_count) }
                }
                td.hops.mono rowspan="3" { (hops(vectors)) }
            }
            tr { @for (index, value) in mark.coefficients.iter().enumerate() {
                td class=(format!("mono {}", byte_class(index, half))) { (number::hex(value.to_le_bytes()[0])) }
            } }
            tr { @for (index, value) in mark.coefficients.iter().enumerate() {
                td class=(format!("mono low {}", byte_class(index, half))) { (number::signed(*value)) }
            } }
        }
    }
}

/// Largest magnitude of a coefficient, at least 1.
fn largest_count(snapshots: &[SnapshotMark]) -> f64 {
    let counts = snapshots.iter().flat_map(|mark| &mark.coefficients);
    counts
        .map(|count| f64::from(*count).abs())
        .fold(1.0, f64::max)
}

/// Vectors that no snapshot was taken before.
fn row_without_snapshot(vectors: &[OdometryMark], coefficients: usize) -> Markup {
    html! {
        tbody { tr {
            td.who colspan=(coefficients + 3) { span { "before the first snapshot" } }
            td.hops.mono { (hops(vectors)) }
        } }
    }
}

fn byte_class(index: usize, half: usize) -> &'static str {
    if index == 0 || index == half {
        "byte b1"
    } else {
        "byte"
    }
}

/// A bar for each byte, upwards if positive.
fn bars(coefficients: &[i8], largest: f64) -> Markup {
    let [width, height] = BAR;
    let middle = height / 2.0;
    let bars: String = coefficients
        .iter()
        .enumerate()
        .map(|(index, value)| {
            let x = index as f64 * width + width * 0.28;
            let bar = -f64::from(*value) / largest * middle;
            format!(
                "M{} {}h{}v{}h-{}z",
                px(x),
                px(middle),
                px(width * 0.44),
                px(bar),
                px(width * 0.44)
            )
        })
        .collect();
    let all = coefficients.len() as f64 * width;
    html! {
        svg viewBox=(format!("0 0 {} {}", px(all), px(height))) preserveAspectRatio="none" aria-hidden="true" {
            path class="hair s-grid" d=(format!("M0 {}H{}", px(middle), px(all))) {}
            path class="f-homing" d=(bars) {}
        }
    }
}

/// The vectors with `from <= index < to`, newest first, as they are followed.
fn vectors(odometry: &[OdometryMark], from: usize, to: usize) -> Vec<OdometryMark> {
    let belongs = |mark: &&OdometryMark| (from..to).contains(&usize::from(mark.index));
    odometry.iter().filter(belongs).copied().collect()
}

fn hops(vectors: &[OdometryMark]) -> Markup {
    html! {
        @for vector in vectors {
            @let [x, y] = vector.counts;
            div {
                (number::hex(x.to_le_bytes()[0])) " " (number::hex(y.to_le_bytes()[0])) " "
                span { (metres(x)) ", " (metres(y)) }
            }
        }
    }
}

fn metres(counts: i8) -> String {
    number::fixed(f64::from(counts) * METRES_PER_COUNT, 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_vectors_back_to_a_snapshot_are_those_stored_after_it_newest_first() {
        let mark = |index| OdometryMark {
            index,
            counts: [0, 0],
        };
        let odometry: Vec<OdometryMark> = (0..5).rev().map(mark).collect();
        let back: Vec<u16> = vectors(&odometry, 2, 4)
            .iter()
            .map(|mark| mark.index)
            .collect();
        assert_eq!(back, [3, 2]);
    }

    #[test]
    fn bars_of_positive_counts_rise_and_of_negative_counts_fall() {
        let svg = bars(&[64, -128], 128.0).into_string();
        assert!(svg.contains("v-7.5h") && svg.contains("v15h"));
    }
}
