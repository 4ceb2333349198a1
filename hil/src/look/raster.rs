//! Pixels inside an SVG.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use fake_sensors::camera::{FRAME_BYTES, HEIGHT, WIDTH};
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use maud::{Markup, html};
use nav::horizon::BEARINGS;
use nav::panorama::RADII;

use crate::report::svg::px;

/// A grey image in a rectangle of the figure, its pixels left as they are.
pub struct Raster {
    width: usize,
    height: usize,
    grey: Vec<u8>,
}

impl Raster {
    /// Luma of a frame (U Y V Y).
    pub fn of_frame(frame: &[u8; FRAME_BYTES]) -> Self {
        Self {
            width: WIDTH,
            height: HEIGHT,
            grey: frame.iter().skip(1).step_by(2).copied().collect(),
        }
    }

    /// A panorama, its columns in the order in which they are shown.
    pub fn of_panorama(panorama: &[[u8; BEARINGS]; RADII], columns: &[usize]) -> Self {
        let rows = panorama.iter();
        Self {
            width: columns.len(),
            height: RADII,
            grey: rows
                .flat_map(|row| columns.iter().map(|column| row[*column]))
                .collect(),
        }
    }

    /// Drawn with its upper left corner at `place`, in `size` user units.
    pub fn render(&self, place: [f64; 2], size: [f64; 2]) -> Markup {
        html! {
            image x=(px(place[0])) y=(px(place[1])) width=(px(size[0])) height=(px(size[1]))
                preserveAspectRatio="none" style="image-rendering:pixelated" href=(self.data_uri()) {}
        }
    }

    fn data_uri(&self) -> String {
        let mut png = Vec::new();
        let (width, height) = (self.width as u32, self.height as u32);
        // Into memory, with as many bytes as pixels: nothing that could fail.
        let written =
            PngEncoder::new(&mut png).write_image(&self.grey, width, height, ExtendedColorType::L8);
        debug_assert!(written.is_ok());
        format!("data:image/png;base64,{}", STANDARD.encode(png))
    }
}
