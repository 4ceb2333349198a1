//! The packer and the FIFO behind it (RM0090 §15.5.2, §15.5.4).

/// Words the FIFO holds.
const WORDS: usize = 4;

/// Bytes on their way to memory: an unfinished word, and finished ones nobody has fetched yet.
#[derive(Clone, Debug, Default)]
pub struct Fifo {
    /// The unfinished word: its first byte is the lowest.
    packing: u32,
    packed: u32,
    words: [u32; WORDS],
    len: usize,
}

impl Fifo {
    /// Takes a byte. False: it completes a word for which there is no room.
    pub fn push(&mut self, byte: u8) -> bool {
        self.packing |= u32::from(byte) << (8 * self.packed);
        self.packed += 1;
        if self.packed < 4 {
            return true;
        }
        let Some(room) = self.words.get_mut(self.len) else {
            return false;
        };
        *room = self.packing;
        self.len += 1;
        (self.packing, self.packed) = (0, 0);
        true
    }

    /// True while there is nothing in it, not even a part of a word.
    pub fn is_empty(&self) -> bool {
        self.len == 0 && self.packed == 0
    }

    /// True while a word is unfinished.
    pub fn is_mid_word(&self) -> bool {
        self.packed > 0
    }

    /// The word to be fetched next.
    pub fn first(&self) -> Option<u32> {
        (self.len > 0).then_some(self.words[0])
    }

    /// Drops the word to be fetched next, if there is one.
    pub fn pop(&mut self) {
        if self.len > 0 {
            self.words.rotate_left(1);
            self.len -= 1;
        }
    }
}
