//! From VECTOR to the position set-point.

use link::WorldPoint;

/// The camera's newest target, and the one that is being flown to.
#[derive(Debug, Default)]
pub struct Goal {
    newest: Option<WorldPoint>,
    /// The origin at first: a first target of exactly (0, 0) is taken for unchanged.
    issued: WorldPoint,
}

impl Goal {
    /// Takes the target of a vector; of several in one cycle the last one counts.
    pub fn receive(&mut self, target: WorldPoint) {
        self.newest = Some(target);
    }

    /// The set-point to issue: the newest target, unless it is the one issued last.
    pub fn issue(&mut self) -> Option<WorldPoint> {
        let target = self.newest.filter(|target| *target != self.issued)?;
        self.issued = target;
        Some(target)
    }
}

#[cfg(test)]
mod tests {
    use link::WorldPoint;

    use super::Goal;

    #[test]
    fn the_last_target_is_issued_once() {
        let mut goal = Goal::default();
        goal.receive(WorldPoint { x: 1.0, y: 0.0 });
        goal.receive(WorldPoint { x: 2.0, y: 0.0 });
        assert_eq!(goal.issue(), Some(WorldPoint { x: 2.0, y: 0.0 }));
        goal.receive(WorldPoint { x: 2.0, y: 0.0 });
        assert_eq!(goal.issue(), None);
    }

    #[test]
    fn a_first_target_of_exactly_the_origin_is_not_issued() {
        let mut goal = Goal::default();
        goal.receive(WorldPoint { x: 0.0, y: 0.0 });
        assert_eq!(goal.issue(), None);
    }
}
