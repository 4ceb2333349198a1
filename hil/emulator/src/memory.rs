//! The plain memories of an STM32F407VG: flash, SRAM and core-coupled RAM (RM0090 §2.3).

/// Where flash begins.
pub const FLASH: u32 = 0x0800_0000;
/// Where SRAM1 begins; SRAM2 follows without a gap.
pub const SRAM: u32 = 0x2000_0000;
/// Where the core-coupled memory begins. DMA cannot reach it.
pub const CCM: u32 = 0x1000_0000;
/// Bytes of flash.
pub const FLASH_BYTES: usize = 1 << 20;
/// Bytes of SRAM1 and SRAM2 together.
pub const SRAM_BYTES: usize = 128 << 10;
/// Bytes of core-coupled memory.
pub const CCM_BYTES: usize = 64 << 10;

/// Flash, SRAM and CCM. Flash is visible at its own address and, as after a boot from main flash,
/// at address 0. All accesses are little-endian and may be unaligned, as on a Cortex-M4.
pub struct Memory {
    flash: Box<[u8; FLASH_BYTES]>,
    sram: Box<[u8; SRAM_BYTES]>,
    ccm: Box<[u8; CCM_BYTES]>,
}

/// A boxed array of equal elements, built without passing through the stack.
pub(crate) fn boxed<T: Copy, const N: usize>(element: T) -> Box<[T; N]> {
    match vec![element; N].into_boxed_slice().try_into() {
        Ok(array) => array,
        Err(_) => unreachable!("the slice was made with this length"),
    }
}

/// `N` bytes at `address` of a memory that begins at `base`; `None` where any of them is outside.
#[inline(always)]
fn peek<const N: usize>(memory: &[u8], base: u32, address: u32) -> Option<[u8; N]> {
    let offset = address.wrapping_sub(base) as usize;
    memory.get(offset..)?.first_chunk::<N>().copied()
}

/// The mutable twin of [`peek`].
#[inline(always)]
fn slot<const N: usize>(memory: &mut [u8], base: u32, address: u32) -> Option<&mut [u8; N]> {
    let offset = address.wrapping_sub(base) as usize;
    memory.get_mut(offset..)?.first_chunk_mut::<N>()
}

impl Default for Memory {
    fn default() -> Self {
        Self::new()
    }
}

impl Memory {
    /// Erased flash and zeroed RAM.
    pub fn new() -> Self {
        Self {
            flash: boxed(0xff),
            sram: boxed(0),
            ccm: boxed(0),
        }
    }

    /// Writes `word` all over both RAMs. Paint them before loading an image and the deepest stack
    /// can be read off afterwards.
    pub fn fill_ram(&mut self, word: u32) {
        for cell in self
            .sram
            .chunks_exact_mut(4)
            .chain(self.ccm.chunks_exact_mut(4))
        {
            cell.copy_from_slice(&word.to_le_bytes());
        }
    }

    /// Places bytes as a programmer would, in flash or in RAM. `None`: they do not fit in one memory.
    pub fn place(&mut self, address: u32, bytes: &[u8]) -> Option<()> {
        for (base, memory) in [
            (FLASH, &mut self.flash[..]),
            (SRAM, &mut self.sram[..]),
            (CCM, &mut self.ccm[..]),
        ] {
            let offset = address.wrapping_sub(base) as usize;
            let end = offset.checked_add(bytes.len());
            if let Some(room) = end.and_then(|end| memory.get_mut(offset..end)) {
                room.copy_from_slice(bytes);
                return Some(());
            }
        }
        None
    }

    /// `len` bytes from `address` on, where they lie in one memory.
    pub fn bytes(&self, address: u32, len: usize) -> Option<&[u8]> {
        for (base, memory) in [
            (SRAM, &self.sram[..]),
            (FLASH, &self.flash[..]),
            (CCM, &self.ccm[..]),
            (0, &self.flash[..]),
        ] {
            let offset = address.wrapping_sub(base) as usize;
            let end = offset.checked_add(len);
            if let Some(bytes) = end.and_then(|end| memory.get(offset..end)) {
                return Some(bytes);
            }
        }
        None
    }

    /// All of SRAM, for a hash of the machine's state.
    pub fn sram(&self) -> &[u8] {
        &self.sram[..]
    }

    /// All of CCM, for a hash of the machine's state.
    pub fn ccm(&self) -> &[u8] {
        &self.ccm[..]
    }

    /// `len` writable bytes of SRAM; `None` where any of them is outside.
    pub(crate) fn sram_mut(&mut self, address: u32, len: usize) -> Option<&mut [u8]> {
        let offset = address.wrapping_sub(SRAM) as usize;
        let end = offset.checked_add(len)?;
        self.sram.get_mut(offset..end)
    }

    /// `N` bytes of SRAM: the interpreter's fast path.
    #[inline(always)]
    pub(crate) fn sram_at<const N: usize>(&self, address: u32) -> Option<[u8; N]> {
        peek(&self.sram[..], SRAM, address)
    }

    /// `N` writable bytes of SRAM: the interpreter's fast path.
    #[inline(always)]
    pub(crate) fn sram_at_mut<const N: usize>(&mut self, address: u32) -> Option<&mut [u8; N]> {
        slot(&mut self.sram[..], SRAM, address)
    }

    #[inline]
    fn read<const N: usize>(&self, address: u32) -> Option<[u8; N]> {
        self.sram_at(address)
            .or_else(|| peek(&self.flash[..], FLASH, address))
            .or_else(|| peek(&self.ccm[..], CCM, address))
            .or_else(|| peek(&self.flash[..], 0, address))
    }

    #[inline]
    fn write<const N: usize>(&mut self, address: u32, bytes: [u8; N]) -> Option<()> {
        if let Some(room) = slot(&mut self.sram[..], SRAM, address) {
            *room = bytes;
        } else {
            *slot(&mut self.ccm[..], CCM, address)? = bytes;
        }
        Some(())
    }

    /// One byte; `None` outside flash, SRAM and CCM.
    #[inline]
    pub fn read8(&self, address: u32) -> Option<u8> {
        self.read(address).map(u8::from_le_bytes)
    }

    /// Two bytes; `None` outside flash, SRAM and CCM.
    #[inline]
    pub fn read16(&self, address: u32) -> Option<u16> {
        self.read(address).map(u16::from_le_bytes)
    }

    /// Four bytes; `None` outside flash, SRAM and CCM.
    #[inline]
    pub fn read32(&self, address: u32) -> Option<u32> {
        self.read(address).map(u32::from_le_bytes)
    }

    /// Writes RAM; `None` anywhere else, flash included.
    #[inline]
    pub fn write8(&mut self, address: u32, value: u8) -> Option<()> {
        self.write(address, value.to_le_bytes())
    }

    /// Writes RAM; `None` anywhere else, flash included.
    #[inline]
    pub fn write16(&mut self, address: u32, value: u16) -> Option<()> {
        self.write(address, value.to_le_bytes())
    }

    /// Writes RAM; `None` anywhere else, flash included.
    #[inline]
    pub fn write32(&mut self, address: u32, value: u32) -> Option<()> {
        self.write(address, value.to_le_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flash_is_visible_at_its_address_and_at_zero() {
        let mut memory = Memory::new();
        memory.place(FLASH + 4, &[0x78, 0x56, 0x34, 0x12]).unwrap();
        assert_eq!(memory.read32(FLASH + 4), Some(0x1234_5678));
        assert_eq!(memory.read16(6), Some(0x1234));
    }

    #[test]
    fn flash_does_not_take_stores() {
        assert_eq!(Memory::new().write32(FLASH, 1), None);
    }

    #[test]
    fn a_word_across_the_end_of_a_memory_is_not_there() {
        let memory = Memory::new();
        assert_eq!(memory.read32(SRAM + SRAM_BYTES as u32 - 4), Some(0));
        assert_eq!(memory.read32(SRAM + SRAM_BYTES as u32 - 3), None);
        assert_eq!(memory.read16(CCM - 1), None);
        assert_eq!(memory.read8(u32::MAX), None);
    }

    #[test]
    fn painted_ram_reads_back_until_it_is_overwritten() {
        let mut memory = Memory::new();
        memory.fill_ram(0xc0de_c0de);
        memory.write16(CCM + 2, 0).unwrap();
        assert_eq!(memory.read32(SRAM + 100), Some(0xc0de_c0de));
        assert_eq!(memory.bytes(CCM, 4), Some(&[0xde, 0xc0, 0, 0][..]));
    }
}
