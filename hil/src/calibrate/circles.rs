//! Circles through points of which some belong to something else.

/// Edge points on one circle, pixels.
pub type Points = Vec<[f64; 2]>;

/// Steps of the fit; it has settled long before.
const STEPS: usize = 20;

/// Points nearer to the circle than this many standard deviations are its own; the deviation is taken
/// from the median, which strangers hardly move.
const TRIM_DEVIATIONS: f64 = 2.5;

/// The median absolute deviation of a normal distribution in standard deviations, inverted.
const DEVIATIONS_PER_MEDIAN: f64 = 1.482_6;

/// Points nearer than this are kept whatever the deviation: a fifth of a pixel is the edges' own.
const KEPT_PX: f64 = 0.2;

/// Points nearer to a circle than this agree with it: what the softness of an edge is worth, pixels.
const AGREEMENT_PX: f64 = 0.5;

/// Gaps between the three points of a trial, as parts of all points: with whatever stands in one quarter
/// of the view some trials have nothing to do.
const TRIAL_GAPS: [usize; 3] = [3, 4, 6];

/// Circles about one centre.
#[derive(Clone, Debug, PartialEq)]
pub struct Circles<const N: usize> {
    /// Their centre.
    pub centre: [f64; 2],
    /// Each one's radius and fit.
    pub rings: [Ring; N],
}

/// One circle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ring {
    /// Its radius, pixels.
    pub radius_px: f64,
    /// How many points it goes through.
    pub points: usize,
    /// How far from it they are, pixels RMS.
    pub rms_px: f64,
}

/// The centre of the circle that most points agree on, of the circles through three of them: random
/// sample consensus (Fischler and Bolles 1981), with the samples taken in turn instead of by chance.
/// The points are in the order of their angle. None where no three of them lie on a circle.
pub fn consensus(points: &[[f64; 2]]) -> Option<[f64; 2]> {
    let count = points.len();
    let trials = TRIAL_GAPS.into_iter().flat_map(|part| {
        (0..count).filter_map(move |first| {
            let point = |n: usize| points[(first + n * (count / part)) % count];
            centre_of([point(0), point(1), point(2)]).map(|centre| (centre, point(0)))
        })
    });
    let agreeing = |(centre, on): &([f64; 2], [f64; 2])| {
        let off = |point: &&[f64; 2]| (distance(point, centre) - distance(on, centre)).abs();
        let near = points.iter().filter(|point| off(point) < AGREEMENT_PX);
        near.count()
    };
    let best = trials.max_by_key(agreeing);
    best.map(|(centre, _)| centre)
}

/// The centre of the circle through three points; none where they lie on a line.
fn centre_of([a, b, c]: [[f64; 2]; 3]) -> Option<[f64; 2]> {
    let [b, c] = [b, c].map(|point| [point[0] - a[0], point[1] - a[1]]);
    let cross = 2.0 * (b[0] * c[1] - b[1] * c[0]);
    let [b2, c2] = [b, c].map(|[x, y]| x * x + y * y);
    (cross.abs() > 1.0).then(|| {
        [
            a[0] + (c[1] * b2 - b[1] * c2) / cross,
            a[1] + (b[0] * c2 - c[0] * b2) / cross,
        ]
    })
}

/// How far two points are apart.
pub fn distance(a: &[f64; 2], b: &[f64; 2]) -> f64 {
    libm::hypot(a[0] - b[0], a[1] - b[1])
}

/// The circles about one centre, each through the points of its own set, in the sense of trimmed least
/// squares: in each step the points far from their circle are set aside, and centre and radii move to
/// where the mean square distance of the others is least (Gauss-Newton). `None` where too few points
/// are left, or all on one side.
pub fn concentric<const N: usize>(
    sets: [&[[f64; 2]]; N],
    mut centre: [f64; 2],
) -> Option<Circles<N>> {
    let mut rings = [Ring::default(); N];
    for _ in 0..STEPS {
        let mut normal = Normal::default();
        for (ring, points) in rings.iter_mut().zip(sets) {
            let kept = trimmed(points, centre)?;
            *ring = normal.add(&kept, centre);
        }
        let step = normal.solve()?;
        centre = [centre[0] + step[0], centre[1] + step[1]];
    }
    for (ring, points) in rings.iter_mut().zip(sets) {
        *ring = Normal::default().add(&trimmed(points, centre)?, centre);
    }
    Some(Circles { centre, rings })
}

/// The points that lie on the circle about this centre on which most of them lie.
fn trimmed(points: &[[f64; 2]], centre: [f64; 2]) -> Option<Points> {
    let radii = points.iter().map(|point| distance(point, &centre));
    let middle = median(radii.collect())?;
    let off = |point: &[f64; 2]| (distance(point, &centre) - middle).abs();
    let deviation = DEVIATIONS_PER_MEDIAN * median(points.iter().map(off).collect())?;
    let limit = (TRIM_DEVIATIONS * deviation).max(KEPT_PX);
    let kept = points.iter().filter(|point| off(point) <= limit);
    Some(kept.copied().collect())
}

/// The median; none of nothing.
pub fn median(mut values: Vec<f64>) -> Option<f64> {
    let middle = values.len() / 2;
    if values.is_empty() {
        return None;
    }
    let (_, median, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    Some(*median)
}

/// The normal equations of the step of the centre; each circle's radius is eliminated: it is the mean
/// distance.
#[derive(Default)]
struct Normal {
    xx: f64,
    xy: f64,
    yy: f64,
    x: f64,
    y: f64,
}

impl Normal {
    fn add(&mut self, points: &[[f64; 2]], centre: [f64; 2]) -> Ring {
        let polar: Vec<[f64; 3]> = points
            .iter()
            .map(|point| {
                let [dx, dy] = [point[0] - centre[0], point[1] - centre[1]];
                let distance = libm::hypot(dx, dy).max(f64::MIN_POSITIVE);
                [dx / distance, dy / distance, distance]
            })
            .collect();
        let count = polar.len().max(1) as f64;
        let mean = |axis: usize| polar.iter().map(|point| point[axis]).sum::<f64>() / count;
        let [mean_x, mean_y, radius_px] = [mean(0), mean(1), mean(2)];
        let mut squares = 0.0;
        for [x, y, distance] in &polar {
            let [x, y, off] = [x - mean_x, y - mean_y, distance - radius_px];
            self.xx += x * x;
            self.xy += x * y;
            self.yy += y * y;
            self.x += x * off;
            self.y += y * off;
            squares += off * off;
        }
        Ring {
            radius_px,
            points: polar.len(),
            rms_px: (squares / count).sqrt(),
        }
    }

    fn solve(&self) -> Option<[f64; 2]> {
        let determinant = self.xx * self.yy - self.xy * self.xy;
        // Of points all round, n of them, it is n^2 / 4.
        (determinant > 1.0).then(|| {
            [
                (self.x * self.yy - self.y * self.xy) / determinant,
                (self.y * self.xx - self.x * self.xy) / determinant,
            ]
        })
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::TAU;

    use super::*;

    fn circle(centre: [f64; 2], radius: f64, count: usize) -> Points {
        (0..count)
            .map(|n| {
                let (sin, cos) = libm::sincos(n as f64 * TAU / count as f64);
                [centre[0] + radius * cos, centre[1] + radius * sin]
            })
            .collect()
    }

    #[test]
    fn two_circles_are_found_exactly_from_a_centre_that_is_off() {
        let (inner, outer) = (
            circle([66.2, 45.7], 16.5, 90),
            circle([66.2, 45.7], 43.5, 60),
        );
        let found = concentric([&inner, &outer], [64.0, 48.0]).expect("two circles");
        assert!((found.centre[0] - 66.2).abs() < 1e-9 && (found.centre[1] - 45.7).abs() < 1e-9);
        assert!((found.rings[0].radius_px - 16.5).abs() < 1e-9);
        assert!((found.rings[1].radius_px - 43.5).abs() < 1e-9);
        assert_eq!((found.rings[0].points, found.rings[1].points), (90, 60));
    }

    #[test]
    fn a_third_of_strangers_does_not_move_the_circle() {
        let mut points = circle([60.0, 50.0], 20.0, 100);
        // An arc of something else, two to six pixels outside.
        points.extend(circle([62.0, 50.0], 24.0, 200).into_iter().take(50));
        points.sort_by(|a, b| {
            let angle = |point: &[f64; 2]| libm::atan2(point[1] - 50.0, point[0] - 60.0);
            angle(a).total_cmp(&angle(b))
        });
        let start = consensus(&points).expect("points that agree");
        let found = concentric([&points], start).expect("a circle");
        assert!(distance(&found.centre, &[60.0, 50.0]) < 0.05);
        assert!((found.rings[0].radius_px - 20.0).abs() < 0.05);
    }

    #[test]
    fn points_on_one_side_make_no_circle() {
        assert_eq!(concentric([&[[1.0, 1.0]; 30]], [0.0, 0.0]), None);
        assert_eq!(concentric([&[]], [0.0, 0.0]), None);
        assert_eq!(consensus(&[[1.0, 1.0]; 30]), None);
        assert_eq!(consensus(&[]), None);
    }
}
