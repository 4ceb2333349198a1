//! What this image is: in its log, in its flash at the symbol `IDENTITY`, and, of a rig image, over the
//! wire to a host that asks.

use frames::{Identity, ImageKind, Shape};
use sensor::tcm8230::GEOMETRY;

use crate::board::pins;
use crate::lens_page;

/// What the image may do.
pub const KIND: ImageKind = if cfg!(feature = "rig") {
    ImageKind::Rig
} else {
    ImageKind::Flight
};

/// Rate of the wire that takes frames, baud: `CATAGLYPHIS_SERIAL_BAUD` of the build's environment, for
/// an adapter that does not do the usual. Of a flight image, none.
pub const BAUD: u32 = match (KIND, option_env!("CATAGLYPHIS_SERIAL_BAUD")) {
    (ImageKind::Flight, _) => 0,
    (ImageKind::Rig, Some(digits)) => baud(digits),
    (ImageKind::Rig, None) => frames::DEFAULT_BAUD,
};

/// The frames that the image works on.
pub const SHAPE: Shape = Shape {
    width: GEOMETRY.width,
    height: GEOMETRY.height,
    bytes_per_pixel: GEOMETRY.bytes_per_pixel,
    luma_offset: GEOMETRY.luma_offset,
};

/// All of it.
pub const THIS: Identity = Identity::new(
    KIND,
    pins::NAME,
    SHAPE,
    BAUD,
    lens_page::ADDRESS,
    env!("CARGO_PKG_VERSION"),
);

/// Where a probe, or a reader of the image's file, finds it. Nothing in the program refers to it: the
/// linker script keeps its section.
#[used]
#[unsafe(no_mangle)]
#[unsafe(link_section = ".identity")]
static IDENTITY: [u8; Identity::BYTES] = THIS.encode();

/// The fastest that USART3 can: APB1's 42 MHz by eight (RM0090 §30.3.4).
const MAX_BAUD: u32 = 5_250_000;

/// The number that these digits are.
const fn baud(digits: &str) -> u32 {
    let mut left = digits.as_bytes();
    let mut baud: u32 = 0;
    while let [digit, rest @ ..] = left {
        assert!(
            digit.is_ascii_digit() && baud <= MAX_BAUD,
            "CATAGLYPHIS_SERIAL_BAUD"
        );
        baud = 10 * baud + (*digit - b'0') as u32;
        left = rest;
    }
    assert!(
        baud > 0 && baud <= MAX_BAUD,
        "CATAGLYPHIS_SERIAL_BAUD: 1 to 5250000"
    );
    baud
}
