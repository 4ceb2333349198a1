//! The lens record's page: the chip's last sector of flash (128 KiB at 0x080E0000), in which there is
//! nothing else, so that programming the firmware leaves it alone, and programming it the firmware:
//!
//! ```text
//! probe-rs download --chip STM32F407VGTx --binary-format bin --base-address 0x080E0000 lens.bin
//! ```

use nav::calibration::record::{self, RECORD_BYTES};
use nav::{LensCalibration, RecordError};
use pilot::FRAME_LAYOUT;
use sensor::tcm8230::GEOMETRY;

/// The sensor's frames are those that the lens is calibrated on.
const _: () = assert!(
    GEOMETRY.width == FRAME_LAYOUT.width
        && GEOMETRY.height == FRAME_LAYOUT.height
        && GEOMETRY.bytes_per_pixel == FRAME_LAYOUT.bytes_per_pixel
        && GEOMETRY.luma_offset == FRAME_LAYOUT.luma_offset
);

/// Where the page begins: what `memory.x` says, for readers of the identification.
pub const ADDRESS: u32 = 0x080e_0000;

/// The lens of this unit, or the default where the page has none that can be used. Says which, in one
/// line of the log.
pub fn lens() -> LensCalibration {
    let found = read();
    match &found {
        Ok(lens) => defmt::info!(
            "lens record: centre {=f32} {=f32} px, band {=f32} to {=f32} px, horizon {=f32} px",
            lens.centre_px.0,
            lens.centre_px.1,
            lens.inner_radius_px,
            lens.outer_radius_px,
            lens.horizon_radius_px
        ),
        Err(RecordError::Empty) => defmt::info!("lens record: none, the default lens is taken"),
        Err(error) => defmt::warn!("lens record: {}, the default lens is taken", error),
    }
    found.unwrap_or_default()
}

fn read() -> Result<LensCalibration, RecordError> {
    unsafe extern "C" {
        /// Where the page begins: `memory.x`.
        #[link_name = "_lens_page"]
        static PAGE: [u8; RECORD_BYTES];
    }
    // SAFETY: the linker script puts the page into flash that nothing else lies in; it can be read
    // whatever it holds, and nobody programs flash while this program runs.
    let page = unsafe { &PAGE };
    record::decode(page, &FRAME_LAYOUT)
}
