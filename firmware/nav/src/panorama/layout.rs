//! Where the luma of each pixel stands in a frame.

/// The shape of the frames that an image sensor sends, as the DMA leaves them in memory: row by row,
/// from the top, without gaps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameLayout {
    /// Pixels in a row.
    pub width: u16,
    /// Rows.
    pub height: u16,
    /// Bytes of a pixel: 2 for YUV 4:2:2, 1 for a monochrome sensor.
    pub bytes_per_pixel: u8,
    /// Offset of the luma byte inside a pixel.
    pub luma_offset: u8,
}

impl FrameLayout {
    /// The flight board's: 128 x 96 pixels (sub-QCIF), YUV 4:2:2 in the order U Y V Y.
    pub const SUBQCIF_UYVY: Self = Self {
        width: 128,
        height: 96,
        bytes_per_pixel: 2,
        luma_offset: 1,
    };

    /// Bytes of a frame; saturates.
    pub const fn bytes(&self) -> usize {
        let pixels = (self.width as usize).saturating_mul(self.height as usize);
        pixels.saturating_mul(self.bytes_per_pixel as usize)
    }

    /// Whether every luma byte has an index of 16 bits, which is what a look-up table holds. True of
    /// frames of up to 64 KiB, 160 x 120 in two bytes among them.
    pub const fn is_indexable(&self) -> bool {
        self.luma_offset < self.bytes_per_pixel
            && 0 < self.bytes()
            && self.bytes() <= u16::MAX as usize + 1
    }

    /// The byte index of the luma of the pixel that covers (x, y), in the image coordinates of
    /// [`LensCalibration`](crate::LensCalibration); of the nearest pixel where none does.
    pub(crate) fn luma_index(&self, x: f32, y: f32) -> u16 {
        // A float cast saturates, below at zero.
        let column = (x as usize).min(usize::from(self.width).saturating_sub(1));
        let row = (y as usize).min(usize::from(self.height).saturating_sub(1));
        let pixel = row * usize::from(self.width) + column;
        (pixel * usize::from(self.bytes_per_pixel) + usize::from(self.luma_offset)) as u16
    }
}
