//! Snapshots from the map entries of the way out.

use link::{Map, WorldPoint};

use crate::record::{PlanarPose, SnapshotMark};

/// A snapshot stays where it was taken; with odometry alone the camera reports the end of the route in its place,
/// which moves, m.
const SAME_PLACE_M: f32 = 0.01;

/// The snapshots that were taken, as far as the map entries tell.
#[derive(Clone, Debug, Default)]
pub struct Snapshots {
    marks: Vec<SnapshotMark>,
    place: Option<WorldPoint>,
}

/// What a map entry told beside a snapshot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remark {
    /// So many snapshots were taken between two rows: they are not known.
    Missed(u16),
    /// The numbers began anew: another route.
    Restarted,
}

impl Snapshots {
    /// A map entry that was seen while the route was recorded; `estimate` is where the drone believed it was.
    pub fn map(&mut self, t: f64, map: &Map, estimate: PlanarPose) -> Option<Remark> {
        let place = map.snapshot().ok()?;
        let newest = self.marks.last().map(|mark| mark.index);
        let moved = self.place.is_some_and(|before| {
            libm::hypotf(place.x - before.x, place.y - before.y) > SAME_PLACE_M
        });
        self.place = Some(place);
        match newest {
            Some(newest) if map.snapshot_index == newest => {
                if moved {
                    self.marks.pop();
                }
                return None;
            }
            // Odometry alone: number 0 stands for none.
            None if moved && map.snapshot_index == 0 => return None,
            _ => {}
        }
        self.marks.push(SnapshotMark {
            t,
            index: map.snapshot_index,
            odometry_count: map.odometry_index,
            believed: PlanarPose {
                x: place.x.into(),
                y: place.y.into(),
                yaw: estimate.yaw,
            },
            truth: estimate,
            coefficients: Vec::new(),
        });
        let expected = newest.map_or(0, |newest| newest + 1);
        match map.snapshot_index.checked_sub(expected) {
            Some(0) => None,
            Some(missed) => Some(Remark::Missed(missed)),
            None => Some(Remark::Restarted),
        }
    }

    /// In the order in which they were taken.
    pub fn into_marks(self) -> Vec<SnapshotMark> {
        self.marks
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(index: u16, snapshot: [f32; 2], odometry: u16) -> Map {
        Map {
            snapshot_index: index,
            snapshot_n: snapshot[0],
            snapshot_e: snapshot[1],
            odometry_index: odometry,
            ..Map::default()
        }
    }

    fn taken(entries: &[Map]) -> (Vec<u16>, Vec<Remark>) {
        let mut snapshots = Snapshots::default();
        let remarks = entries
            .iter()
            .filter_map(|map| snapshots.map(0.0, map, PlanarPose::default()))
            .collect();
        let marks = snapshots.into_marks();
        (marks.iter().map(|mark| mark.index).collect(), remarks)
    }

    #[test]
    fn each_new_number_is_a_snapshot_and_a_longer_route_is_none() {
        let route = [
            entry(0, [0.1, 0.0], 0),
            entry(0, [0.1, 0.0], 1),
            entry(0, [0.1, 0.0], 2),
            entry(1, [2.1, 0.0], 3),
        ];
        assert_eq!(taken(&route), (vec![0, 1], vec![]));
    }

    #[test]
    fn odometry_alone_leaves_no_snapshot() {
        let route = [
            entry(0, [0.1, 0.0], 1),
            entry(0, [0.4, 0.0], 2),
            entry(0, [0.7, 0.0], 3),
        ];
        assert_eq!(taken(&route), (vec![], vec![]));
    }

    #[test]
    fn snapshots_between_two_rows_are_counted_as_missed() {
        let route = [entry(0, [0.0, 0.0], 0), entry(3, [2.0, 0.0], 3)];
        assert_eq!(taken(&route), (vec![0, 3], vec![Remark::Missed(2)]));
    }

    #[test]
    fn numbers_that_fall_are_another_route() {
        let routes = [
            entry(0, [0.0, 0.0], 0),
            entry(1, [2.0, 0.0], 3),
            entry(0, [0.5, 0.0], 0),
        ];
        assert_eq!(taken(&routes).1, [Remark::Restarted]);
    }
}
