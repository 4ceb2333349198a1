//! The shape of a frame in memory.

/// Rows of pixels from the top, without gaps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    /// Pixels in a row.
    pub width: u16,
    /// Rows.
    pub height: u16,
    /// Bytes of a pixel.
    pub bytes_per_pixel: u8,
    /// Offset of the luma byte inside a pixel.
    pub luma_offset: u8,
}

impl Shape {
    /// Bytes of a frame; saturates.
    pub const fn bytes(&self) -> usize {
        let pixels = (self.width as usize).saturating_mul(self.height as usize);
        pixels.saturating_mul(self.bytes_per_pixel as usize)
    }
}
