//! How bright the horizon band is, and by how much its luma has to grow.

/// How many samples of the band have each luma.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LumaHistogram {
    counts: [u16; 256],
}

/// What is known of a sensor's luma.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LumaScale {
    /// Luma of no light, b.
    pub(super) black: f32,
    /// From this luma on a sample is clipped: it says only that there was at least that much light.
    pub(super) clipped_from: u8,
    /// The mean luma that is wanted, S.
    pub(super) wanted: f32,
}

/// What a histogram says of the exposure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Correction {
    /// The factor on the luma above black, k.
    pub(super) factor: f32,
    /// The share of samples that are clipped, 0..=1.
    pub(super) clipped: f32,
}

/// Luma of a clipped sample.
const FULL: f32 = 255.0;

impl LumaHistogram {
    /// No samples.
    pub const fn new() -> Self {
        Self { counts: [0; 256] }
    }

    /// Counts a sample.
    pub fn add(&mut self, luma: u8) {
        // A byte indexes 256 counters: the compiler sees that there is nothing to check.
        let count = &mut self.counts[usize::from(luma)];
        *count = count.saturating_add(1);
    }

    /// The factor k on the luma above black that brings the mean to what is wanted: in the model
    /// Y = min(255, b + c E^γ) of light times exposure E, a ratio r of the exposure makes of a sample
    /// Y the sample min(255, b + k (Y - b)) with k = r^γ. None without samples; as good as infinite
    /// where all are black, 0 where so many are clipped that the rest cannot make up for them.
    ///
    /// Samples that are clipped are taken to stay clipped. Upwards they do, and the factor is exact.
    /// Downwards they come down, unknown how far, and the next frame is too dark: but that one shows
    /// exactly what is missing, where one that is still clipped would not.
    pub(super) fn correction(&self, scale: &LumaScale) -> Option<Correction> {
        let (below_white, clipped) = self.counts.split_at(usize::from(scale.clipped_from));
        let count = |counts: &[u16]| -> u32 { counts.iter().map(|&count| u32::from(count)).sum() };
        let clipped = count(clipped);
        let total = clipped + count(below_white);
        if total == 0 {
            return None;
        }
        let full = FULL - scale.black;
        // In integers as far as it goes: exact, and two cycles for each luma.
        let luma = |(luma, &count): (usize, &u16)| luma as u32 * u32::from(count);
        let luma: u32 = below_white.iter().enumerate().map(luma).sum();
        let visible = luma as f32 - scale.black * (total - clipped) as f32;
        let wanted = (scale.wanted - scale.black) * total as f32 - clipped as f32 * full;
        let factor = if visible < wanted {
            upwards(below_white, scale.black, wanted, visible)
        } else {
            wanted.max(0.0) / visible.max(f32::MIN_POSITIVE)
        };
        Some(Correction {
            factor,
            clipped: clipped as f32 / total as f32,
        })
    }
}

/// The k of at least 1 with Σ min(255 - b, k (Y - b)) = `wanted` over the samples below white, whose
/// Σ (Y - b) is `visible`: the brightest clip first, so they are taken out one luma after the other
/// until the rest stays below white.
fn upwards(below_white: &[u16], black: f32, mut wanted: f32, mut visible: f32) -> f32 {
    let full = FULL - black;
    for (count, light) in lights(below_white, black).rev() {
        if count == 0.0 {
            continue;
        }
        // Two products instead of a quotient: `visible` may be zero.
        if light <= 0.0 || wanted * light < full * visible {
            break;
        }
        wanted -= count * full;
        visible -= count * light;
    }
    wanted / visible.max(f32::MIN_POSITIVE)
}

/// How many samples have how much luma above black.
fn lights(below_white: &[u16], black: f32) -> impl DoubleEndedIterator<Item = (f32, f32)> {
    let of_luma = below_white.iter().enumerate();
    of_luma.map(move |(luma, &count)| (f32::from(count), luma as f32 - black))
}

impl Default for LumaHistogram {
    fn default() -> Self {
        Self::new()
    }
}
