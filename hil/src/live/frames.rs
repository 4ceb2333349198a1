//! Bytes that one end sends, cut into frames: what a peer gets is whole frames, and what it does not
//! get has a name.

use link::{Event, MAX_FRAME_LEN, Message, Parser};

/// One frame as it was sent, with whatever came before it that was none.
#[derive(Debug)]
pub struct Piece {
    /// What it says; none where the bytes are no frame.
    pub message: Option<Message>,
    /// As sent.
    pub bytes: Vec<u8>,
}

impl Piece {
    /// The message's name; `?` where there is none.
    pub fn name(&self) -> &'static str {
        self.message.as_ref().map_or("?", Message::name)
    }
}

/// Cuts a stream into frames.
#[derive(Debug, Default)]
pub struct Frames {
    parser: Parser,
    pending: Vec<u8>,
}

impl Frames {
    /// Takes bytes; the frames that they complete, in order.
    pub fn push(&mut self, mut bytes: &[u8]) -> Vec<Piece> {
        let mut pieces = Vec::new();
        loop {
            let before = bytes;
            let event = self.parser.next_event(&mut bytes);
            self.pending
                .extend_from_slice(&before[..before.len() - bytes.len()]);
            match event {
                Some(Event::Frame(frame)) => pieces.push(self.piece(Some(frame.message))),
                Some(Event::Refused(_)) => {}
                None => break,
            }
        }
        // No frame is that long: a peer that understands something else shall have it too.
        if self.pending.len() > MAX_FRAME_LEN {
            pieces.push(self.piece(None));
        }
        pieces
    }

    fn piece(&mut self, message: Option<Message>) -> Piece {
        Piece {
            message,
            bytes: std::mem::take(&mut self.pending),
        }
    }
}

#[cfg(test)]
mod tests {
    use link::{State, Vector};

    use super::*;

    #[test]
    fn a_frame_leaves_when_it_is_whole_however_it_came() {
        let mut sent = Message::State(State::default()).encode().to_vec();
        sent.extend(Message::Vector(Vector::default()).encode());
        let mut frames = Frames::default();
        let mut pieces = Vec::new();
        for byte in &sent {
            pieces.extend(frames.push(&[*byte]));
        }
        let names: Vec<_> = pieces.iter().map(Piece::name).collect();
        assert_eq!(names, ["STATE", "VECTOR"]);
        let bytes: Vec<u8> = pieces.into_iter().flat_map(|piece| piece.bytes).collect();
        assert_eq!(bytes, sent);
    }

    #[test]
    fn what_is_no_frame_goes_on_as_it_came() {
        let noise: Vec<u8> = (0..=255).cycle().take(1_000).collect();
        let mut frames = Frames::default();
        let pieces: Vec<_> = noise
            .chunks(10)
            .flat_map(|bytes| frames.push(bytes))
            .collect();
        assert!(pieces.iter().all(|piece| piece.message.is_none()));
        let bytes: Vec<u8> = pieces.into_iter().flat_map(|piece| piece.bytes).collect();
        assert!(bytes.len() >= 700 && noise.starts_with(&bytes));
    }
}
