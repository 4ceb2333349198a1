//! The methods by name, and the settings among which each is tuned.

use std::fmt;
use std::str::FromStr;

use nav::methods::{
    Alignment, CoefficientCode, FourierParameters, MOST_BYTES, MfdidParameters, Resolution,
    SearchParameters, Slope, Unknowns, WarpParameters,
    presets::{self, ROTATION_STEP},
};
use serde::{Serialize, Serializer};

/// A method of the comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Fourier homing, a byte a number (Stürzl & Mallot 2006).
    Fourier,
    /// The search of Franz et al. 1998, both views with as many pixels as bytes.
    Search,
    /// The same with the current view at its full resolution.
    SearchFull,
    /// Matched-filter descent in image distances (Möller & Vardy 2006).
    Mfdid,
    /// The search over warps, compared in coefficients.
    Warp,
    /// What ships: the search over warps with settings that are fixed by size.
    Default,
}

const NAMES: [(Method, &str); 6] = [
    (Method::Fourier, "fourier"),
    (Method::Search, "search"),
    (Method::SearchFull, "search-full"),
    (Method::Mfdid, "mfdid"),
    (Method::Warp, "warp"),
    (Method::Default, "default"),
];

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = NAMES.iter().find(|(method, _)| method == self);
        f.pad(name.map_or("", |(_, name)| name))
    }
}

impl FromStr for Method {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let known = NAMES.iter().find(|(_, name)| *name == text);
        known.map(|(method, _)| *method).ok_or_else(|| {
            let names: Vec<&str> = NAMES.iter().map(|(_, name)| *name).collect();
            format!("none of {}", names.join(", "))
        })
    }
}

impl Serialize for Method {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// A method with all that can be chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Settings {
    /// Of [`nav::methods::Fourier`].
    Fourier(FourierParameters),
    /// Of [`nav::methods::Search`].
    Search(SearchParameters),
    /// Of [`nav::methods::Mfdid`].
    Mfdid(MfdidParameters),
    /// Of [`nav::methods::WarpSearch`].
    Warp(WarpParameters),
}

/// The fewest bytes that hold a frequency, or the pixels to tell a direction.
pub const FEWEST_BYTES: u8 = 4;

/// A size in bytes that a memory can have.
///
/// # Errors
/// What it may be.
pub fn parse_bytes(text: &str) -> Result<u8, String> {
    let most = MOST_BYTES as u8;
    text.trim()
        .parse()
        .ok()
        .filter(|bytes| (FEWEST_BYTES..=most).contains(bytes))
        .ok_or_else(|| format!("a number of bytes from {FEWEST_BYTES} to {most}"))
}

impl Method {
    /// The settings among which the method is tuned at a size, where the heading is known to so many
    /// degrees.
    pub fn candidates(self, bytes: u8, heading_deg: f32) -> Vec<Settings> {
        match self {
            Self::Fourier => fourier(bytes, heading_deg),
            Self::Search => search(bytes, heading_deg, Resolution::Memory),
            Self::SearchFull => search(bytes, heading_deg, Resolution::Full),
            Self::Mfdid => mfdid(bytes),
            Self::Warp => warp(bytes, heading_deg),
            Self::Default => vec![Settings::Warp(shipped(bytes, heading_deg))],
        }
    }
}

/// A byte for each number, as the paper has it.
fn whole_bytes(bytes: u8) -> CoefficientCode {
    CoefficientCode {
        frequencies: bytes / 2,
        bits: 8,
        range: 1.0,
    }
}

/// Half steps of the rotation search that cover a heading error, in units of so many degrees.
fn steps(heading_deg: f32, step_deg: f32) -> u8 {
    if heading_deg > 0.0 {
        ((heading_deg / step_deg).ceil() as u8).saturating_add(1)
    } else {
        0
    }
}

/// Degrees between two bearings.
const BEARING_DEG: f32 = 360.0 / 128.0;

fn fourier(bytes: u8, heading_deg: f32) -> Vec<Settings> {
    let alignment = match steps(heading_deg, BEARING_DEG) {
        0 => Alignment::None,
        steps => Alignment::Tried(steps.min(64)),
    };
    let unknowns: &[Unknowns] = match alignment {
        Alignment::None => &[Unknowns::Move],
        _ => &[Unknowns::Move, Unknowns::MoveAndTurn],
    };
    let mut all = Vec::new();
    for power in [0.0, 1.0, 2.0] {
        for iterations in [1, 3, 8] {
            for next_term in [true, false] {
                all.extend(unknowns.iter().map(|unknowns| {
                    Settings::Fourier(FourierParameters {
                        code: whole_bytes(bytes),
                        power,
                        iterations,
                        next_term,
                        unknowns: *unknowns,
                        alignment,
                    })
                }));
            }
        }
    }
    all
}

fn search(bytes: u8, heading_deg: f32, resolution: Resolution) -> Vec<Settings> {
    let mut all = Vec::new();
    for farthest in [0.5, 0.8, 0.95] {
        for low_pass in [bytes / 4, bytes / 2] {
            all.push(Settings::Search(SearchParameters {
                pixels: bytes,
                low_pass,
                directions: 36,
                distances: 6,
                farthest,
                rotations: steps(heading_deg, 10.0).min(18),
                resolution,
            }));
        }
    }
    all
}

fn mfdid(bytes: u8) -> Vec<Settings> {
    let mut all = Vec::new();
    for low_pass in [1, 2, 3, 4, 6, 8, 12, 16, 24, 31] {
        if 2 * low_pass >= bytes {
            break;
        }
        for slope in [Slope::Descent, Slope::GaussNewton, Slope::Newton] {
            all.push(Settings::Mfdid(MfdidParameters {
                pixels: bytes,
                low_pass,
                slope,
            }));
        }
    }
    all
}

fn warp(bytes: u8, heading_deg: f32) -> Vec<Settings> {
    let codes: Vec<CoefficientCode> = [4, 5, 6, 8]
        .into_iter()
        .map(|bits| CoefficientCode {
            frequencies: (4 * u16::from(bytes) / u16::from(bits)).min(16) as u8,
            bits,
            range: if bits == 8 { 1.0 } else { 0.5 },
        })
        .collect();
    let mut all = Vec::new();
    for code in codes {
        for power in [0.0, 1.0, 2.0] {
            for farthest in [0.8, 0.95] {
                for polish in [false, true] {
                    all.push(Settings::Warp(WarpParameters {
                        code,
                        power,
                        farthest,
                        rotations: rotations(heading_deg),
                        rotation_step: ROTATION_STEP,
                        polish,
                    }));
                }
            }
        }
    }
    all.dedup();
    all
}

fn rotations(heading_deg: f32) -> u8 {
    steps(heading_deg, BEARING_DEG * f32::from(ROTATION_STEP)).min(22)
}

/// The settings that ship, by size.
pub fn shipped(bytes: u8, heading_deg: f32) -> WarpParameters {
    presets::default(bytes, rotations(heading_deg))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_method_is_read_as_it_is_written() {
        for (method, name) in NAMES {
            assert_eq!(name.parse(), Ok(method));
            assert_eq!(method.to_string(), name);
        }
        assert!("sift".parse::<Method>().unwrap_err().contains("mfdid"));
    }

    #[test]
    fn no_candidate_takes_more_bytes_than_it_may() {
        use nav::methods::{Fourier, HomingMethod, Mfdid, Search, WarpSearch};
        for bytes in [4, 6, 8, 10, 12, 16, 20, 24, 32, 48, 64] {
            for (method, _) in NAMES {
                for heading_deg in [0.0, 30.0] {
                    let candidates = method.candidates(bytes, heading_deg);
                    assert!(!candidates.is_empty(), "{method} at {bytes}");
                    for settings in candidates {
                        let taken = match settings {
                            Settings::Fourier(p) => Fourier::new(p).bytes(),
                            Settings::Search(p) => Search::new(p).bytes(),
                            Settings::Mfdid(p) => Mfdid::new(p).bytes(),
                            Settings::Warp(p) => WarpSearch::new(p).bytes(),
                        };
                        assert!(taken <= usize::from(bytes), "{settings:?} takes {taken}");
                    }
                }
            }
        }
    }
}
