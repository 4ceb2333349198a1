//! Reads the firmware's log as a debug probe does: through the RTT buffers in its RAM.

use emulator::image::Image;
use emulator::memory::Memory;

/// Offsets in SEGGER's control block: id (16 bytes), number of up and of down channels, then the
/// channels of six words each: name, buffer, size, write offset, read offset, flags.
const UP_CHANNEL_0: u32 = 24;
const BUFFER: u32 = UP_CHANNEL_0 + 4;
const SIZE: u32 = UP_CHANNEL_0 + 8;
const WRITE_OFFSET: u32 = UP_CHANNEL_0 + 12;
const READ_OFFSET: u32 = UP_CHANNEL_0 + 16;

/// The first up channel of a control block.
#[derive(Clone, Copy, Debug)]
pub struct UpChannel {
    control_block: u32,
}

impl UpChannel {
    /// Where the control block is.
    pub const SYMBOL: &'static str = "_SEGGER_RTT";

    /// The channel of an image, if it has one.
    pub fn of(image: &Image) -> Option<Self> {
        image.symbol(Self::SYMBOL).map(|symbol| Self {
            control_block: symbol.address,
        })
    }

    /// Moves what the firmware wrote since the last call to `into` and frees its buffer.
    pub fn drain(self, memory: &mut Memory, into: &mut Vec<u8>) {
        let word = |offset| memory.read32(self.control_block + offset).unwrap_or(0);
        let [buffer, size, write, read] = [BUFFER, SIZE, WRITE_OFFSET, READ_OFFSET].map(word);
        // Before the firmware has set the block up it holds whatever RAM held.
        if write == read || write >= size || read >= size {
            return;
        }
        let parts = if read < write {
            [(read, write), (0, 0)]
        } else {
            [(read, size), (0, write)]
        };
        for (from, to) in parts {
            if let Some(bytes) = memory.bytes(buffer + from, (to - from) as usize) {
                into.extend_from_slice(bytes);
            }
        }
        memory.write32(self.control_block + READ_OFFSET, write);
    }
}
