//! Who speaks on a line: a board answers in one language on its link and in another where it takes
//! frames, so that two wires in each other's place are told from one that is broken.

use std::thread;
use std::time::{Duration, Instant};

use frames::{Identity, Replies, Reply, Request};
use link::{Command, Message, Mode, Parser};

use crate::live::{Endpoint, News, OpenError, Port};

use super::file::Line;

/// Between two questions: an answer takes a millisecond, and a board that boots hears nothing.
const ASK_EVERY: Duration = Duration::from_millis(200);
/// Between two looks at the line.
const LOOK_EVERY: Duration = Duration::from_millis(2);

/// Everything that was heard on a line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Heard {
    /// Bytes.
    pub bytes: usize,
    /// Our own question came back: RX and TX are connected.
    pub echo: bool,
    /// Somebody answered in the language of the link.
    pub link: bool,
    /// Somebody said who he is in the language of the frames.
    pub identity: Option<Identity>,
    /// The device went away.
    pub lost: Option<String>,
}

/// A line with somebody who listens to it.
#[derive(Debug)]
pub struct Voices {
    port: Port,
    parser: Parser,
    replies: Replies,
    heard: Heard,
    asked: Option<Instant>,
}

impl Voices {
    /// Opens a line.
    ///
    /// # Errors
    /// [`OpenError`].
    pub fn open(line: &Line) -> Result<Self, OpenError> {
        let endpoint = Endpoint::Tty(line.device.clone());
        Ok(Self {
            port: Port::open(&endpoint, line.baud)?,
            parser: Parser::new(),
            replies: Replies::new(),
            heard: Heard::default(),
            asked: None,
        })
    }

    /// The line, for another conversation.
    pub fn into_port(self) -> Port {
        self.port
    }

    /// What was heard so far.
    pub fn heard(&self) -> &Heard {
        &self.heard
    }

    /// Asks now and then, in both languages, and listens.
    fn poll(&mut self) {
        if self.asked.is_none_or(|asked| asked.elapsed() >= ASK_EVERY) {
            self.asked = Some(Instant::now());
            // Whether it was sent, the answer will tell.
            let _ = self.port.send(&question().encode());
            let _ = self.port.send(&Request::Identify.encode());
        }
        let mut received = Vec::new();
        for news in self.port.poll(&mut received) {
            if let News::Gone { peer, .. } = news {
                self.heard.lost = Some(peer);
            }
        }
        self.heard.bytes += received.len();
        for frame in self.parser.frames(&received) {
            let is_echo = frame.message == question();
            self.heard.echo |= is_echo;
            self.heard.link |= !is_echo;
        }
        let mut unread = &received[..];
        while let Some(reply) = self.replies.next_reply(&mut unread) {
            if let Ok(Reply::Identity(identity)) = reply {
                self.heard.identity = Some(identity);
            }
        }
    }
}

/// A command that changes nothing on a board that has just been switched on. The argument, which asks
/// for nothing either, makes it differ from the answer.
fn question() -> Message {
    let mut command = Command {
        command: Mode::Idle.byte(),
        ..Command::default()
    };
    // There is room for it.
    let _ = command.args.push(0);
    Message::Command(command)
}

/// Asks on all lines until `done` holds of what was heard, or for `limit`.
pub fn listen(lines: &mut [&mut Voices], limit: Duration, done: impl Fn(&[&Heard]) -> bool) {
    let started = Instant::now();
    loop {
        for line in lines.iter_mut() {
            line.poll();
        }
        let heard: Vec<&Heard> = lines.iter().map(|line| line.heard()).collect();
        if done(&heard) || started.elapsed() >= limit {
            return;
        }
        thread::sleep(LOOK_EVERY);
    }
}
