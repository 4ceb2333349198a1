//! A claim that must turn out false: that a board takes what is broken. Who never sees a rig fail
//! cannot know whether it would.

use std::thread;
use std::time::{Duration, Instant};

use frames::{Identity, Pieces, Replies, Reply, Shape, Verdict};

use crate::live::Port;

use super::file::Rig;
use super::probe::{self, Image};
use super::ready::{Unready, make_ready};

/// For a word about a frame; a good one has it within 100 ms.
const ANSWER: Duration = Duration::from_millis(1_000);
/// Between two looks.
const LOOK_EVERY: Duration = Duration::from_millis(2);
/// The byte that is broken: in the middle of a piece's payload.
const BROKEN_AT: usize = 500;

/// What became of two frames that differ in one byte on the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Canary {
    /// Of the one that was sent as it should be; none where nothing was heard of it.
    pub whole: Option<Verdict>,
    /// Of the one with a wrong byte.
    pub broken: Option<Verdict>,
}

/// Makes a rig ready and sends it a frame, and one that is broken.
///
/// # Errors
/// [`Unready`]; a rig with a fitted camera has no line to break a frame on.
pub fn canary(rig: &Rig, image: &Image, identity: Option<&Identity>) -> Result<Canary, Unready> {
    let mut probe = probe::of(rig);
    let ready = make_ready(rig, probe.as_mut(), image, identity)?;
    let (mut port, shape) = ready.frames.ok_or(Unready::NoFramesLine)?;
    let mut replies = Replies::new();
    let mut sing = |number, broken| {
        let wire = frame(number, &shape, broken);
        verdict(&mut port, &mut replies, number, &wire)
    };
    Ok(Canary {
        whole: sing(1, false),
        broken: sing(2, true),
    })
}

/// A grey frame on the wire, in whose first piece one bit may be wrong.
fn frame(number: u32, shape: &Shape, broken: bool) -> Vec<u8> {
    let grey = vec![0x80; shape.bytes()];
    let mut wire: Vec<u8> = Pieces::of(number, &grey, shape).flatten().collect();
    if broken && let Some(byte) = wire.get_mut(BROKEN_AT) {
        *byte ^= 0x10;
    }
    wire
}

/// What the board says of a frame.
fn verdict(port: &mut Port, replies: &mut Replies, number: u32, wire: &[u8]) -> Option<Verdict> {
    let started = Instant::now();
    let mut left = wire;
    while started.elapsed() < ANSWER {
        if let Ok(sent) = port.send_some(left) {
            left = &left[sent..];
        }
        let mut received = Vec::new();
        port.poll(&mut received);
        let mut unread = &received[..];
        while let Some(reply) = replies.next_reply(&mut unread) {
            if let Ok(Reply::Verdict {
                number: of,
                verdict,
                ..
            }) = reply
                && of == number
            {
                return Some(verdict);
            }
        }
        thread::sleep(LOOK_EVERY);
    }
    None
}
