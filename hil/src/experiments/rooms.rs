//! The rooms that the surveys look round in, all of them part of this repository.

use super::ExperimentError;
use crate::catchment::place::{ROOM_HEIGHT_M, ROOM_M, Source};
use crate::catchment::{Named, Place};
use crate::image::workspace_root;

/// The photographed lounge (Poly Haven, CC0), in a checkout.
const LOUNGE: &str = "fake-sensors/assets/lounge.hdr";
/// Size of the paper's room, metres: along x and y, and the height that a photographed one is taken to have.
pub const PAPER_ROOM_M: [f32; 3] = [ROOM_M[0], ROOM_M[1], ROOM_HEIGHT_M];

/// The photographed lounge on the faces of a room of this size, metres: what `hil catchment --world hdri:FILE,WxLxH`
/// opens.
pub fn lounge(size_m: [f32; 3]) -> Result<Place, ExperimentError> {
    let source = Source::Panorama {
        file: workspace_root()?.join(LOUNGE),
        size_m,
    };
    open("lounge", source)
}

/// The open office: what `hil catchment --world office` opens.
pub fn office() -> Result<Place, ExperimentError> {
    let source = Source::World {
        world: "office".to_owned(),
        seed: 1,
    };
    open("office", source)
}

fn open(name: &str, source: Source) -> Result<Place, ExperimentError> {
    let name = name.to_owned();
    Ok(Place::open(&Named { name, source })?)
}
