//! The fields of a message body: little endian, without padding; arrays after a length byte.

use heapless::Vec;

use crate::frame::Encoded;

/// Appends fields to a frame under construction.
///
/// Nothing here can overflow: the capacities of the messages' arrays are what a frame leaves.
pub(crate) struct Writer<'a>(pub(crate) &'a mut Encoded);

impl Writer<'_> {
    fn put(&mut self, bytes: &[u8]) {
        let fitted = self.0.extend_from_slice(bytes);
        debug_assert!(fitted.is_ok(), "array capacities keep a body in its frame");
    }

    pub(crate) fn u8(&mut self, value: u8) {
        self.put(&[value]);
    }

    pub(crate) fn u16(&mut self, value: u16) {
        self.put(&value.to_le_bytes());
    }

    pub(crate) fn f32s<const N: usize>(&mut self, values: [f32; N]) {
        for value in values {
            self.put(&value.to_le_bytes());
        }
    }

    pub(crate) fn bytes(&mut self, array: &[u8]) {
        self.u8(array.len() as u8);
        self.put(array);
    }

    pub(crate) fn i8s(&mut self, array: &[i8]) {
        self.u8(array.len() as u8);
        for value in array {
            self.put(&value.to_le_bytes());
        }
    }
}

/// Takes fields from the front of a body; `None` once the body is too short, or an array
/// longer than any frame can carry.
pub(crate) struct Reader<'a>(pub(crate) &'a [u8]);

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (field, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*field)
    }

    pub(crate) fn u8(&mut self) -> Option<u8> {
        self.take().map(u8::from_le_bytes)
    }

    pub(crate) fn u16(&mut self) -> Option<u16> {
        self.take().map(u16::from_le_bytes)
    }

    pub(crate) fn f32(&mut self) -> Option<f32> {
        self.take().map(f32::from_le_bytes)
    }

    pub(crate) fn bytes<const N: usize>(&mut self) -> Option<Vec<u8, N>> {
        self.array(|byte| byte)
    }

    pub(crate) fn i8s<const N: usize>(&mut self) -> Option<Vec<i8, N>> {
        self.array(|byte| i8::from_le_bytes([byte]))
    }

    fn array<T, const N: usize>(&mut self, element: impl Fn(u8) -> T) -> Option<Vec<T, N>> {
        let len = usize::from(self.u8()?);
        let (elements, rest) = self.0.split_at_checked(len)?;
        self.0 = rest;
        let mut array = Vec::new();
        for byte in elements {
            array.push(element(*byte)).ok()?;
        }
        Some(array)
    }
}
