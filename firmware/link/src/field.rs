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

/// Takes fields from the front of a body whose size was checked; what lacks nevertheless is zero.
/// (An `Option` of each field would be copied, and with it the arrays of a message.)
pub(crate) struct Reader<'a>(pub(crate) &'a [u8]);

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> [u8; N] {
        let Some((field, rest)) = self.0.split_first_chunk() else {
            return [0; N];
        };
        self.0 = rest;
        *field
    }

    pub(crate) fn u8(&mut self) -> u8 {
        u8::from_le_bytes(self.take())
    }

    pub(crate) fn u16(&mut self) -> u16 {
        u16::from_le_bytes(self.take())
    }

    pub(crate) fn f32(&mut self) -> f32 {
        f32::from_le_bytes(self.take())
    }

    pub(crate) fn bytes<const N: usize>(&mut self) -> Vec<u8, N> {
        self.array(|byte| byte)
    }

    pub(crate) fn i8s<const N: usize>(&mut self) -> Vec<i8, N> {
        self.array(|byte| i8::from_le_bytes([byte]))
    }

    #[inline(never)]
    fn array<T, const N: usize>(&mut self, element: impl Fn(u8) -> T) -> Vec<T, N> {
        let len = usize::from(self.u8()).min(N);
        let elements = self.0.get(..len).unwrap_or_default();
        // As in every command of the flight app: it spares the copy of a whole array.
        if elements.is_empty() {
            return Vec::new();
        }
        let mut array = Vec::new();
        for byte in elements {
            let fitted = array.push(element(*byte));
            debug_assert!(fitted.is_ok(), "array capacities keep a body in its frame");
        }
        array
    }
}
