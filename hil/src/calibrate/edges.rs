//! The ring in a picture: where the dark middle ends, and where the optic's image does.

use core::f64::consts::TAU;
use core::slice;

use super::circles::{Circles, Points, concentric, consensus, median};
use super::picture::{HEIGHT, Picture, WIDTH, polar};
use super::steepest;

/// Rays along which edges are looked for: one for each pixel of the middle of the ring.
const RAYS: usize = 180;

/// Steps along a ray, pixels.
const STEP_PX: f64 = 0.25;

/// Times that the rays are drawn anew from the centre that was found.
const ROUNDS: usize = 4;

/// Times that the edge on a ray is looked for from where it was found before.
const LOOKS: usize = 3;

/// Radius of the disc in the frame's middle that is dark under every optic: its centre may be mounted
/// off by as much as the dark middle is larger.
const DARK_DISC_PX: f64 = 6.0;

/// Half of an edge as it is imaged: the optic is not sharp, and pixels have a size. So far from an edge
/// the picture shows what lies beside it.
const SOFT_PX: f64 = 2.5;

/// The least contrast of an edge, luma: five times the noise of one frame.
const CONTRAST: f64 = 10.0;

/// Luma from which on an edge may be overexposed.
const CLIPPED: f64 = 245.0;

/// Share of the rays that must show an edge.
const SHARE_OF_RAYS: f64 = 0.3;

/// The least width of a ring, pixels.
const RING_PX: f64 = 10.0;

/// The greatest width of a bright rim between ring and holder, pixels.
const RIM_PX: f64 = 8.0;

/// The greatest difference round a fixture that has no pattern, as a share of its luma.
const UNIFORM: f64 = 0.3;

/// Why a picture shows no ring.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoRing {
    /// There is nothing to be seen all over.
    #[error("no contrast: too dark, or overexposed")]
    Flat,
    /// The middle is not darker than what is around it.
    #[error("no dark middle with an edge all round, from which the ring begins")]
    NoInnerEdge,
    /// Nothing ends the ring.
    #[error("no outer edge: neither a bright rim nor a dark holder all round the ring")]
    NoOuterEdge,
    /// There are edges, but on no circle.
    #[error("the edges lie on no circle")]
    NoCircle,
}

/// The two visible edges of the ring.
pub type Edges = Circles<2>;

/// Finds the ring in one picture: the visible edges about their common centre.
///
/// # Errors
/// [`NoRing`] where the picture shows none.
pub fn find(picture: &Picture) -> Result<Edges, NoRing> {
    let luma = || picture.luma().iter().map(|luma| f64::from(*luma));
    let darkest = luma().fold(f64::INFINITY, f64::min);
    if luma().fold(0.0, f64::max) - darkest < 2.0 * CONTRAST {
        return Err(NoRing::Flat);
    }
    let mut centre = [0.5 * WIDTH as f64, 0.5 * HEIGHT as f64];
    for _ in 0..ROUNDS {
        let inner = inner_points(picture, centre)?;
        centre = consensus(&inner).ok_or(NoRing::NoCircle)?;
    }
    find_in_all(slice::from_ref(picture), centre)
}

/// The ring that goes through the edges of all pictures, about a centre near this one.
///
/// # Errors
/// [`NoRing`] where a picture shows none there.
pub fn find_in_all(pictures: &[Picture], mut centre: [f64; 2]) -> Result<Edges, NoRing> {
    let mut edges = None;
    for _ in 0..ROUNDS {
        let (mut inner, mut outer) = (Points::new(), Points::new());
        for picture in pictures {
            let points = inner_points(picture, centre)?;
            let alone = concentric([&points], centre).ok_or(NoRing::NoCircle)?;
            outer.extend(outer_points(picture, centre, alone.rings[0].radius_px)?);
            inner.extend(points);
        }
        let found = concentric([&inner, &outer], centre).ok_or(NoRing::NoCircle)?;
        centre = found.centre;
        edges = Some(found);
    }
    let mut edges = edges.ok_or(NoRing::NoCircle)?;
    for ring in &mut edges.rings {
        ring.radius_px = steepest::radius(pictures, edges.centre, ring.radius_px);
    }
    Ok(edges)
}

/// The angles of the rays, radians.
pub fn rays() -> impl Iterator<Item = f64> {
    (0..RAYS).map(|ray| (ray as f64 + 0.5) * (TAU / RAYS as f64))
}

/// An edge on a ray.
struct Crossing {
    point: [f64; 2],
    /// The luma of its brighter side.
    bright: f64,
}

/// The points of the edges that are not overexposed, where these are enough; else of all. An edge whose
/// brighter side is clipped seems to lie on its darker side.
fn enough(found: Vec<Crossing>, otherwise: NoRing) -> Result<Points, NoRing> {
    let least = SHARE_OF_RAYS * RAYS as f64;
    let points = |limit: f64| -> Points {
        let exposed = found.iter().filter(|crossing| crossing.bright < limit);
        exposed.map(|crossing| crossing.point).collect()
    };
    [points(CLIPPED), points(f64::INFINITY)]
        .into_iter()
        .find(|points| points.len() as f64 >= least)
        .ok_or(otherwise)
}

/// On each ray from the middle, where it leaves the dark.
fn inner_points(picture: &Picture, centre: [f64; 2]) -> Result<Points, NoRing> {
    let dark = dark_level(picture, centre).ok_or(NoRing::NoInnerEdge)?;
    let points = rays().filter_map(|angle| {
        let at = |radius| picture.at(polar(centre, radius, angle));
        let mut radius = STEP_PX;
        while at(radius)? < dark + CONTRAST {
            radius += STEP_PX;
        }
        // It begins to leave the dark before the edge: what lies beyond is looked up from the edge.
        let mut beyond = dark;
        for _ in 0..LOOKS {
            beyond = at(radius + SOFT_PX)?;
            let half = 0.5 * (dark + beyond);
            radius = crossing(at, radius - SOFT_PX, radius + SOFT_PX, half)?;
        }
        (beyond > dark + 2.0 * CONTRAST).then(|| Crossing {
            point: polar(centre, radius, angle),
            bright: beyond,
        })
    });
    enough(points.collect(), NoRing::NoInnerEdge)
}

/// The luma of the dark middle.
fn dark_level(picture: &Picture, centre: [f64; 2]) -> Option<f64> {
    let radii = (1..=DARK_DISC_PX as usize).map(|radius| radius as f64);
    let disc = radii.flat_map(|radius| rays().step_by(6).map(move |angle| (radius, angle)));
    median(
        disc.filter_map(|(radius, angle)| picture.at(polar(centre, radius, angle)))
            .collect(),
    )
}

/// Where between two radii the luma first passes `level`.
fn crossing(at: impl Fn(f64) -> Option<f64>, from: f64, to: f64, level: f64) -> Option<f64> {
    let mut radius = from.max(0.0);
    let mut here = at(radius)? - level;
    while radius < to {
        let next = at(radius + STEP_PX)? - level;
        if (here <= 0.0) != (next <= 0.0) {
            return Some(radius + STEP_PX * here / (here - next));
        }
        (radius, here) = (radius + STEP_PX, next);
    }
    None
}

/// On each ray, where the optic's image ends.
fn outer_points(picture: &Picture, centre: [f64; 2], inner_px: f64) -> Result<Points, NoRing> {
    let profile = Profile::of(picture, centre, inner_px + RING_PX - SOFT_PX);
    let edge = profile.end_of_ring().ok_or(NoRing::NoOuterEdge)?;
    let points = rays().filter_map(|angle| {
        let at = |radius| picture.at(polar(centre, radius, angle));
        let inside = at(edge.radius_px - edge.soft_px)?;
        let outside = at(edge.radius_px + edge.soft_px)?;
        let half = 0.5 * (inside + outside);
        let reach = edge.soft_px;
        let crossing = crossing(at, edge.radius_px - reach, edge.radius_px + reach, half)?;
        let contrast = edge.sign * (outside - inside);
        (contrast > CONTRAST).then(|| Crossing {
            point: polar(centre, crossing, angle),
            bright: inside.max(outside),
        })
    });
    enough(points.collect(), NoRing::NoOuterEdge)
}

/// What is seen all round at each radius.
struct Profile {
    /// Radius of the first entry; they are [`STEP_PX`] apart.
    from_px: f64,
    /// Medians over the rays: what is seen on one side alone does not count.
    luma: Vec<f64>,
    /// Half of the range in which the middle half of the rays lie, as a share of the median.
    spread: Vec<f64>,
}

/// An edge all round.
#[derive(Clone, Copy)]
struct Step {
    radius_px: f64,
    /// 1 where it is brighter outside, -1 where it is darker.
    sign: f64,
    /// How far from it its sides are to be seen.
    soft_px: f64,
}

impl Profile {
    /// From `from_px` outwards as far as three rays in ten are in the picture.
    fn of(picture: &Picture, centre: [f64; 2], from_px: f64) -> Self {
        let mut profile = Self {
            from_px,
            luma: Vec::new(),
            spread: Vec::new(),
        };
        loop {
            let radius = profile.radius(profile.luma.len());
            let mut round: Vec<f64> = rays()
                .filter_map(|angle| picture.at(polar(centre, radius, angle)))
                .collect();
            if (round.len() as f64) < SHARE_OF_RAYS * RAYS as f64 {
                return profile;
            }
            round.sort_unstable_by(f64::total_cmp);
            let quantile = |share: f64| round[(share * (round.len() - 1) as f64) as usize];
            let middle = quantile(0.5);
            profile.luma.push(middle);
            let spread = 0.5 * (quantile(0.75) - quantile(0.25));
            profile.spread.push(spread / middle.max(1.0));
        }
    }

    fn radius(&self, index: usize) -> f64 {
        self.from_px + index as f64 * STEP_PX
    }

    /// The edges, from inside outwards: where the luma changes most.
    fn steps(&self) -> Vec<Step> {
        let reach = (0.5 * SOFT_PX / STEP_PX) as usize;
        let change: Vec<f64> = (0..self.luma.len())
            .map(|index| {
                let sides = index.checked_sub(reach).zip(self.luma.get(index + reach));
                sides.map_or(0.0, |(inside, outside)| outside - self.luma[inside])
            })
            .collect();
        let is_step = |index: &usize| {
            let low = index.saturating_sub(2 * reach);
            let high = (index + 2 * reach).min(change.len() - 1);
            let here = change[*index];
            // The first of equals: a plateau is one edge.
            here.abs() > CONTRAST
                && change[low..*index]
                    .iter()
                    .all(|other| other.abs() < here.abs())
                && change[*index..=high]
                    .iter()
                    .all(|other| other.abs() <= here.abs())
        };
        let steps = (0..change.len()).filter(is_step).map(|index| Step {
            radius_px: self.radius(index),
            sign: change[index].signum(),
            soft_px: SOFT_PX,
        });
        steps.collect()
    }

    /// Where the ring ends: the outermost edge, or the one within it where a bright rim lies between
    /// the two. A rim is narrow, and has no pattern.
    fn end_of_ring(&self) -> Option<Step> {
        let steps = self.steps();
        let (last, others) = steps.split_last()?;
        let rim = others.last().filter(|step| {
            last.sign < 0.0
                && last.radius_px - step.radius_px <= RIM_PX
                && self.is_uniform(step.radius_px, last.radius_px)
        });
        let Some(step) = rim else {
            return Some(*last);
        };
        let half_of_rim = 0.5 * (last.radius_px - step.radius_px);
        Some(Step {
            soft_px: half_of_rim.min(SOFT_PX),
            ..*step
        })
    }

    /// Whether what lies in the middle between two radii has no pattern.
    fn is_uniform(&self, from_px: f64, to_px: f64) -> bool {
        let middle = (0.5 * (from_px + to_px) - self.from_px) / STEP_PX;
        self.spread
            .get(middle.round() as usize)
            .is_some_and(|spread| *spread < UNIFORM)
    }
}
