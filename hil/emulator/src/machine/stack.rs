//! How deep the stack has been: the painted words below it that still hold their paint.

use crate::image::Image;
use crate::memory::{CCM, CCM_BYTES, Memory, SRAM, SRAM_BYTES};

/// Where cortex-m-rt's linker script puts the initial stack pointer.
const STACK_START: &str = "_stack_start";

/// Bytes from the top of the stack to the lowest word that lost its paint.
pub fn peak_bytes(image: &Image, memory: &Memory, paint: u32) -> Option<u32> {
    let top = image.symbol(STACK_START)?.address & !3;
    let ends = image
        .sections()
        .iter()
        .filter_map(|section| section.address.checked_add(section.size));
    Some(top - lowest_used(memory, paint, floor(ends, top)?, top))
}

/// The end of the static data below the stack, or the beginning of its memory.
fn floor(section_ends: impl Iterator<Item = u32>, top: u32) -> Option<u32> {
    let memories = [(SRAM, SRAM_BYTES), (CCM, CCM_BYTES)];
    let holds_stack = |&(base, bytes): &(u32, usize)| (1..=bytes as u32).contains(&(top - base));
    let (base, _) = memories
        .into_iter()
        .filter(|&(base, _)| base < top)
        .find(holds_stack)?;
    let below = section_ends.filter(|end| (base..=top).contains(end));
    Some(below.max().unwrap_or(base).next_multiple_of(4))
}

fn lowest_used(memory: &Memory, paint: u32, floor: u32, top: u32) -> u32 {
    let untouched = |address: &u32| memory.read32(*address) == Some(paint);
    let words = (floor..top).step_by(4);
    words
        .take_while(untouched)
        .last()
        .map_or(floor, |last| last + 4)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAINT: u32 = 0xc0de_57ac;

    #[test]
    fn the_peak_is_the_lowest_word_that_lost_its_paint() {
        let mut memory = Memory::new();
        memory.fill_ram(PAINT);
        let top = SRAM + 0x1000;
        assert_eq!(lowest_used(&memory, PAINT, SRAM, top), top);
        memory.write32(top - 4, 1).unwrap();
        memory.write32(top - 64, 1).unwrap();
        assert_eq!(lowest_used(&memory, PAINT, SRAM, top), top - 64);
        memory.write32(SRAM, 1).unwrap();
        assert_eq!(lowest_used(&memory, PAINT, SRAM, top), SRAM);
    }

    #[test]
    fn the_stack_ends_where_the_statics_below_it_do() {
        let top = SRAM + SRAM_BYTES as u32;
        let ends = [0x0800_4000, SRAM + 0x123, CCM + 0x40];
        assert_eq!(floor(ends.into_iter(), top), Some(SRAM + 0x124));
        let top = CCM + CCM_BYTES as u32;
        assert_eq!(floor([SRAM + 0x100].into_iter(), top), Some(CCM));
        assert_eq!(floor([].into_iter(), 0x0800_0000), None);
    }
}
