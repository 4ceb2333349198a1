//! What an image takes of the chip's memories, by crate and by symbol, and how that changed.

mod difference;

use std::collections::BTreeMap;

use emulator::image::{Image, Symbol};
use emulator::memory::{CCM, CCM_BYTES, FLASH, FLASH_BYTES, SRAM, SRAM_BYTES};
use serde::{Deserialize, Serialize};

pub use difference::Difference;

/// Where the stack begins and ends, by the linker script.
const STACK_START: &str = "_stack_start";
const STACK_END: &str = "_stack_end";

/// What belongs to no crate by its name: functions with C names, such as handlers and memcpy.
const C_NAMES: &str = "(C names)";

/// What no symbol names: strings and tables of constants above all.
const UNNAMED: &str = "(unnamed)";

/// The compiler's own labels round statics that have names.
const MERGED: &str = ".L_MergedGlobals";

/// Bytes of flash and of RAM.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Bytes {
    /// Of flash.
    pub flash: u32,
    /// Of static RAM.
    pub ram: u32,
}

/// The sizes of an image. Field names are a promise to scripts.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Size {
    /// Flash, all of it.
    pub flash_bytes: u32,
    /// Static RAM, all of it: `.data`, `.bss` and `.uninit`.
    pub ram_bytes: u32,
    /// Memory that the stack has.
    pub stack_bytes: u32,
    /// The deepest stack of a flight, interrupts included; none if it left its memory.
    pub stack_peak_bytes: Option<u32>,
    /// What the deepest stack left free.
    pub stack_free_bytes: Option<u32>,
    /// Flash and RAM by crate.
    pub crates: BTreeMap<String, Bytes>,
    /// Flash and RAM by function or static.
    pub symbols: BTreeMap<String, Bytes>,
}

impl Size {
    /// Of an image, and the deepest stack that a flight of it had.
    pub fn of(image: &Image, stack_peak_bytes: Option<u32>) -> Self {
        let [start, end] = [STACK_START, STACK_END].map(|name| image.symbol(name));
        let stack_bytes = match (start, end) {
            (Some(start), Some(end)) => start.address.saturating_sub(end.address),
            _ => 0,
        };
        let (flash_bytes, ram_bytes) = (image.flash_bytes(), image.static_ram_bytes());
        let symbols = by_symbol(image);
        let mut crates: BTreeMap<String, Bytes> = BTreeMap::new();
        for (name, bytes) in &symbols {
            add(crates.entry(crate_of(name).to_owned()).or_default(), *bytes);
        }
        let named = crates.values().fold(Bytes::default(), |mut sum, bytes| {
            add(&mut sum, *bytes);
            sum
        });
        let unnamed = Bytes {
            flash: flash_bytes.saturating_sub(named.flash),
            ram: ram_bytes.saturating_sub(named.ram),
        };
        crates.insert(UNNAMED.to_owned(), unnamed);
        Self {
            flash_bytes,
            ram_bytes,
            stack_bytes,
            stack_peak_bytes,
            stack_free_bytes: stack_peak_bytes.map(|peak| stack_bytes.saturating_sub(peak)),
            crates,
            symbols,
        }
    }
}

/// What several names share, or one within another, counts once: for the first. Equal names are one.
fn by_symbol(image: &Image) -> BTreeMap<String, Bytes> {
    let mut places: BTreeMap<u32, (&str, u32)> = BTreeMap::new();
    let named = image
        .symbols()
        .filter(|(name, _)| !name.starts_with(MERGED));
    for (name, Symbol { address, size }) in named {
        let place = places.entry(address).or_default();
        if size > place.1 {
            *place = (name, size);
        }
    }
    let mut symbols: BTreeMap<String, Bytes> = BTreeMap::new();
    let mut counted = 0;
    for (address, (name, size)) in places {
        let end = address.saturating_add(size);
        let size = end.saturating_sub(address.max(counted));
        counted = counted.max(end);
        let bytes = Bytes {
            flash: if within(address, FLASH, FLASH_BYTES) {
                size
            } else {
                0
            },
            ram: if is_ram(address) { size } else { 0 },
        };
        if bytes != Bytes::default() {
            add(symbols.entry(name.to_owned()).or_default(), bytes);
        }
    }
    symbols
}

fn add(sum: &mut Bytes, bytes: Bytes) {
    sum.flash += bytes.flash;
    sum.ram += bytes.ram;
}

fn is_ram(address: u32) -> bool {
    within(address, SRAM, SRAM_BYTES) || within(address, CCM, CCM_BYTES)
}

fn within(address: u32, base: u32, bytes: usize) -> bool {
    (address.wrapping_sub(base) as usize) < bytes
}

/// The crate that a demangled name begins with: `<&T as core::fmt::Debug>::fmt` is core's where the
/// type says nothing.
fn crate_of(name: &str) -> &str {
    let bare = name.trim_start_matches(['<', '&']);
    let mut parts = bare.split(" as ");
    let with_path = parts.find(|part| part.contains("::"));
    match with_path.and_then(|part| part.split("::").next()) {
        Some(first) if !first.is_empty() => first
            .trim_start_matches("mut ")
            .trim_start_matches("dyn ")
            .trim_start_matches(['<', '&']),
        _ => C_NAMES,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_symbol_belongs_to_the_crate_that_its_path_begins_with() {
        for (name, owner) in [
            ("nav::homing::home", "nav"),
            ("<core::fmt::Formatter>::pad", "core"),
            ("<&T as core::fmt::Debug>::fmt", "core"),
            ("link::body::<impl link::message::Message>::read", "link"),
            ("<dyn core::any::Any>::is", "core"),
            ("vision_frame", C_NAMES),
        ] {
            assert_eq!(crate_of(name), owner, "{name}");
        }
    }
}
