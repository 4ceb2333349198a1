//! The sensor's test pictures. The data sheet names them; their values are the usual ones (BT.601), for
//! it gives none.

use super::{Line, WIDTH};

/// A picture that the chip makes by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TestPattern {
    /// Eight colour bars of full saturation.
    Bars,
    /// Luma from black at the left to white at the right.
    Ramp,
    /// The same, through the tone curve.
    RampBeforeGamma,
}

/// U, Y, V of white, yellow, cyan, green, magenta, red, blue and black, full range.
const BARS: [[u8; 3]; 8] = [
    [128, 255, 128],
    [0, 226, 149],
    [171, 179, 0],
    [44, 150, 21],
    [212, 105, 235],
    [85, 76, 255],
    [255, 29, 107],
    [128, 0, 128],
];

impl TestPattern {
    /// A line of the picture (all are alike); `tone_curve` is luma by converter level.
    pub fn draw(self, tone_curve: &[u8], line: &mut Line) {
        let (pairs, _) = line.as_chunks_mut::<4>();
        for (pair, bytes) in pairs.iter_mut().enumerate() {
            let [left, right] = [2 * pair, 2 * pair + 1];
            *bytes = match self {
                Self::Bars => {
                    let [u, y, v] = BARS[left * BARS.len() / WIDTH];
                    [u, y, v, y]
                }
                Self::Ramp => {
                    let luma = |x: usize| (x * 255 / (WIDTH - 1)) as u8;
                    [128, luma(left), 128, luma(right)]
                }
                Self::RampBeforeGamma => {
                    let luma = |x: usize| tone_curve[x * (tone_curve.len() - 1) / (WIDTH - 1)];
                    [128, luma(left), 128, luma(right)]
                }
            };
        }
    }
}
