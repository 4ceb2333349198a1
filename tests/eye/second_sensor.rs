//! A second image sensor behind the same trait, unlike the first: monochrome, 160 x 120, one byte a pixel,
//! register addresses of two bytes (after the HM01B0's). The panorama is built from its own frames.

use std::time::Duration;

use embedded_hal_async::i2c::{ErrorKind, ErrorType, I2c, NoAcknowledgeSource, Operation};
use nav::horizon::BEARINGS;
use nav::{FrameLayout, LensCalibration, PanoramaMap};
use pollster::block_on;
use sensor::{Error, Geometry, ImageSensor};

const ADDRESS: u8 = 0x24;
const IDENTITY: u16 = 0x0000;
const MODE: u16 = 0x0100;
const COMMIT: u16 = 0x0104;
const SHUTTER: u16 = 0x0202;
const GAIN: u16 = 0x0205;
const AUTOMATIC: u16 = 0x2100;
const ID: u8 = 0x01;
/// 132 lines a frame; two must be left.
const MAX_LINES: u16 = 130;

/// The driver of a small monochrome sensor.
struct Mono<B> {
    bus: B,
}

impl<B: I2c> Mono<B> {
    async fn write(&mut self, register: u16, values: &[u8]) -> Result<(), Error<B::Error>> {
        let mut bytes = register.to_be_bytes().to_vec();
        bytes.extend(values);
        let written = self.bus.write(ADDRESS, &bytes).await;
        written.map_err(|error| Error::Bus { register, error })
    }
}

impl<B: I2c> ImageSensor for Mono<B> {
    type BusError = B::Error;

    async fn probe(&mut self) -> Result<(), Error<B::Error>> {
        let mut id = [0];
        let address = IDENTITY.to_be_bytes();
        let read = self.bus.write_read(ADDRESS, &address, &mut id).await;
        read.map_err(|error| Error::Bus {
            register: IDENTITY,
            error,
        })?;
        match id {
            [ID] => Ok(()),
            [id] => Err(Error::NotFound { id }),
        }
    }

    async fn init(&mut self, lines: u16, gain: f32) -> Result<(), Error<B::Error>> {
        self.write(AUTOMATIC, &[0]).await?;
        self.set_exposure(lines, gain).await?;
        self.write(MODE, &[1]).await
    }

    /// Takes effect with the commit: both at once.
    async fn set_exposure(&mut self, lines: u16, gain: f32) -> Result<(), Error<B::Error>> {
        let lines = lines.clamp(1, MAX_LINES);
        self.write(SHUTTER, &lines.to_be_bytes()).await?;
        // Factors of two in bits 6..4.
        let step = libm::floorf(libm::log2f(gain.clamp(1.0, 8.0))) as u8;
        self.write(GAIN, &[step << 4]).await?;
        self.write(COMMIT, &[1]).await
    }

    fn geometry(&self) -> Geometry {
        Geometry {
            width: 160,
            height: 120,
            bytes_per_pixel: 1,
            luma_offset: 0,
        }
    }

    fn line_time(&self) -> Duration {
        Duration::from_nanos(62_667)
    }

    fn max_lines(&self) -> u16 {
        MAX_LINES
    }

    fn latency_frames(&self) -> u8 {
        2
    }

    fn settling_frames(&self) -> u8 {
        2
    }
}

/// A bus with such a sensor on it.
#[derive(Default)]
struct Chip {
    identity: u8,
    writes: Vec<(u16, Vec<u8>)>,
    absent: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Refused;

impl embedded_hal_async::i2c::Error for Refused {
    fn kind(&self) -> ErrorKind {
        ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address)
    }
}

impl ErrorType for &mut Chip {
    type Error = Refused;
}

impl I2c for &mut Chip {
    async fn transaction(
        &mut self,
        address: u8,
        operations: &mut [Operation<'_>],
    ) -> Result<(), Refused> {
        if self.absent || address != ADDRESS {
            return Err(Refused);
        }
        for operation in operations {
            match operation {
                Operation::Write([high, low, values @ ..]) => {
                    let register = u16::from_be_bytes([*high, *low]);
                    if !values.is_empty() {
                        self.writes.push((register, values.to_vec()));
                    }
                }
                Operation::Write(_) => return Err(Refused),
                Operation::Read(values) => values.fill(self.identity),
            }
        }
        Ok(())
    }
}

/// Whatever the sensor, in the order in which the board brings it up.
async fn bring_up<S: ImageSensor>(sensor: &mut S) -> Result<FrameLayout, Error<S::BusError>> {
    sensor.probe().await?;
    sensor.init(64, 2.0).await?;
    let Geometry {
        width,
        height,
        bytes_per_pixel,
        luma_offset,
    } = sensor.geometry();
    Ok(FrameLayout {
        width,
        height,
        bytes_per_pixel,
        luma_offset,
    })
}

fn layout() -> FrameLayout {
    let mut chip = Chip {
        identity: ID,
        ..Chip::default()
    };
    block_on(bring_up(&mut Mono { bus: &mut chip })).expect("a sensor")
}

#[test]
fn it_is_brought_up_through_the_trait_with_its_own_registers() {
    let mut chip = Chip {
        identity: ID,
        ..Chip::default()
    };
    block_on(bring_up(&mut Mono { bus: &mut chip })).expect("a sensor");
    let expected = [
        (AUTOMATIC, vec![0]),
        (SHUTTER, vec![0, 64]),
        (GAIN, vec![0x10]),
        (COMMIT, vec![1]),
        (MODE, vec![1]),
    ];
    assert_eq!(chip.writes, expected);
}

#[test]
fn a_stranger_and_an_absent_one_are_told_apart() {
    let mut stranger = Chip::default();
    let result = block_on(bring_up(&mut Mono { bus: &mut stranger }));
    assert_eq!(result, Err(Error::NotFound { id: 0 }));
    let mut absent = Chip {
        absent: true,
        ..Chip::default()
    };
    let result = block_on(bring_up(&mut Mono { bus: &mut absent }));
    let refused = Error::Bus {
        register: IDENTITY,
        error: Refused,
    };
    assert_eq!(result, Err(refused));
}

/// A frame in which the luma depends on the bearing alone, in any layout; every other byte is a trap.
fn frame(layout: &FrameLayout, lens: &LensCalibration) -> Vec<u8> {
    let mut frame = vec![0xee; layout.bytes()];
    let [width, pixel] = [layout.width, u16::from(layout.bytes_per_pixel)].map(usize::from);
    for (index, bytes) in frame.chunks_exact_mut(pixel).enumerate() {
        let x = (index % width) as f32 + 0.5 - lens.centre_px.0;
        let y = (index / width) as f32 + 0.5 - lens.centre_px.1;
        let bearing = libm::atan2f(y, x) - lens.zero_bearing_rad;
        let luma = 100.0 + 40.0 * libm::cosf(bearing - 0.7) + 20.0 * libm::sinf(3.0 * bearing);
        bytes[usize::from(layout.luma_offset)] = luma as u8;
    }
    frame
}

/// The same lens, larger on the larger sensor.
#[test]
fn its_frames_give_the_horizon_that_the_first_sensors_give() {
    let mono = layout();
    assert_eq!(
        (mono.bytes(), layout_of_the_first().bytes()),
        (19_200, 24_576)
    );
    let first_lens = LensCalibration::DEFAULT;
    let lens = LensCalibration {
        centre_px: (81.0, 59.0),
        inner_radius_px: 22.0,
        outer_radius_px: 53.0,
        horizon_radius_px: 37.5,
        ..first_lens
    };
    let horizon = |lens: &LensCalibration, layout: &FrameLayout| {
        let map = PanoramaMap::new(lens, layout).expect("a lens that fits");
        map.horizon(&frame(layout, lens), 1.0)
    };
    let first = horizon(&first_lens, &layout_of_the_first());
    let second = horizon(&lens, &mono);
    for bearing in 0..BEARINGS {
        let [a, b] = [&first, &second].map(|horizon| horizon.luma()[bearing]);
        assert!((a - b).abs() < 3.0, "{bearing}: {a} {b}");
    }
    assert!(PanoramaMap::new(&lens, &layout_of_the_first()).is_err());
}

fn layout_of_the_first() -> FrameLayout {
    let Geometry {
        width,
        height,
        bytes_per_pixel,
        luma_offset,
    } = sensor::tcm8230::GEOMETRY;
    let layout = FrameLayout {
        width,
        height,
        bytes_per_pixel,
        luma_offset,
    };
    assert_eq!(layout, FrameLayout::SUBQCIF_UYVY);
    layout
}
