//! The route memory of the paper (Fig. 8): two stacks, one of odometry vectors, one of snapshots.
//!
//! A snapshot knows how many odometry vectors lay below it when it was taken; its position is their
//! sum. Following the route pops both stacks until they are empty: the way back needs no search.

mod entry;
mod simplify;
mod snapshots;
mod vector;

use heapless::Vec;
use nalgebra::Point2;

use crate::snapshot::{SnapshotFormat, StoredView};
use crate::spectrum::Spectrum;
use snapshots::HEIGHT_BYTES;
pub use snapshots::{SNAPSHOT_STACK_BYTES, SnapshotStack};
pub use vector::{ODOMETRY_RESOLUTION_M, OdometryVector};
use vector::{pieces, pieces_needed};

/// Odometry vectors that fit: four a snapshot (the paper counts 2 to 3), or 600 m of recording by
/// odometry alone, which never simplifies.
pub const VECTOR_CAPACITY: usize = 2048;
/// A vector is stored each time the drone is this far from the sum of those stored (paper, "Route
/// memory").
pub const VECTOR_SPACING_M: f32 = 0.3;
/// What the simplification of Ramer, Douglas and Peucker may deviate (paper, "Route memory").
pub const SIMPLIFY_TOLERANCE_M: f32 = 0.1;

/// A snapshot on its stack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StoredSnapshot {
    /// The view.
    pub view: StoredView,
    /// Odometry vectors below it.
    pub height: u16,
}

/// The route does not fit. Nothing of what was to be stored has been.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RouteFull;

/// The two stacks, and the place where the route began.
#[derive(Clone, Debug)]
pub struct Route {
    origin: Point2<f32>,
    vectors: Vec<OdometryVector, VECTOR_CAPACITY>,
    snapshots: SnapshotStack,
    /// The sum of all vectors, counts of 0.1 m.
    tip: [i32; 2],
    /// The vector that was taken off last: from the tip to where the drone set out for it.
    popped: OdometryVector,
}

impl Route {
    /// An empty route.
    pub const fn new() -> Self {
        Self {
            origin: Point2::new(0.0, 0.0),
            vectors: Vec::new(),
            snapshots: SnapshotStack::new(SnapshotFormat::Paper),
            tip: [0; 2],
            popped: OdometryVector { x: 0, y: 0 },
        }
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.vectors.clear();
        self.snapshots.clear();
        self.tip = [0; 2];
        self.popped = OdometryVector::default();
    }

    /// Whether both stacks are empty.
    pub fn is_empty(&self) -> bool {
        self.vectors.is_empty() && self.snapshots.is_empty()
    }

    /// Lets an empty route begin at `origin`, with snapshots of a format; one that is not empty stays as
    /// it is.
    pub fn begin(&mut self, origin: Point2<f32>, format: SnapshotFormat) {
        if self.is_empty() {
            self.snapshots.adopt(format);
            self.origin = origin;
            self.tip = [0; 2];
            self.popped = OdometryVector::default();
        }
    }

    /// The end of the route: its beginning plus the sum of all vectors.
    pub fn tip(&self) -> Point2<f32> {
        self.point(self.tip)
    }

    /// Stores the way from the tip to `position`, so that the new tip is the nearest point of the
    /// 0.1 m grid: no rounding error builds up. A way beyond the range of a byte takes several
    /// vectors, one of less than half a count takes none.
    ///
    /// # Errors
    ///
    /// [`RouteFull`].
    pub fn extend_to(&mut self, position: Point2<f32>) -> Result<(), RouteFull> {
        let counts = |metres: f32| libm::roundf(metres / ODOMETRY_RESOLUTION_M) as i32;
        let from_origin = position - self.origin;
        let new_tip = [counts(from_origin.x), counts(from_origin.y)];
        let way = [0, 1].map(|axis| new_tip[axis].saturating_sub(self.tip[axis]));
        if pieces_needed(way) > VECTOR_CAPACITY - self.vectors.len() {
            return Err(RouteFull);
        }
        for vector in pieces(way) {
            self.vectors.push(vector).map_err(|_| RouteFull)?;
        }
        self.tip = new_tip;
        self.popped = OdometryVector::default();
        Ok(())
    }

    /// Stores a snapshot at the tip, and simplifies the way from the one before to within a tolerance,
    /// metres. Returns what is left of the view.
    ///
    /// # Errors
    ///
    /// [`RouteFull`].
    pub fn push_snapshot(
        &mut self,
        view: &Spectrum,
        tolerance_m: f32,
    ) -> Result<StoredView, RouteFull> {
        if self.snapshots.is_full() {
            return Err(RouteFull);
        }
        self.simplify_last_part(tolerance_m);
        self.snapshots.push(view, self.height())
    }

    /// Makes room for snapshots: drops every second one that odometry leads to and on from. The way stays as it
    /// is. Says whether there is room now.
    pub(crate) fn thin_out(&mut self) -> bool {
        self.snapshots.thin_out()
    }

    /// Makes room for vectors: simplifies the way since the last snapshot. Says whether there is room now.
    pub(crate) fn straighten(&mut self, tolerance_m: f32) -> bool {
        let before = self.vectors.len();
        self.simplify_last_part(tolerance_m);
        self.vectors.len() < before
    }

    /// Takes the last vector off; the tip moves back by it.
    pub fn pop_vector(&mut self) -> Option<OdometryVector> {
        let vector = self.vectors.pop()?;
        self.tip[0] -= i32::from(vector.x);
        self.tip[1] -= i32::from(vector.y);
        self.popped = vector;
        Some(vector)
    }

    /// Takes the last snapshot off.
    pub fn pop_snapshot(&mut self) -> Option<StoredSnapshot> {
        self.snapshots.pop()
    }

    /// The last snapshot.
    pub fn top_snapshot(&self) -> Option<StoredSnapshot> {
        self.snapshots.last()
    }

    /// Whether the last snapshot was taken at the tip.
    pub fn has_snapshot_at_tip(&self) -> bool {
        self.snapshots
            .top_height()
            .is_some_and(|height| usize::from(height) >= self.vectors.len())
    }

    /// Whether no odometry leads from the snapshot before (or from the beginning) to the last one.
    pub fn top_is_visual_only(&self) -> bool {
        let before = self.snapshots.len().checked_sub(2);
        let below = before.and_then(|index| self.snapshots.height(index));
        self.snapshots.top_height().unwrap_or(0) == below.unwrap_or(0)
    }

    /// Whether the vectors tell where the last snapshot was taken: not for a later one of a purely
    /// visual sequence.
    pub fn top_position_is_known(&self) -> bool {
        self.snapshots.len() == 1 || !self.top_is_visual_only()
    }

    /// Where the vectors below the last snapshot lead to.
    pub fn top_snapshot_position(&self) -> Option<Point2<f32>> {
        let height = usize::from(self.snapshots.top_height()?);
        let mut position = self.tip;
        for vector in self.vectors.iter().skip(height) {
            position[0] -= i32::from(vector.x);
            position[1] -= i32::from(vector.y);
        }
        Some(self.point(position))
    }

    /// The vectors, oldest first.
    pub fn vectors(&self) -> &[OdometryVector] {
        &self.vectors
    }

    /// The snapshots, oldest first.
    pub const fn snapshots(&self) -> &SnapshotStack {
        &self.snapshots
    }

    /// The route's bytes with each snapshot's height: 18 a snapshot of the paper's, 2 a vector.
    pub fn bytes(&self) -> usize {
        self.snapshots.bytes().len() + self.vectors.len() * OdometryVector::BYTES
    }

    /// The route's bytes as the paper counts them, without the heights: 16 a snapshot, 2 a vector.
    pub fn bytes_without_heights(&self) -> usize {
        self.bytes() - self.snapshots.len() * HEIGHT_BYTES
    }

    fn height(&self) -> u16 {
        const _: () = assert!(VECTOR_CAPACITY <= u16::MAX as usize);
        self.vectors.len() as u16
    }

    fn simplify_last_part(&mut self, tolerance_m: f32) {
        let start = self.snapshots.top_height().map_or(0, usize::from);
        let Some(part) = self.vectors.get_mut(start..) else {
            return;
        };
        let left = simplify::simplify(part, tolerance_m);
        self.vectors.truncate(start + left);
    }

    fn point(&self, counts: [i32; 2]) -> Point2<f32> {
        Point2::new(
            self.origin.x + counts[0] as f32 * ODOMETRY_RESOLUTION_M,
            self.origin.y + counts[1] as f32 * ODOMETRY_RESOLUTION_M,
        )
    }
}

impl Default for Route {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests;
