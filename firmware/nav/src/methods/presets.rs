//! Settings by size: those of the published methods as they do well in most rooms, and the default.

use super::{
    Alignment, CoefficientCode, FourierParameters, MfdidParameters, Resolution, SearchParameters,
    Slope, Unknowns, WarpParameters,
};

/// Steps of the default's rotation search, in bearings: 8.4 degrees.
pub const ROTATION_STEP: u8 = 3;

/// Fourier homing with a byte for each number; the heading is trusted.
pub const fn fourier(bytes: u8) -> FourierParameters {
    FourierParameters {
        code: CoefficientCode {
            frequencies: bytes / 2,
            bits: 8,
            range: 1.0,
        },
        power: 1.0,
        iterations: 3,
        next_term: true,
        unknowns: Unknowns::Move,
        alignment: Alignment::None,
    }
}

/// The search on a grid of 36 directions and 6 distances; the heading is trusted.
pub const fn search(bytes: u8, resolution: Resolution) -> SearchParameters {
    SearchParameters {
        pixels: bytes,
        low_pass: bytes / 2,
        directions: 36,
        distances: 6,
        farthest: 0.8,
        rotations: 0,
        resolution,
    }
}

/// Gauss-Newton on half the frequencies that the pixels have.
pub const fn mfdid(bytes: u8) -> MfdidParameters {
    MfdidParameters {
        pixels: bytes,
        low_pass: bytes / 4,
        slope: Slope::GaussNewton,
    }
}

/// Bits of each number in the default's memory. Fewer bits and more frequencies make the catchment area
/// no larger, and the last step less exact; from 28 bytes on there are more bits than frequencies to
/// spend them on.
const fn bits(bytes: u8) -> u8 {
    match bytes {
        ..6 => 5,
        6..28 => 6,
        28..32 => 7,
        _ => 8,
    }
}

/// Frequencies that the default compares at most.
const MOST_FREQUENCIES: u8 = 16;

/// The default at a size: a search over warps, flat weights, and a last step of Fourier homing.
/// `rotations` of [`ROTATION_STEP`] are tried to either side; 0 trusts the heading.
pub const fn default(bytes: u8, rotations: u8) -> WarpParameters {
    let bits = bits(bytes);
    // Two numbers a frequency.
    let room = (bytes as u16 * 4 / bits as u16) as u8;
    WarpParameters {
        code: CoefficientCode {
            frequencies: if room < MOST_FREQUENCIES {
                room
            } else {
                MOST_FREQUENCIES
            },
            bits,
            range: 1.0,
        },
        power: 0.0,
        farthest: 0.9,
        rotations,
        rotation_step: ROTATION_STEP,
        polish: true,
    }
}
