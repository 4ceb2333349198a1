//! The adaptive real-time accelerator between core and flash (RM0090 §3.4.2): what instruction
//! fetches and constants cost when the flash needs wait states.

use crate::memory::boxed;

/// Bytes of a flash line, log2: 128 bits.
const LINE_SHIFT: u32 = 4;
/// Lines of the instruction cache.
const INSTRUCTION_LINES: usize = 64;
/// Lines of the data cache.
const DATA_LINES: usize = 8;
/// No line of a 32-bit address space.
const NO_LINE: u32 = u32::MAX;
/// Lines of 1 MiB of flash.
const FLASH_LINES: usize = 1 << 16;
/// The upper half of line numbers in flash: 0x0800_0000 >> LINE_SHIFT >> 16.
const FLASH_REGION: u32 = 0x80;

/// The order in which slots were used: a ring from the newest to the oldest, so that both a use and
/// a replacement take constant time.
struct Recency<const N: usize> {
    /// The next older slot; behind the oldest comes the newest.
    older: [u8; N],
    newer: [u8; N],
    newest: u8,
}

impl<const N: usize> Recency<N> {
    fn new() -> Self {
        Self {
            older: std::array::from_fn(|slot| ((slot + 1) % N) as u8),
            newer: std::array::from_fn(|slot| ((slot + N - 1) % N) as u8),
            newest: 0,
        }
    }

    /// Makes a slot the newest.
    #[inline(always)]
    fn touch(&mut self, slot: u8) {
        if slot == self.newest {
            return;
        }
        let (older, newer) = (self.older[at(slot)], self.newer[at(slot)]);
        self.older[at(newer)] = older;
        self.newer[at(older)] = newer;
        let oldest = self.newer[at(self.newest)];
        self.older[at(oldest)] = slot;
        self.newer[at(slot)] = oldest;
        self.older[at(slot)] = self.newest;
        self.newer[at(self.newest)] = slot;
        self.newest = slot;
    }

    /// Makes the oldest slot the newest, and returns it.
    fn renew_oldest(&mut self) -> u8 {
        self.newest = self.newer[at(self.newest)];
        self.newest
    }
}

fn at(slot: u8) -> usize {
    slot.into()
}

/// A few lines of flash, replaced least recently used first.
struct LineCache<const N: usize> {
    enabled: bool,
    lines: [u32; N],
    recency: Recency<N>,
    /// For each line of the flash 1 + the slot that holds it, or 0.
    slots: Box<[u8; FLASH_LINES]>,
}

impl<const N: usize> LineCache<N> {
    fn new() -> Self {
        Self {
            enabled: false,
            lines: [NO_LINE; N],
            recency: Recency::new(),
            slots: boxed(0),
        }
    }

    fn enable(&mut self, enabled: bool) {
        if self.enabled && !enabled {
            *self = Self::new();
        }
        self.enabled = enabled;
    }

    /// Whether the line is held; it is from now on.
    #[inline(always)]
    fn holds(&mut self, line: u32) -> bool {
        if !self.enabled {
            return false;
        }
        match self.slots[slot_index(line)] {
            0 => {
                self.replace(line);
                false
            }
            slot => {
                self.recency.touch(slot - 1);
                true
            }
        }
    }

    fn replace(&mut self, line: u32) {
        let slot = self.recency.renew_oldest();
        let evicted = std::mem::replace(&mut self.lines[at(slot)], line);
        if evicted != NO_LINE {
            self.slots[slot_index(evicted)] = 0;
        }
        self.slots[slot_index(line)] = slot + 1;
    }
}

fn slot_index(line: u32) -> usize {
    line as usize % FLASH_LINES
}

/// The number of the line that holds an address.
pub(super) fn line_of(address: u32) -> u32 {
    address >> LINE_SHIFT
}

/// The accelerator as FLASH_ACR sets it up. After reset: no wait states, everything off.
pub(super) struct FlashAccelerator {
    wait_states: u32,
    prefetch: bool,
    instructions: LineCache<INSTRUCTION_LINES>,
    data: LineCache<DATA_LINES>,
    /// The line that instructions are fetched from now.
    line: u32,
    /// Since when the core has it.
    entered: u64,
}

impl FlashAccelerator {
    pub fn new() -> Self {
        Self {
            wait_states: 0,
            prefetch: false,
            instructions: LineCache::new(),
            data: LineCache::new(),
            line: NO_LINE,
            entered: 0,
        }
    }

    pub fn set_timing(&mut self, wait_states: u32, prefetch: bool, icache: bool, dcache: bool) {
        self.wait_states = wait_states;
        self.prefetch = prefetch;
        self.instructions.enable(icache);
        self.data.enable(dcache);
    }

    /// Forgets the current line: the next fetch is not in sequence.
    pub fn jump(&mut self) {
        self.line = NO_LINE;
    }

    /// Whether an instruction at `pc` needs another line than the one before it.
    #[inline(always)]
    pub fn changes_line(&self, pc: u32) -> bool {
        line_of(pc) != self.line
    }

    /// The cycles that fetching from a new line takes.
    ///
    /// Reading a line takes a cycle and the wait states. After a jump, the cycle is that of the fetch
    /// itself, which the pipeline's refill pays for. The next line in sequence is read while the current
    /// one executes, from when the core got that (RM0090 §3.4.2, "Instruction prefetch"): the reads
    /// follow one another, and what the instructions of a line do not fill shows, that cycle included.
    #[inline(always)]
    pub fn enter_line(&mut self, pc: u32, now: u64) -> u64 {
        let line = line_of(pc);
        let in_sequence = line == self.line.wrapping_add(1);
        self.line = line;
        if self.wait_states == 0 || line >> 16 != FLASH_REGION {
            return 0;
        }
        self.fetch_line(line, in_sequence, now)
    }

    #[inline(never)]
    fn fetch_line(&mut self, line: u32, in_sequence: bool, now: u64) -> u64 {
        let cost = if self.instructions.holds(line) {
            0
        } else if in_sequence && self.prefetch {
            (u64::from(self.wait_states) + 1).saturating_sub(now - self.entered)
        } else {
            self.wait_states.into()
        };
        self.entered = now + cost;
        cost
    }

    /// The cycles that reading a constant from flash takes beyond those of RAM.
    #[inline]
    pub fn read_constant(&mut self, address: u32) -> u64 {
        if self.wait_states == 0 || self.data.holds(line_of(address)) {
            return 0;
        }
        self.wait_states.into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::memory::FLASH;

    fn accelerator(prefetch: bool, cache: bool) -> FlashAccelerator {
        let mut accelerator = FlashAccelerator::new();
        accelerator.set_timing(5, prefetch, cache, cache);
        accelerator
    }

    #[test]
    fn without_caches_every_new_line_waits() {
        let mut accelerator = accelerator(false, false);
        assert_eq!(accelerator.enter_line(FLASH, 0), 5);
        assert!(!accelerator.changes_line(FLASH + 15));
        assert_eq!(accelerator.enter_line(FLASH + 16, 100), 5);
        assert_eq!(accelerator.enter_line(FLASH, 200), 5);
        assert_eq!(accelerator.read_constant(FLASH), 5);
        assert_eq!(accelerator.read_constant(FLASH), 5);
    }

    #[test]
    fn the_prefetch_hides_the_wait_behind_the_line_before() {
        let mut accelerator = accelerator(true, false);
        assert_eq!(accelerator.enter_line(FLASH, 100), 5);
        // Four instructions of 32 bits, and two cycles of the six that the line takes are left.
        assert_eq!(accelerator.enter_line(FLASH + 16, 109), 2);
        assert_eq!(accelerator.enter_line(FLASH + 32, 115), 2);
        assert_eq!(accelerator.enter_line(FLASH + 48, 140), 0);
        assert_eq!(accelerator.enter_line(FLASH + 112, 160), 5);
    }

    #[test]
    fn a_line_in_the_cache_needs_no_prefetch() {
        let mut accelerator = accelerator(true, true);
        assert_eq!(accelerator.enter_line(FLASH, 100), 5);
        assert_eq!(accelerator.enter_line(FLASH + 16, 106), 5);
        assert_eq!(accelerator.enter_line(FLASH, 120), 0);
        assert_eq!(accelerator.enter_line(FLASH + 16, 121), 0);
    }

    #[test]
    fn a_loop_of_64_lines_runs_from_the_cache_and_one_of_65_does_not() {
        for (lines, expected) in [(64, 0), (65, 65 * 5)] {
            let mut accelerator = accelerator(false, true);
            let pass = |accelerator: &mut FlashAccelerator| -> u64 {
                (0..lines)
                    .map(|line| accelerator.enter_line(FLASH + 16 * line, 0))
                    .sum()
            };
            assert_eq!(pass(&mut accelerator), u64::from(lines) * 5);
            assert_eq!(pass(&mut accelerator), expected);
        }
    }

    #[test]
    fn eight_lines_of_constants_are_held() {
        let mut accelerator = accelerator(false, true);
        for line in 0..8 {
            assert_eq!(accelerator.read_constant(FLASH + 16 * line), 5);
        }
        assert_eq!(accelerator.read_constant(FLASH + 4), 0);
        accelerator.read_constant(FLASH + 16 * 8);
        assert_eq!(
            accelerator.read_constant(FLASH + 16),
            5,
            "the least recently used went"
        );
        assert_eq!(accelerator.read_constant(FLASH + 4), 0);
    }

    #[test]
    fn without_wait_states_flash_is_as_fast_as_ram() {
        let mut accelerator = FlashAccelerator::new();
        assert_eq!(accelerator.enter_line(FLASH, 0), 0);
        assert_eq!(accelerator.read_constant(FLASH), 0);
    }
}
