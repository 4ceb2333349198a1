//! Numbers and paths as SVG wants them: short, fixed in precision, never NaN.

/// Largest coordinate written, user units. Renderers hold coordinates in single precision.
const COORDINATE_LIMIT: f64 = 1.0e6;

/// A point in user units: x to the right, y down.
pub type Point = [f64; 2];

/// A coordinate with one decimal, without a trailing `.0`; what is not finite becomes 0.
pub fn px(value: f64) -> String {
    let value = if value.is_finite() { value } else { 0.0 };
    let text = format!("{:.1}", value.clamp(-COORDINATE_LIMIT, COORDINATE_LIMIT));
    match text.strip_suffix(".0") {
        Some("-0") => "0".to_owned(),
        Some(whole) => whole.to_owned(),
        None => text,
    }
}

/// Path data of a polyline. A point that is not finite lifts the pen.
pub fn polyline(points: impl IntoIterator<Item = Point>) -> String {
    let mut data = String::new();
    let mut pen_down = false;
    for point in points {
        if !is_finite(point) {
            pen_down = false;
            continue;
        }
        data.push(if pen_down { 'L' } else { 'M' });
        data.push_str(&px(point[0]));
        data.push(' ');
        data.push_str(&px(point[1]));
        pen_down = true;
    }
    data
}

/// Leaves out the points nearer than `step` to the last one kept; ends and gaps stay.
pub fn thin(points: impl IntoIterator<Item = Point>, step: f64) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::new();
    let mut skipped = None;
    for point in points {
        let near = kept
            .last()
            .is_some_and(|last| distance(*last, point) < step);
        if near {
            skipped = Some(point);
            continue;
        }
        if !is_finite(point) {
            kept.extend(skipped);
        }
        kept.push(point);
        skipped = None;
    }
    kept.extend(skipped);
    kept
}

/// Reduces a curve whose x ascends to the extremes of each of `buckets` equal slices of `span`,
/// so that no peak is lost. A point that is not finite stays as a gap.
pub fn decimate(points: &[Point], span: [f64; 2], buckets: usize) -> Vec<Point> {
    if points.len() <= 2 * buckets {
        return points.to_vec();
    }
    let width = (span[1] - span[0]) / buckets as f64;
    let bucket = |point: &Point| ((point[0] - span[0]) / width) as i64;
    points
        .chunk_by(|a, b| is_finite(*a) == is_finite(*b) && bucket(a) == bucket(b))
        .flat_map(extremes)
        .collect()
}

/// The lowest and the highest point, in the order of the curve.
fn extremes(chunk: &[Point]) -> impl Iterator<Item = Point> + use<> {
    let by_y = |a: &(usize, &Point), b: &(usize, &Point)| a.1[1].total_cmp(&b.1[1]);
    let low = chunk.iter().enumerate().min_by(by_y);
    let high = chunk.iter().enumerate().max_by(by_y);
    let mut ends: Vec<usize> = low
        .into_iter()
        .chain(high)
        .map(|(index, _)| index)
        .collect();
    ends.sort_unstable();
    ends.dedup();
    let ends: Vec<Point> = ends.into_iter().map(|index| chunk[index]).collect();
    ends.into_iter()
}

/// Whether both coordinates are numbers that can be drawn.
pub fn is_finite(point: Point) -> bool {
    point[0].is_finite() && point[1].is_finite()
}

/// Distance of two points.
pub fn distance(a: Point, b: Point) -> f64 {
    libm::hypot(a[0] - b[0], a[1] - b[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_are_short_and_never_nan() {
        assert_eq!(px(12.0), "12");
        assert_eq!(px(12.34), "12.3");
        assert_eq!(px(-0.04), "0");
        assert_eq!(px(f64::NAN), "0");
        assert_eq!(px(f64::INFINITY), "0");
    }

    #[test]
    fn a_point_that_is_not_finite_lifts_the_pen() {
        let points = [
            [0.0, 0.0],
            [1.0, 0.0],
            [f64::NAN, 1.0],
            [2.0, 2.0],
            [3.0, 2.0],
        ];
        assert_eq!(polyline(points), "M0 0L1 0M2 2L3 2");
    }

    #[test]
    fn thinning_keeps_both_ends() {
        let line = (0..=100).map(|i| [f64::from(i) * 0.1, 0.0]);
        let thinned = thin(line, 0.95);
        assert!(thinned.len() < 15);
        assert_eq!(thinned[0], [0.0, 0.0]);
        assert_eq!(thinned[thinned.len() - 1], [10.0, 0.0]);
    }

    #[test]
    fn decimation_keeps_a_single_peak_among_thousands() {
        let mut points: Vec<Point> = (0..9000).map(|i| [f64::from(i), 1.0]).collect();
        points[4321][1] = 99.0;
        let kept = decimate(&points, [0.0, 9000.0], 100);
        assert!(kept.len() <= 200);
        assert!(kept.contains(&[4321.0, 99.0]));
    }
}
