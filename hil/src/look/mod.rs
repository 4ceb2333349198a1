//! What the panoramic camera sees from a place, and what of that is remembered (paper, Fig. 3A): the
//! ring, the panorama unrolled from it, the horizon, its spectrum, and what 16 bytes keep of it.

mod figure;
mod film;
mod raster;

use std::path::Path;

use fake_sensors::camera::{self, FRAME_BYTES, Moment, PanoramicCamera, PanoramicLens};
use fake_sensors::world::{World, WorldError};
use nav::horizon::BEARINGS;
use nav::panorama::RADII;
use nav::spectrum::VIEW_FREQUENCIES;
use nav::{CalibrationError, PanoramaMap, Snapshot, Spectrum};
use pilot::{Parameters, Pilot};

pub use figure::picture;
pub use film::{along, film};

/// Frames that the autoexposure gets to settle. It is done within 10; the rest is for its patience.
const SETTLING_FRAMES: usize = 24;

/// The camera cannot look.
#[derive(Debug, thiserror::Error)]
pub enum LookError {
    /// There is no such world, or its file is bad.
    #[error(transparent)]
    World(#[from] WorldError),
    /// The firmware's lens is none.
    #[error("the lens calibration is impossible: {0}")]
    Lens(#[from] CalibrationError),
}

/// One look round.
#[derive(Clone, Debug)]
pub struct Glance {
    /// From where, and when.
    pub moment: Moment,
    /// The frame as it comes over the bus: 128 x 96, U Y V Y.
    pub frame: Box<[u8; FRAME_BYTES]>,
    /// Shutter and gain.
    pub exposure: camera::Exposure,
    /// Unrolled: rows from the highest elevation to the lowest, columns by bearing from the nose.
    pub panorama: [[u8; BEARINGS]; RADII],
    /// Luma by bearing from the nose, counter-clockwise.
    pub horizon: [f32; BEARINGS],
    /// |c_k|, luma, k = 1..=9.
    pub amplitudes: [f32; VIEW_FREQUENCIES],
    /// What is remembered.
    pub snapshot: Snapshot,
}

impl Glance {
    /// Mean luma of the horizon.
    pub fn mean_luma(&self) -> f32 {
        self.horizon.iter().sum::<f32>() / BEARINGS as f32
    }
}

/// A camera with the firmware's eyes behind it.
pub struct Observer {
    optics: PanoramicCamera,
    pilot: Pilot,
    map: PanoramaMap,
    frames: u32,
}

impl Observer {
    /// An observer in a world: a name of the library's or a file.
    ///
    /// # Errors
    /// [`LookError`], where there is no such world.
    pub fn new(world: &str, seed: u64) -> Result<Self, LookError> {
        let world = World::open(world, seed)?;
        let parameters = Parameters::DEFAULT;
        Ok(Self {
            optics: PanoramicCamera::new(world, &PanoramicLens::default(), seed),
            pilot: Pilot::new(&parameters)?,
            map: PanoramaMap::new(&parameters.lens, &pilot::FRAME_LAYOUT)?,
            frames: 0,
        })
    }

    /// Looks round at a moment, with the firmware's autoexposure or a shutter (lines) of one's own.
    pub fn look(&mut self, moment: &Moment, shutter: Option<u16>) -> Glance {
        let exposure = match shutter {
            Some(lines) => camera::Exposure { lines, gain: 1.0 },
            None => self.settle(moment),
        };
        let frame = Box::new(*self.expose(moment, exposure));
        let horizon = self.map.horizon(&*frame, 0.0);
        let spectrum = Spectrum::of(&horizon);
        Glance {
            moment: *moment,
            exposure,
            panorama: self.map.unwrap(&*frame),
            horizon: horizon.luma(),
            amplitudes: spectrum.coefficients().map(|c| libm::hypotf(c.re, c.im)),
            snapshot: Snapshot::quantise(&spectrum),
            frame,
        }
    }

    fn settle(&mut self, moment: &Moment) -> camera::Exposure {
        let mut exposure = wanted(&self.pilot);
        for _ in 0..SETTLING_FRAMES {
            let frame = *self.expose(moment, exposure);
            self.pilot.on_frame(&frame);
            exposure = wanted(&self.pilot);
        }
        exposure
    }

    fn expose(&mut self, moment: &Moment, exposure: camera::Exposure) -> &camera::Frame {
        self.frames = self.frames.wrapping_add(1);
        self.optics.expose(moment, exposure, self.frames)
    }
}

fn wanted(pilot: &Pilot) -> camera::Exposure {
    let exposure = pilot.exposure();
    camera::Exposure {
        lines: exposure.shutter_lines,
        gain: exposure.gain,
    }
}

/// The name of a world for a file's name: that of its file without folders and ending.
pub fn short_name(world: &str) -> String {
    let stem = Path::new(world).file_stem().unwrap_or_default();
    stem.to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use nalgebra::{UnitQuaternion, Vector3};

    use super::*;

    fn moment() -> Moment {
        Moment {
            pose: camera::Pose {
                position_m: Vector3::new(-2.5, 0.0, 0.5),
                attitude: UnitQuaternion::identity(),
            },
            time_s: 0.0,
        }
    }

    #[test]
    fn the_autoexposure_brings_the_horizon_to_its_set_point() {
        let mut observer = Observer::new("arena-panels", 1).unwrap();
        let mean = observer.look(&moment(), None).mean_luma();
        // It meters a band of the ring; this is the mean of all of it.
        assert!((60.0..100.0).contains(&mean), "{mean}");
        let dim = observer.look(&moment(), Some(10)).mean_luma();
        assert!(dim < 25.0, "{dim}");
    }

    #[test]
    fn a_picture_holds_the_ring_the_panorama_and_both_horizons() {
        let mut observer = Observer::new("office", 1).unwrap();
        let glance = observer.look(&moment(), None);
        let svg = picture("office", &glance);
        assert!(svg.starts_with("<svg") && svg.ends_with("</svg>"));
        assert_eq!(svg.matches("data:image/png;base64,").count(), 2);
        assert!(svg.contains("class=\"line curve s-ink\""));
        assert!(svg.contains("class=\"line odometry s-homing\""));
    }

    #[test]
    fn a_film_shows_each_of_its_frames_for_its_share_of_the_time() {
        let mut observer = Observer::new("corridor-doors", 1).unwrap();
        let glances: Vec<Glance> = (0..3)
            .map(|_| observer.look(&moment(), Some(100)))
            .collect();
        let svg = film("corridor-doors", &glances, 0.2);
        assert_eq!(svg.matches("<g class=\"shot\"").count(), 3);
        assert!(svg.contains("animation-delay:0.40s"));
        assert!(svg.contains("33.33"));
    }

    #[test]
    fn a_film_goes_along_the_route_at_flight_speed() {
        let route = crate::scenario::Route::Corner.waypoints();
        let moments = along(&route, 0.5, 9);
        assert_eq!(moments.len(), 9);
        let place = |index: usize| moments[index].pose.position_m;
        // 3 m south and 1 m east, in steps of half a metre; x is north, y is west.
        assert!((place(3) - Vector3::new(-1.5, 0.0, 0.5)).norm() < 1e-5);
        assert!((place(8) - Vector3::new(-3.0, -1.0, 0.5)).norm() < 1e-5);
        assert!((moments[8].time_s - 8.0).abs() < 1e-6);
    }

    #[test]
    fn the_name_of_a_world_is_that_of_its_file() {
        assert_eq!(short_name("office"), "office");
        assert_eq!(short_name("rooms/my.toml"), "my");
    }
}
