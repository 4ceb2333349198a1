//! What an image is: in its flash and over the wire in the same bytes.

use crate::PROTOCOL;
use crate::shape::Shape;

/// First bytes of an identification in flash.
const MAGIC: [u8; 4] = *b"CATA";

/// Room for the version's text.
pub const VERSION_BYTES: usize = 16;

/// What an image may do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum ImageKind {
    /// The camera alone gives frames. For flight.
    Flight,
    /// Takes frames from a wire, too. For the bench.
    Rig,
}

impl ImageKind {
    /// In a word.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Flight => "flight",
            Self::Rig => "rig",
        }
    }
}

/// Which pins an image uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum BoardName {
    /// The board that flies.
    Flight,
    /// An STM32F4DISCOVERY.
    Discovery,
}

impl BoardName {
    /// In a word.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Flight => "flight",
            Self::Discovery => "discovery",
        }
    }
}

/// What an image is.
///
/// | offset | size | meaning |
/// |---|---|---|
/// | 0 | 4 | `CATA` |
/// | 4 | 2 | protocol of the frames over serial |
/// | 6 | 1 | kind: 0 flight, 1 rig |
/// | 7 | 1 | board: 0 flight, 1 discovery |
/// | 8 | 2, 2, 1, 1 | frame: width, height, bytes of a pixel, offset of its luma |
/// | 14 | 2 | zero |
/// | 16 | 4 | rate of the frames' UART, baud; 0 in a flight image |
/// | 20 | 4 | address of the lens record's page |
/// | 24 | 16 | version, zeros behind it |
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Identity {
    /// The protocol that it speaks; [`PROTOCOL`] is the one that this crate does.
    pub protocol: u16,
    /// What it may do.
    pub kind: ImageKind,
    /// Which pins it uses.
    pub board: BoardName,
    /// The frames that it works on.
    pub shape: Shape,
    /// Rate of the UART that takes frames, baud; 0 where there is none.
    pub baud: u32,
    /// Where the lens record's page is.
    pub lens_page: u32,
    version: [u8; VERSION_BYTES],
}

impl Identity {
    /// Bytes of an identification.
    pub const BYTES: usize = 40;

    /// The identification of an image of this version (cut at [`VERSION_BYTES`]).
    pub const fn new(
        kind: ImageKind,
        board: BoardName,
        shape: Shape,
        baud: u32,
        lens_page: u32,
        version: &str,
    ) -> Self {
        let mut text = [0; VERSION_BYTES];
        let mut from = version.as_bytes();
        let mut to: &mut [u8] = &mut text;
        while let ([byte, from_rest @ ..], [place, to_rest @ ..]) = (from, to) {
            *place = *byte;
            (from, to) = (from_rest, to_rest);
        }
        Self {
            protocol: PROTOCOL,
            kind,
            board,
            shape,
            baud,
            lens_page,
            version: text,
        }
    }

    /// The version's text; empty where it is none.
    pub fn version(&self) -> &str {
        let text = self.version.split(|byte| *byte == 0).next();
        core::str::from_utf8(text.unwrap_or_default()).unwrap_or_default()
    }

    /// The bytes in flash and on the wire.
    pub const fn encode(&self) -> [u8; Self::BYTES] {
        let [p, q] = self.protocol.to_le_bytes();
        let [w, x] = self.shape.width.to_le_bytes();
        let [h, i] = self.shape.height.to_le_bytes();
        let [pixel, luma] = [self.shape.bytes_per_pixel, self.shape.luma_offset];
        let (kind, board) = (self.kind as u8, self.board as u8);
        let head = [p, q, kind, board, w, x, h, i, pixel, luma, 0, 0];
        let mut bytes = [0; Self::BYTES];
        let (magic, rest) = bytes.split_at_mut(MAGIC.len());
        magic.copy_from_slice(&MAGIC);
        let (place, rest) = rest.split_at_mut(head.len());
        place.copy_from_slice(&head);
        let (place, rest) = rest.split_at_mut(4);
        place.copy_from_slice(&self.baud.to_le_bytes());
        let (place, rest) = rest.split_at_mut(4);
        place.copy_from_slice(&self.lens_page.to_le_bytes());
        rest.copy_from_slice(&self.version);
        bytes
    }

    /// Reads an identification; none where the bytes are none.
    pub fn decode(bytes: &[u8; Self::BYTES]) -> Option<Self> {
        let (magic, rest) = bytes.split_first_chunk()?;
        let (&[p, q, kind, board, w, x, h, i, pixel, luma, _, _], rest) =
            rest.split_first_chunk()?;
        let (baud, rest) = rest.split_first_chunk()?;
        let (lens_page, rest) = rest.split_first_chunk()?;
        let kinds = [ImageKind::Flight, ImageKind::Rig];
        let boards = [BoardName::Flight, BoardName::Discovery];
        (*magic == MAGIC).then_some(())?;
        Some(Self {
            protocol: u16::from_le_bytes([p, q]),
            kind: kinds.into_iter().find(|known| *known as u8 == kind)?,
            board: boards.into_iter().find(|known| *known as u8 == board)?,
            shape: Shape {
                width: u16::from_le_bytes([w, x]),
                height: u16::from_le_bytes([h, i]),
                bytes_per_pixel: pixel,
                luma_offset: luma,
            },
            baud: u32::from_le_bytes(*baud),
            lens_page: u32::from_le_bytes(*lens_page),
            version: *rest.first_chunk()?,
        })
    }
}
