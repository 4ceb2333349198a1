//! The worlds that come with this crate, and the pictures that worlds name.

use std::f32::consts::PI;
use std::path::{Path, PathBuf};

use image::{DynamicImage, ImageFormat, ImageReader};

use super::build::Files;
use super::error::Reason;

/// The worlds by name.
const WORLDS: [(&str, &str); 9] = [
    ("arena", include_str!("../../worlds/arena.toml")),
    (
        "arena-panels",
        include_str!("../../worlds/arena-panels.toml"),
    ),
    (
        "corridor-doors",
        include_str!("../../worlds/corridor-doors.toml"),
    ),
    (
        "corridor-bare",
        include_str!("../../worlds/corridor-bare.toml"),
    ),
    ("office", include_str!("../../worlds/office.toml")),
    ("hall", include_str!("../../worlds/hall.toml")),
    ("forest", include_str!("../../worlds/forest.toml")),
    ("greenhouse", include_str!("../../worlds/greenhouse.toml")),
    ("hdri", include_str!("../../worlds/hdri.toml")),
];

/// The names of [`WORLDS`].
pub const NAMES: [&str; WORLDS.len()] = {
    let mut names = [""; WORLDS.len()];
    let mut index = 0;
    while index < names.len() {
        names[index] = WORLDS[index].0;
        index += 1;
    }
    names
};

/// The panorama that comes with this crate (assets/README.md).
const LOUNGE: (&str, &[u8]) = ("lounge.hdr", include_bytes!("../../assets/lounge.hdr"));

/// The description of the world `name`.
pub fn description(name: &str) -> Option<&'static str> {
    let world = WORLDS.iter().find(|(known, _)| *known == name);
    world.map(|(_, text)| *text)
}

/// An equirectangular picture in linear light.
#[derive(Debug)]
pub struct Picture {
    /// Pixels in a row.
    pub width: usize,
    /// Radiances row by row, the zenith first.
    pub texels: Vec<f32>,
}

/// Reads the picture that a description names.
pub fn picture(files: Files<'_>, name: &str) -> Result<Picture, Reason> {
    let image = match files {
        Files::BuiltIn => {
            if name != LOUNGE.0 {
                return Err(Reason::Missing(
                    "there is no built-in panorama of this name",
                ));
            }
            let decoded = image::load_from_memory_with_format(LOUNGE.1, ImageFormat::Hdr);
            decoded.map_err(|source| bad(name.into(), source))?
        }
        Files::Folder(folder) => read(&folder.join(name))?,
    };
    Ok(luminance(&image))
}

/// Decodes a file by its content, whatever its name.
fn read(file: &Path) -> Result<DynamicImage, Reason> {
    let failed = |source| bad(file.to_owned(), source);
    let reader = ImageReader::open(file).map_err(|error| failed(error.into()))?;
    let reader = reader
        .with_guessed_format()
        .map_err(|error| failed(error.into()))?;
    reader.decode().map_err(failed)
}

fn bad(file: PathBuf, source: image::ImageError) -> Reason {
    Reason::Panorama { file, source }
}

/// Luminance in linear light (ITU-R BT.709); files of 8 or 16 bits hold sRGB (IEC 61966-2-1).
fn luminance(image: &DynamicImage) -> Picture {
    let linear = matches!(
        image,
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_)
    );
    let pixels = image.to_rgb32f();
    let luminance = pixels.pixels().map(|pixel| {
        let [red, green, blue] = if linear {
            pixel.0
        } else {
            pixel.0.map(from_srgb)
        };
        0.2126 * red + 0.7152 * green + 0.0722 * blue
    });
    Picture {
        width: pixels.width() as usize,
        texels: luminance.collect(),
    }
}

fn from_srgb(value: f32) -> f32 {
    if value <= 0.040_45 {
        value / 12.92
    } else {
        libm::powf((value + 0.055) / 1.055, 2.4)
    }
}

impl Picture {
    /// The picture scaled so that its mean within 45 degrees of the horizon is `mean`. `None` if it is
    /// black there, or not all numbers.
    pub fn scaled_to(&self, mean: f32) -> Option<Vec<f32>> {
        let rows = self.texels.len() / self.width.max(1);
        let white = self.white();
        let (mut sum, mut area) = (0.0_f64, 0.0_f64);
        for (row, line) in self.texels.chunks_exact(self.width.max(1)).enumerate() {
            let elevation = (0.5 - (row as f32 + 0.5) / rows as f32) * PI;
            if elevation.abs() < 0.25 * PI {
                let weight = f64::from(libm::cosf(elevation));
                // A lamp counts for what a camera makes of it: a white surface.
                sum += weight * line.iter().map(|x| f64::from(x.min(white))).sum::<f64>();
                area += weight * line.len() as f64;
            }
        }
        let factor = f64::from(mean) * area / sum;
        let texels: Vec<f32> = self.texels.iter().map(|x| x * factor as f32).collect();
        let sound = texels.iter().all(|x| x.is_finite() && *x >= 0.0);
        (sound && !texels.is_empty()).then_some(texels)
    }

    /// What counts as white: three times the mean of the whole picture.
    fn white(&self) -> f32 {
        3.0 * self.texels.iter().sum::<f32>() / self.texels.len().max(1) as f32
    }
}
