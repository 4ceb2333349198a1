//! How bright the horizon band is, and by how much its luma has to grow.

/// How many samples of the band have each luma.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LumaHistogram {
    counts: [u32; 256],
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

    /// Counts a sample, of fewer than 2^32.
    pub fn add(&mut self, luma: u8) {
        // A byte indexes 256 counters: the compiler sees that there is nothing to check.
        let count = &mut self.counts[usize::from(luma)];
        *count = count.wrapping_add(1);
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
        let clipped: u32 = clipped.iter().sum();
        let full = FULL - scale.black;
        // In integers as far as it goes: exact, and a few cycles for each luma.
        let of_luma = below_white.iter().zip(0_u32..);
        let (seen, luma) = of_luma.fold((0, 0), |(seen, sum), (count, luma)| {
            (seen + count, sum + luma * count)
        });
        let total = clipped + seen;
        if total == 0 {
            return None;
        }
        let visible = luma as f32 - scale.black * seen as f32;
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
fn upwards(below_white: &[u32], black: f32, mut wanted: f32, mut visible: f32) -> f32 {
    let full = FULL - black;
    let seen = below_white.iter().enumerate().rev();
    for (luma, &count) in seen.filter(|(_, count)| **count > 0) {
        let light = luma as f32 - black;
        // Two products instead of a quotient: `visible` may be zero.
        if light <= 0.0 || wanted * light < full * visible {
            break;
        }
        wanted -= count as f32 * full;
        visible -= count as f32 * light;
    }
    wanted / visible.max(f32::MIN_POSITIVE)
}

impl Default for LumaHistogram {
    fn default() -> Self {
        Self::new()
    }
}
