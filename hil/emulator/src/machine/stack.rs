//! How deep the stack has been: the painted words below it that still hold their paint.

use crate::image::Image;
use crate::memory::{CCM, CCM_BYTES, Memory, SRAM, SRAM_BYTES};

/// Where cortex-m-rt's linker script puts the initial stack pointer.
const STACK_START: &str = "_stack_start";

/// Bytes from the top of the stack to the lowest word that lost its paint.
pub fn peak_bytes(image: &Image, memory: &Memory, paint: u32) -> Option<u32> {
    let top = image.symbol(STACK_START)?.address & !3;
    let untouched = (floor(image, top)?..top)
        .step_by(4)
        .take_while(|&address| memory.read32(address) == Some(paint));
    let lowest = untouched.last().map(|address| address + 4);
    Some(top - lowest.unwrap_or(floor(image, top)?))
}

/// The end of the static data below the stack, or of the memory itself.
fn floor(image: &Image, top: u32) -> Option<u32> {
    let base = [(SRAM, SRAM_BYTES), (CCM, CCM_BYTES)]
        .into_iter()
        .find(|&(base, bytes)| (base + 1..=base + bytes as u32).contains(&top))?
        .0;
    let ends = image.sections().iter().filter_map(|section| {
        let end = section.address.checked_add(section.size)?;
        (section.address >= base && end <= top).then_some(end)
    });
    Some(ends.max().unwrap_or(base).max(base).next_multiple_of(4))
}
