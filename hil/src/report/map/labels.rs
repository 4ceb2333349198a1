//! Numbers beside dots, placed one after the other where they hide neither a dot nor a number.

use crate::report::svg::{Point, is_finite};

/// Half the height of a number, user units.
const HALF_HEIGHT: f64 = 4.5;
/// Half the width of a digit.
const HALF_DIGIT: f64 = 3.2;
/// Radius that a dot keeps free.
const DOT: f64 = 4.0;

/// Radius that another mark keeps free.
const MARK: f64 = 8.0;

/// Where a number may stand around its dot, best first: rings of eight directions.
fn offsets(half_width: f64) -> impl Iterator<Item = Point> {
    const DIRECTIONS: [Point; 8] = [
        [0.75, -0.75],
        [0.75, 0.75],
        [-0.75, -0.75],
        [-0.75, 0.75],
        [1.0, 0.0],
        [-1.0, 0.0],
        [0.0, -1.0],
        [0.0, 1.0],
    ];
    [2.0, 9.0, 17.0].into_iter().flat_map(move |gap| {
        DIRECTIONS
            .into_iter()
            .map(move |[x, y]| [x * (DOT + gap + half_width), y * (DOT + gap + HALF_HEIGHT)])
    })
}

/// The middle of each number, none for those that find no room. `marks` are other things not to
/// be hidden.
pub fn place(dots: &[(Point, u16)], marks: &[Point]) -> Vec<Option<Point>> {
    let mut placed: Vec<(Point, f64)> = Vec::new();
    dots.iter()
        .map(|(dot, number)| {
            if !is_finite(*dot) {
                return None;
            }
            let half_width = HALF_DIGIT * number.to_string().len() as f64;
            let is_free = |spot: &Point| {
                let hides_dot = dots
                    .iter()
                    .any(|(other, _)| overlap(*spot, *other, half_width + DOT, HALF_HEIGHT + DOT));
                let hides_mark = marks
                    .iter()
                    .any(|mark| overlap(*spot, *mark, half_width + MARK, HALF_HEIGHT + MARK));
                let hides_number = placed.iter().any(|(other, other_width)| {
                    overlap(
                        *spot,
                        *other,
                        half_width + other_width + 1.0,
                        2.0 * HALF_HEIGHT + 1.0,
                    )
                });
                !hides_dot && !hides_mark && !hides_number
            };
            let spot = offsets(half_width)
                .map(|[x, y]| [dot[0] + x, dot[1] + y])
                .find(is_free)?;
            placed.push((spot, half_width));
            Some(spot)
        })
        .collect()
}

fn overlap(a: Point, b: Point, width: f64, height: f64) -> bool {
    (a[0] - b[0]).abs() < width && (a[1] - b[1]).abs() < height
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_dots_close_together_do_not_overlap() {
        let dots: Vec<(Point, u16)> = (0..6).map(|i| ([f64::from(i) * 3.0, 0.0], i)).collect();
        let spots: Vec<Point> = place(&dots, &[]).into_iter().flatten().collect();
        assert!(spots.len() >= 4);
        for (index, a) in spots.iter().enumerate() {
            for b in &spots[index + 1..] {
                assert!(!overlap(*a, *b, 2.0 * HALF_DIGIT, 2.0 * HALF_HEIGHT));
            }
        }
    }

    #[test]
    fn a_dot_that_is_nowhere_gets_no_number() {
        assert_eq!(place(&[([f64::NAN, 0.0], 0)], &[]), [None]);
    }
}
