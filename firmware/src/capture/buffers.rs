//! The two frame buffers.

use core::cell::UnsafeCell;
use core::mem::MaybeUninit;

use sensor::tcm8230::GEOMETRY;

/// Bytes of a frame: 128 x 96 x 2.
pub const FRAME_BYTES: usize = GEOMETRY.frame_bytes();

/// Words of a frame; the DMA moves words.
pub const FRAME_WORDS: u32 = (FRAME_BYTES / 4) as u32;

/// Words of a line.
pub const LINE_WORDS: u32 = (GEOMETRY.line_bytes() / 4) as u32;

/// A frame as its readers see it.
pub type Bytes = [u8; FRAME_BYTES];

const _: () = assert!(GEOMETRY.line_bytes().is_multiple_of(4) && FRAME_WORDS <= u16::MAX as u32);

/// Which of the two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Buffer {
    /// The DMA's memory 0.
    A,
    /// The DMA's memory 1.
    B,
}

/// The buffer of the frame with this number: odd ones lie in A, even ones in B.
pub fn buffer_of(number: u32) -> Buffer {
    if number % 2 == 1 {
        Buffer::A
    } else {
        Buffer::B
    }
}

#[repr(align(4))]
struct Memory(UnsafeCell<[MaybeUninit<Bytes>; 2]>);

// SAFETY: the bytes are reached through `address` (the DMA's way) and `bytes`, whose callers must
// see to it that the two do not meet.
unsafe impl Sync for Memory {}

/// In SRAM1, which DMA2 reaches, and in a section that the start-up code does not zero: 48 KiB
/// would cost it time, and no byte is read before the DMA wrote it.
#[unsafe(link_section = ".uninit.frames")]
static MEMORY: Memory = Memory(UnsafeCell::new([const { MaybeUninit::uninit() }; 2]));

/// Where the DMA writes.
pub fn address(buffer: Buffer) -> u32 {
    MEMORY.0.get() as u32 + buffer as u32 * FRAME_BYTES as u32
}

/// The bytes of a buffer.
///
/// # Safety
/// The DMA must have filled the buffer, and must be busy with the other one.
pub unsafe fn bytes(buffer: Buffer) -> &'static Bytes {
    // SAFETY: in bounds, aligned, and initialised by the DMA as the caller promises.
    unsafe { &*(address(buffer) as *const Bytes) }
}

/// The bytes of a buffer, to be written.
///
/// # Safety
/// The DMA must be off, and nobody may read the buffer as long as the reference lives.
#[cfg(feature = "rig")]
pub unsafe fn bytes_mut(buffer: Buffer) -> &'static mut MaybeUninit<Bytes> {
    // SAFETY: in bounds, aligned, and nobody else's as the caller promises.
    unsafe { &mut *(address(buffer) as *mut MaybeUninit<Bytes>) }
}
