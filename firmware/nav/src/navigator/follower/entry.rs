//! Joining the route from wherever beside it the drone stands.

use super::Context;
use crate::navigator::spacing::Drift;
use crate::route::VECTOR_SPACING_M;

/// Lets the route end beside the drone: what lies beyond is forgotten. False where the drone is farther from
/// the route than homing finds a snapshot, and nobody has flown the way there.
///
/// A drone that has just ended recording is at the end of the route, as far as vectors resolve the way.
/// Nobody knows where a visual sequence ends: homing finds its last snapshot or does not.
pub(super) fn enter(context: &mut Context) -> bool {
    let Context {
        parameters, route, ..
    } = context;
    let here = context.pose.position;
    let is_at_tip =
        (here - route.tip()).norm() <= VECTOR_SPACING_M + parameters.acceptance_radius_m;
    if is_at_tip || (route.has_snapshot_at_tip() && route.top_is_visual_only()) {
        return true;
    }
    let entry = route.entry(here, Drift::DEFAULT.scale);
    let is_beside = entry.distance_m <= parameters.leash_m;
    if is_beside {
        route.cut(&entry);
    }
    is_beside
}
