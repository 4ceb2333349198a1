//! The algorithm of Ramer, Douglas and Peucker on odometry vectors, in place.

use super::VECTOR_CAPACITY;
use super::vector::{ODOMETRY_RESOLUTION_M, OdometryVector, pieces};

/// A set of the vertices that stay. Vertex i is the end of vector i.
struct Kept([u32; Self::WORDS]);

impl Kept {
    const WORDS: usize = VECTOR_CAPACITY.div_ceil(32);

    fn insert(&mut self, vertex: usize) {
        if let Some(word) = self.0.get_mut(vertex / 32) {
            *word |= 1 << (vertex % 32);
        }
    }

    fn contains(&self, vertex: usize) -> bool {
        self.0
            .get(vertex / 32)
            .is_some_and(|word| word >> (vertex % 32) & 1 == 1)
    }
}

/// Replaces a polyline by one through fewer of its vertices, from which no dropped vertex is farther
/// than the tolerance, metres. Both ends stay. Returns how many vectors at the front of `part` are left.
pub(super) fn simplify(part: &mut [OdometryVector], tolerance_m: f32) -> usize {
    let tolerance = tolerance_m / ODOMETRY_RESOLUTION_M;
    let Some(last) = part.len().checked_sub(1) else {
        return 0;
    };
    let mut kept = Kept([0; Kept::WORDS]);
    kept.insert(last);
    // The recursion needs no stack: what is kept already bounds the segments still to be looked at.
    let mut start = 0;
    while start <= last {
        let end = (start..=last).find(|&v| kept.contains(v)).unwrap_or(last);
        let farthest = |chain| farthest(chain, tolerance);
        match part.get(start..=end).and_then(farthest) {
            Some(offset) => kept.insert(start + offset),
            None => start = end + 1,
        }
    }
    merge(part, &kept)
}

/// The vertex farthest from the segment that `chain` spans, if farther than the tolerance, counts.
fn farthest(chain: &[OdometryVector], tolerance: f32) -> Option<usize> {
    let (mut end_x, mut end_y) = (0, 0);
    for vector in chain {
        end_x += i32::from(vector.x);
        end_y += i32::from(vector.y);
    }
    let (mut x, mut y) = (0, 0);
    let mut worst = (None, tolerance * tolerance);
    let inner = chain.split_last().map_or(chain, |(_, inner)| inner);
    for (index, vector) in inner.iter().enumerate() {
        x += i32::from(vector.x);
        y += i32::from(vector.y);
        let squared = squared_distance((x as f32, y as f32), (end_x as f32, end_y as f32));
        if squared > worst.1 {
            worst = (Some(index), squared);
        }
    }
    worst.0
}

/// The squared distance of a point from the segment between the origin and `end`.
fn squared_distance(point: (f32, f32), end: (f32, f32)) -> f32 {
    let length = end.0 * end.0 + end.1 * end.1;
    let along = if length > 0.0 {
        ((point.0 * end.0 + point.1 * end.1) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let (dx, dy) = (point.0 - along * end.0, point.1 - along * end.1);
    dx * dx + dy * dy
}

/// Sums the vectors up to each vertex that stays and writes the sums to the front.
fn merge(part: &mut [OdometryVector], kept: &Kept) -> usize {
    let mut written = 0;
    let mut sum = [0, 0];
    for vertex in 0..part.len() {
        sum[0] += i32::from(part[vertex].x);
        sum[1] += i32::from(part[vertex].y);
        if kept.contains(vertex) {
            // A sum of n vectors takes at most n: the writing never overtakes the reading.
            for (slot, piece) in part.iter_mut().skip(written).zip(pieces(sum)) {
                *slot = piece;
                written += 1;
            }
            sum = [0, 0];
        }
    }
    written
}
