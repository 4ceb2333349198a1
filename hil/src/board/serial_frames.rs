//! Frames over serial into an emulated board: the other end of its USART3, in virtual time.

use emulator::machine::Machine;
use emulator::wiring::Wiring;
use frames::{Pieces, Replies, Reply, Request, Shape};

/// The UART on which a rig image takes frames.
pub const SERIAL_USART: u8 = 3;

/// The frames that the firmware works on.
pub const SHAPE: Shape = Shape {
    width: pilot::FRAME_LAYOUT.width,
    height: pilot::FRAME_LAYOUT.height,
    bytes_per_pixel: pilot::FRAME_LAYOUT.bytes_per_pixel,
    luma_offset: pilot::FRAME_LAYOUT.luma_offset,
};

/// The host's end of the wire. What is sent goes on the wire now, or behind what is still on it, at the
/// rate that the firmware has set.
#[derive(Debug, Default)]
pub struct SerialFrames {
    replies: Replies,
}

impl SerialFrames {
    /// The end of a wire on which nothing has been said.
    pub fn new() -> Self {
        Self::default()
    }

    /// Asks the board for something.
    pub fn ask<W: Wiring>(&self, machine: &mut Machine<W>, request: Request) {
        self.send(machine, &request.encode());
    }

    /// Sends a frame under a number.
    pub fn send_frame<W: Wiring>(
        &self,
        machine: &mut Machine<W>,
        number: u32,
        frame: &pilot::Frame,
    ) {
        for piece in Pieces::of(number, frame, &SHAPE) {
            self.send(machine, &piece);
        }
    }

    /// Puts bytes on the wire, whatever they are.
    pub fn send<W: Wiring>(&self, machine: &mut Machine<W>, bytes: &[u8]) {
        let now = machine.now();
        machine.usart_send(SERIAL_USART, now, bytes);
    }

    /// What the board has answered since the last call. Broken answers, which an emulated wire has
    /// none of, are left out.
    pub fn replies<W: Wiring>(&mut self, machine: &mut Machine<W>) -> Vec<Reply> {
        let received = machine.usart_received(SERIAL_USART);
        let bytes: Vec<u8> = received.into_iter().map(|(_, byte)| byte).collect();
        let mut bytes = &bytes[..];
        let mut replies = Vec::new();
        while let Some(reply) = self.replies.next_reply(&mut bytes) {
            replies.extend(reply);
        }
        replies
    }
}
