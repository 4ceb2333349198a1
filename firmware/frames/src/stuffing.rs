//! Byte stuffing: no zero inside a record, a zero on either side of it (COBS, see the crate's page).
//!
//! A code byte says how far it is to the next zero of the data, at most [`FULL`]; that zero is left
//! out. A code of [`FULL`] stands for 254 bytes behind which there is no zero.

use heapless::Vec;

/// What stands between records.
const DELIMITER: u8 = 0;

/// The code of a block that no zero ends.
const FULL: u8 = 0xff;

/// The most bytes that `len` bytes become, delimiters included.
pub(crate) const fn stuffed_len(len: usize) -> usize {
    len + len / (FULL as usize - 1) + 3
}

/// Appends `data`, stuffed and between delimiters. What does not fit is missing: the caller's capacity
/// is [`stuffed_len`] of the longest record.
pub(crate) fn stuff<const N: usize>(data: &[&[u8]], into: &mut Vec<u8, N>) {
    let mut out = Blocks {
        code_at: 0,
        code: 1,
        into,
    };
    out.begin();
    for byte in data.iter().copied().flatten() {
        out.push(*byte);
    }
    out.end();
}

/// The blocks of a record that is being stuffed.
struct Blocks<'a, const N: usize> {
    code_at: usize,
    code: u8,
    into: &'a mut Vec<u8, N>,
}

impl<const N: usize> Blocks<'_, N> {
    fn begin(&mut self) {
        let _ = self.into.push(DELIMITER);
        self.open();
    }

    /// A block whose code is not known yet.
    fn open(&mut self) {
        self.code_at = self.into.len();
        self.code = 1;
        let _ = self.into.push(FULL);
    }

    fn close(&mut self) {
        if let Some(code) = self.into.get_mut(self.code_at) {
            *code = self.code;
        }
    }

    fn push(&mut self, byte: u8) {
        // A full block is closed by the byte behind it: at the record's end there is none.
        if self.code == FULL {
            self.close();
            self.open();
        }
        if byte == 0 {
            self.close();
            self.open();
        } else {
            self.code += 1;
            let _ = self.into.push(byte);
        }
    }

    fn end(&mut self) {
        self.close();
        let _ = self.into.push(DELIMITER);
    }
}

/// What a byte of the wire means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unstuffed {
    /// Nothing yet.
    Nothing,
    /// The next byte of the record.
    Byte(u8),
    /// The record's end. Not whole: its last block was cut.
    End {
        /// Whether its last block is whole.
        whole: bool,
    },
}

/// Takes stuffing away, a byte at a time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unstuffer {
    /// Bytes that are left of the block.
    left: u8,
    /// Whether a zero stands between the block and the next.
    zero: bool,
}

impl Unstuffer {
    /// Before a record.
    pub(crate) const fn new() -> Self {
        Self {
            left: 0,
            zero: false,
        }
    }

    /// The next byte of the wire.
    pub(crate) fn push(&mut self, byte: u8) -> Unstuffed {
        if byte == DELIMITER {
            let whole = self.left == 0;
            *self = Self::new();
            Unstuffed::End { whole }
        } else if self.left > 0 {
            self.left -= 1;
            Unstuffed::Byte(byte)
        } else {
            let zero = core::mem::replace(&mut self.zero, byte != FULL);
            self.left = byte - 1;
            if zero {
                Unstuffed::Byte(0)
            } else {
                Unstuffed::Nothing
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::vec::Vec as List;

    use super::*;

    fn stuffed(data: &[u8]) -> List<u8> {
        let mut out = Vec::<u8, 2048>::new();
        stuff(&[data], &mut out);
        out.to_vec()
    }

    fn unstuffed(wire: &[u8]) -> List<u8> {
        let mut unstuffer = Unstuffer::new();
        let bytes = wire.iter().map(|byte| unstuffer.push(*byte));
        bytes
            .filter_map(|unstuffed| match unstuffed {
                Unstuffed::Byte(byte) => Some(byte),
                _ => None,
            })
            .collect()
    }

    /// The worked examples of the COBS paper's encoding, as the public tables of it have them.
    #[test]
    fn the_published_examples_have_these_bytes() {
        assert_eq!(stuffed(&[0x00]), [0, 0x01, 0x01, 0]);
        assert_eq!(stuffed(&[0x00, 0x00]), [0, 0x01, 0x01, 0x01, 0]);
        assert_eq!(
            stuffed(&[0x11, 0x22, 0x00, 0x33]),
            [0, 0x03, 0x11, 0x22, 0x02, 0x33, 0]
        );
        let run: List<u8> = (1..=254).collect();
        let full = [&[0, 0xff], &run[..], &[0]].concat();
        assert_eq!(stuffed(&run), full);
        let longer: List<u8> = (1..=255).collect();
        assert_eq!(
            stuffed(&longer),
            [&[0, 0xff], &run[..], &[0x02, 0xff, 0]].concat()
        );
    }

    #[test]
    fn every_length_and_every_place_of_a_zero_comes_back() {
        for len in 1..600 {
            for zero in [0, len / 2, 253, 254, 255, len - 1] {
                let mut data: List<u8> = (0..len).map(|at| (at % 255 + 1) as u8).collect();
                if let Some(byte) = data.get_mut(zero) {
                    *byte = 0;
                }
                let wire = stuffed(&data);
                assert!(wire.len() <= stuffed_len(len));
                assert_eq!(unstuffed(&wire), data);
            }
        }
    }
}
