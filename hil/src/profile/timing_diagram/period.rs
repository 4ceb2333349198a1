//! Which stretch of a time line is drawn.

use super::super::timeline::{Slice, Track};
use crate::report::ticks::Range;

/// From the start of a frame to that of the next, microseconds of the flight; everything, where there
/// are not two frames. The first frame of a window may have begun before anything else was looked at.
pub(super) fn busiest(slices: &[Slice]) -> Range {
    let of = |track| slices.iter().filter(move |slice| slice.track == track);
    let rest = slices.iter().filter(|slice| slice.track != Track::Camera);
    let opens_us = rest
        .map(|slice| slice.from_us)
        .fold(f64::INFINITY, f64::min);
    let starts = of(Track::Camera).map(|frame| frame.from_us);
    let mut starts: Vec<f64> = starts.filter(|start_us| *start_us >= opens_us).collect();
    starts.sort_by(f64::total_cmp);
    let periods = starts.windows(2).map(|ends| Range {
        low: ends[0],
        high: ends[1],
    });
    let stages = |period: &Range| {
        let stages = of(Track::Stages).filter(|stage| period.contains(stage.from_us));
        let mut names: Vec<&str> = stages.map(|stage| stage.name.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        names.len()
    };
    // Of equals, `max_by_key` takes the last.
    let busiest = periods.rev().max_by_key(stages);
    let ends = |slice: &Slice| [slice.from_us, slice.from_us + slice.for_us];
    busiest
        .or_else(|| Range::of(slices.iter().flat_map(ends)))
        .unwrap_or(Range {
            low: 0.0,
            high: 1.0,
        })
}

/// The longest stage of a period with some room about it: the look at the frame.
pub(super) fn look(slices: &[Slice], period: Range) -> Option<Range> {
    /// Of its length, on either side.
    const ROOM: f64 = 0.3;
    let stages = slices
        .iter()
        .filter(|slice| slice.track == Track::Stages && period.contains(slice.from_us));
    let look = stages.max_by(|a, b| a.for_us.total_cmp(&b.for_us))?;
    let room = ROOM * look.for_us;
    (room > 0.0).then_some(Range {
        low: look.from_us - room,
        high: look.from_us + look.for_us + room,
    })
}

#[cfg(test)]
mod tests {
    use super::super::slice;
    use super::*;

    #[test]
    fn the_first_whole_one_of_the_periods_with_most_stages_is_shown() {
        let frames = [-39_000.0, 0.0, 39_000.0, 78_000.0, 117_000.0];
        let mut slices: Vec<Slice> = frames
            .map(|start| slice(Track::Camera, "frame", start, 30_000.0))
            .into();
        // The window opens amid the first frame, whose end it shows.
        slices.push(slice(Track::Stages, "unwrap", -6_000.0, 100.0));
        slices.push(slice(Track::Stages, "align", -5_000.0, 20.0));
        for (name, at, long) in [
            ("unwrap", 33_000.0, 100.0),
            ("unwrap", 72_000.0, 100.0),
            ("align", 73_000.0, 20.0),
            ("unwrap", 111_000.0, 100.0),
            ("align", 112_000.0, 20.0),
        ] {
            slices.push(slice(Track::Stages, name, at, long));
        }
        let period = busiest(&slices);
        assert_eq!((period.low, period.high), (39_000.0, 78_000.0));
        let close = look(&slices, period).expect("a stage");
        assert!(close.contains(72_000.0) && close.contains(72_100.0));
        assert!(close.span() < 200.0);
    }
}
