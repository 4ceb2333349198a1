//! Pictures of a calibration: files in, luma out.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use ::image::ImageError;
use pilot::FRAME_LAYOUT;

/// Pixels in a row.
pub const WIDTH: usize = FRAME_LAYOUT.width as usize;
/// Rows.
pub const HEIGHT: usize = FRAME_LAYOUT.height as usize;

/// A file that is no picture of the flight board's camera.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// It cannot be read.
    #[error("{}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// It is no picture of a known format.
    #[error(
        "{}: neither PNG, JPEG or PGM nor a raw frame of {} bytes: {source}",
        path.display(),
        FRAME_LAYOUT.bytes()
    )]
    Format {
        /// The file.
        path: PathBuf,
        /// Why.
        source: ImageError,
    },
    /// It has another size than the camera's frames.
    #[error("{}: {width} x {height} pixels, the camera has {WIDTH} x {HEIGHT}", path.display())]
    Size {
        /// The file.
        path: PathBuf,
        /// Its width.
        width: u32,
        /// Its height.
        height: u32,
    },
}

/// Luma of every pixel, 0..=255, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    luma: Vec<f32>,
}

impl Picture {
    /// Reads a PNG, JPEG or PGM of 128 x 96 pixels, or a raw frame (U Y V Y).
    ///
    /// # Errors
    /// [`PictureError`] with the file and the reason.
    pub fn read(path: &Path) -> Result<Self, PictureError> {
        let path_buf = || path.to_owned();
        let bytes = fs::read(path).map_err(|source| PictureError::Unreadable {
            path: path_buf(),
            source,
        })?;
        if bytes.len() == FRAME_LAYOUT.bytes() && ::image::guess_format(&bytes).is_err() {
            return Ok(Self::from_frame(&bytes));
        }
        let picture = ::image::load_from_memory(&bytes)
            .map_err(|source| PictureError::Format {
                path: path_buf(),
                source,
            })?
            .into_luma8();
        let (width, height) = picture.dimensions();
        if (width as usize, height as usize) != (WIDTH, HEIGHT) {
            return Err(PictureError::Size {
                path: path_buf(),
                width,
                height,
            });
        }
        let luma = picture.into_raw().into_iter().map(f32::from).collect();
        Ok(Self { luma })
    }

    /// The luma of a raw frame, which lacks no byte.
    pub fn from_frame(frame: &[u8]) -> Self {
        let pixels = frame.chunks_exact(FRAME_LAYOUT.bytes_per_pixel.into());
        let luma = pixels.map(|pixel| f32::from(pixel[usize::from(FRAME_LAYOUT.luma_offset)]));
        Self {
            luma: luma.collect(),
        }
    }

    /// The mean of pictures, pixel by pixel; none of none.
    pub fn mean(pictures: &[Self]) -> Option<Self> {
        let (first, others) = pictures.split_first()?;
        let mut mean = first.clone();
        for other in others {
            for (sum, luma) in mean.luma.iter_mut().zip(&other.luma) {
                *sum += luma;
            }
        }
        let scale = 1.0 / pictures.len() as f32;
        mean.luma.iter_mut().for_each(|luma| *luma *= scale);
        Some(mean)
    }

    /// Luma of every pixel, row by row.
    pub fn luma(&self) -> &[f32] {
        &self.luma
    }

    /// Luma at a point, between the middles of the four pixels around it; none where one of them lies
    /// outside the picture. Pixel (0, 0) covers [0, 1) x [0, 1).
    pub fn at(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let [x, y] = [x - 0.5, y - 0.5];
        if !(x >= 0.0 && y >= 0.0) {
            return None;
        }
        let [column, row] = [x as usize, y as usize];
        if column + 1 >= WIDTH || row + 1 >= HEIGHT {
            return None;
        }
        let [right, down] = [x - column as f64, y - row as f64];
        let luma = |column: usize, row: usize| f64::from(self.luma[row * WIDTH + column]);
        let above = luma(column, row) * (1.0 - right) + luma(column + 1, row) * right;
        let below = luma(column, row + 1) * (1.0 - right) + luma(column + 1, row + 1) * right;
        Some(above * (1.0 - down) + below * down)
    }
}

/// The point at this radius, in pixels, and this angle: from right (x) towards down (y), radians.
pub fn polar([x, y]: [f64; 2], radius_px: f64, angle_rad: f64) -> [f64; 2] {
    let (sin, cos) = libm::sincos(angle_rad);
    [x + radius_px * cos, y + radius_px * sin]
}
