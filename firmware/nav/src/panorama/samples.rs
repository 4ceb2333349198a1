//! Where the samples of each bearing lie in a frame, with the bounds proven once.

use super::{BAND_ROWS, RADII};
use crate::horizon::BEARINGS;

/// Samples that are added up at a time: their indices fill the core's registers.
const EIGHT: usize = 8;

/// The byte indices of a bearing's samples, eight and eight.
type Column = [[u16; EIGHT]; RADII / EIGHT];

/// The byte indices of 128 x 16 samples of luma, 4 KiB. Every one of them lies inside a frame of
/// `frame_bytes`, which is checked where the table is made and not for each of 2,048 samples a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct SampleTable {
    indices: [Column; BEARINGS],
    frame_bytes: usize,
}

/// What samples add up to.
struct Sum {
    /// The first six, which are the horizon band.
    band: u32,
    /// All of them.
    all: u32,
}

const _: () = assert!(BAND_ROWS == 6 && RADII == 2 * EIGHT);

impl SampleTable {
    /// A table of what `index` says of each bearing and sample; none if one lies outside the frame.
    pub(super) fn new(frame_bytes: usize, index: impl Fn(usize, usize) -> u16) -> Option<Self> {
        let mut indices = [Column::default(); BEARINGS];
        for (bearing, column) in indices.iter_mut().enumerate() {
            for (sample, place) in column.as_flattened_mut().iter_mut().enumerate() {
                *place = index(bearing, sample);
                if usize::from(*place) >= frame_bytes {
                    return None;
                }
            }
        }
        Some(Self {
            indices,
            frame_bytes,
        })
    }

    /// Writes the sums of a frame's columns, in the order of their bearings from `first` on, all round;
    /// what all samples of the band add up to. None of a frame that is too short.
    #[inline(always)]
    pub(super) fn sum_columns(
        &self,
        frame: &[u8],
        first: usize,
        sums: &mut [u16; BEARINGS],
    ) -> u32 {
        let mut in_band = 0;
        if frame.len() < self.frame_bytes {
            return in_band;
        }
        let (before, from) = self.indices.split_at(first.min(BEARINGS));
        let (head, tail) = sums.split_at_mut(from.len());
        for (columns, sums) in [(from, head), (before, tail)] {
            for ([upper, lower], place) in columns.iter().zip(sums) {
                // SAFETY: `new` has seen that every index is less than `frame_bytes`, and the frame is
                // not shorter than that.
                let [upper, lower] = [upper, lower].map(|eight| unsafe { sum(frame, eight) });
                in_band += upper.band;
                *place = (upper.all + lower.all) as u16;
            }
        }
        in_band
    }

    /// Passes on the luma of each sample of the band. None of a frame that is too short.
    #[inline(always)]
    pub(super) fn look_at_band(&self, frame: &[u8], mut pass: impl FnMut(u8)) {
        if frame.len() < self.frame_bytes {
            return;
        }
        for [[band @ .., _, _], _] in &self.indices {
            // All loads of a bearing one after the other: then none waits for the one before.
            // SAFETY: as above.
            let band: [u8; BAND_ROWS] =
                band.map(|index| unsafe { *frame.get_unchecked(usize::from(index)) });
            band.into_iter().for_each(&mut pass);
        }
    }

    /// The byte index of a sample.
    pub(super) fn index(&self, bearing: usize, sample: usize) -> usize {
        usize::from(self.indices[bearing].as_flattened()[sample])
    }
}

/// The sum of a frame's bytes at these indices, and of those at the first six.
///
/// The order makes the difference, and no compiler finds it: loads that do not wait for one another
/// take a cycle each, a load of what the one before brought takes two (ARM DDI0439 §3.3.3).
///
/// # Safety
/// Every index must be less than the frame's length.
#[cfg(all(target_arch = "arm", target_os = "none"))]
#[inline(always)]
unsafe fn sum(frame: &[u8], indices: &[u16; EIGHT]) -> Sum {
    let (band, all);
    // SAFETY: reads the indices and, as the caller promises, bytes of the frame.
    unsafe {
        core::arch::asm!(
            "ldrh {a}, [{last}]",
            "ldrh {b}, [{last}, #2]",
            "ldrh {c}, [{last}, #4]",
            "ldrh {d}, [{last}, #6]",
            "ldrh {e}, [{last}, #8]",
            "ldrh {f}, [{last}, #10]",
            "ldrh {g}, [{last}, #12]",
            "ldrh {last}, [{last}, #14]",
            "ldrb {a}, [{frame}, {a}]",
            "ldrb {b}, [{frame}, {b}]",
            "ldrb {c}, [{frame}, {c}]",
            "ldrb {d}, [{frame}, {d}]",
            "ldrb {e}, [{frame}, {e}]",
            "ldrb {f}, [{frame}, {f}]",
            "ldrb {g}, [{frame}, {g}]",
            "ldrb {last}, [{frame}, {last}]",
            "add {a}, {a}, {b}",
            "add {a}, {a}, {c}",
            "add {a}, {a}, {d}",
            "add {a}, {a}, {e}",
            "add {a}, {a}, {f}",
            "add {last}, {last}, {g}",
            "add {last}, {last}, {a}",
            frame = in(reg) frame.as_ptr(),
            last = inout(reg) indices.as_ptr() => all,
            a = out(reg) band,
            b = out(reg) _,
            c = out(reg) _,
            d = out(reg) _,
            e = out(reg) _,
            f = out(reg) _,
            g = out(reg) _,
            options(pure, readonly, nostack, preserves_flags),
        );
    }
    Sum { band, all }
}

/// The same in plain Rust.
///
/// # Safety
/// Every index must be less than the frame's length.
#[cfg(not(all(target_arch = "arm", target_os = "none")))]
unsafe fn sum(frame: &[u8], indices: &[u16; EIGHT]) -> Sum {
    // SAFETY: the caller's promise.
    let luma = |index: &u16| u32::from(unsafe { *frame.get_unchecked(usize::from(*index)) });
    let (band, others) = indices.split_at(BAND_ROWS);
    let band = band.iter().map(luma).sum();
    Sum {
        band,
        all: band + others.iter().map(luma).sum::<u32>(),
    }
}
