//! A port: bytes to and from a peer that comes and goes. Never blocks, needs no thread: whoever owns
//! it polls it once in every step.

#[cfg(unix)]
mod pty;
mod tcp;
mod tty;

use std::fmt;
use std::io::{self, ErrorKind, Read, Write};

use super::endpoint::{Endpoint, TcpPort};

use tcp::Tcp;
use tty::Tty;

/// Bytes that wait for a peer that does not read, at most: 44 ms of the link at 921600 baud. A UART
/// has no memory; this one bridges the peer's naps, not more.
const UNSENT_BYTES: usize = 4096;
/// Bytes taken from a peer in one poll, at most. At a poll a millisecond forty times the link's rate.
const PIECE_BYTES: usize = 4096;

/// A stream to a peer that reads and writes without waiting: [`ErrorKind::WouldBlock`] or
/// [`ErrorKind::TimedOut`] where there is nothing to do, no bytes where the peer has gone.
trait Stream: Read + Write + fmt::Debug {}
impl<S: Read + Write + fmt::Debug> Stream for S {}

/// A peer that has come.
#[derive(Debug)]
struct Peer {
    stream: Box<dyn Stream>,
    /// For people: who it is.
    name: String,
}

/// Where peers come from. Nothing here waits.
trait Meeting: fmt::Debug {
    /// Looks for a peer; `news` takes what people should know beside its coming.
    fn seek(&mut self, news: &mut Vec<News>) -> Option<Peer>;

    /// There is a peer: sends others away.
    fn turn_away(&mut self) -> Option<News>;

    /// The peer has gone.
    fn lost(&mut self);
}

/// Nobody ever comes.
#[derive(Debug)]
struct Nobody;

impl Meeting for Nobody {
    fn seek(&mut self, _: &mut Vec<News>) -> Option<Peer> {
        None
    }

    fn turn_away(&mut self) -> Option<News> {
        None
    }

    fn lost(&mut self) {}
}

/// What happened at a port.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum News {
    /// A peer is there.
    Came(String),
    /// It has gone.
    Gone {
        /// Who, and how.
        peer: String,
        /// What waited for it: [`Port::send`] had taken it.
        unread: Vec<u8>,
    },
    /// Something else that people should know.
    Note(String),
}

/// Why bytes were not sent. They are not kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Unsent {
    /// Nobody is there.
    #[error("no peer")]
    NoPeer,
    /// Earlier bytes wait still.
    #[error("the peer does not read")]
    NotRead,
}

/// The port cannot be opened.
#[derive(Debug, thiserror::Error)]
#[error("{endpoint}: {error}")]
pub struct OpenError {
    endpoint: String,
    #[source]
    error: io::Error,
}

impl OpenError {
    pub(crate) fn new(endpoint: &dyn fmt::Display, error: io::Error) -> Self {
        Self {
            endpoint: endpoint.to_string(),
            error,
        }
    }
}

/// One end of a wire.
#[derive(Debug)]
pub struct Port {
    meeting: Box<dyn Meeting>,
    peer: Option<Peer>,
    unsent: Vec<u8>,
    /// For people: where the peer is to come.
    place: String,
    peers: u32,
}

impl Port {
    /// Opens an end of the link; `baud` concerns serial devices alone.
    ///
    /// # Errors
    /// [`OpenError`] where nobody could ever come: no such device, a port that is not ours to use.
    pub fn open(endpoint: &Endpoint, baud: u32) -> Result<Self, OpenError> {
        let opened = match endpoint {
            Endpoint::Nowhere => Ok((Box::new(Nobody) as Box<dyn Meeting>, endpoint.to_string())),
            Endpoint::Pty => open_pty(),
            Endpoint::Tty(path) => Tty::open(path.clone(), baud).map(|tty| {
                (
                    Box::new(tty) as Box<dyn Meeting>,
                    path.display().to_string(),
                )
            }),
            Endpoint::Tcp(port) => return Self::open_tcp(*port),
        };
        Self::new(opened, endpoint)
    }

    /// Opens a TCP port of this machine.
    ///
    /// # Errors
    /// [`OpenError`], as [`Self::open`].
    pub fn open_tcp(port: TcpPort) -> Result<Self, OpenError> {
        let opened = Tcp::open(port).map(|tcp| {
            let place = tcp.place();
            (Box::new(tcp) as Box<dyn Meeting>, place)
        });
        Self::new(opened, &port)
    }

    fn new(
        opened: io::Result<(Box<dyn Meeting>, String)>,
        endpoint: &dyn fmt::Display,
    ) -> Result<Self, OpenError> {
        let (meeting, place) = opened.map_err(|error| OpenError::new(endpoint, error))?;
        Ok(Self {
            meeting,
            peer: None,
            unsent: Vec::new(),
            place,
            peers: 0,
        })
    }

    /// For people: where a peer is to come.
    pub fn place(&self) -> &str {
        &self.place
    }

    /// Whether a peer is there.
    pub fn has_peer(&self) -> bool {
        self.peer.is_some()
    }

    /// How many peers have come.
    pub fn peers(&self) -> u32 {
        self.peers
    }

    /// Appends what has come, moves what waits, meets peers.
    pub fn poll(&mut self, received: &mut Vec<u8>) -> Vec<News> {
        let mut news = Vec::new();
        if self.peer.is_none() {
            self.peer = self.meeting.seek(&mut news);
            if let Some(peer) = &self.peer {
                self.peers += 1;
                news.push(News::Came(peer.name.clone()));
            }
        } else {
            news.extend(self.meeting.turn_away());
        }
        self.push();
        if let Err(why) = self.read(received)
            && let Some(peer) = self.peer.take()
        {
            self.meeting.lost();
            news.push(News::Gone {
                peer: format!("{}: {why}", peer.name),
                unread: std::mem::take(&mut self.unsent),
            });
        }
        news
    }

    /// Sends as many of `bytes` as the peer keeps up with; how many that are.
    ///
    /// # Errors
    /// [`Unsent::NoPeer`].
    pub fn send_some(&mut self, bytes: &[u8]) -> Result<usize, Unsent> {
        let some = bytes.len().min(UNSENT_BYTES - self.unsent.len());
        self.send(&bytes[..some]).map(|()| some)
    }

    /// Sends all of `bytes`, now or as soon as the peer reads; or nothing of it.
    ///
    /// # Errors
    /// [`Unsent`]: the bytes are dropped.
    pub fn send(&mut self, bytes: &[u8]) -> Result<(), Unsent> {
        if self.peer.is_none() {
            return Err(Unsent::NoPeer);
        }
        if self.unsent.len() + bytes.len() > UNSENT_BYTES {
            return Err(Unsent::NotRead);
        }
        self.unsent.extend_from_slice(bytes);
        self.push();
        Ok(())
    }

    /// Writes what waits as far as it goes. A peer that is gone is noticed when it is read from.
    fn push(&mut self) {
        if self.unsent.is_empty() {
            return;
        }
        if let Some(peer) = &mut self.peer
            && let Ok(written) = peer.stream.write(&self.unsent)
        {
            self.unsent.drain(..written);
        }
    }

    fn read(&mut self, received: &mut Vec<u8>) -> Result<(), String> {
        let Some(peer) = &mut self.peer else {
            return Ok(());
        };
        let mut piece = [0; PIECE_BYTES];
        match peer.stream.read(&mut piece) {
            Ok(0) => Err("closed".to_owned()),
            Ok(length) => {
                received.extend_from_slice(&piece[..length]);
                Ok(())
            }
            Err(error) if is_idle(&error) => Ok(()),
            Err(error) => Err(error.to_string()),
        }
    }
}

/// Whether an error only says that there is nothing to do.
fn is_idle(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted
    )
}

#[cfg(unix)]
fn open_pty() -> io::Result<(Box<dyn Meeting>, String)> {
    let pty = pty::Pty::open()?;
    let place = pty.device().display().to_string();
    Ok((Box::new(pty), place))
}

#[cfg(not(unix))]
fn open_pty() -> io::Result<(Box<dyn Meeting>, String)> {
    Err(io::Error::new(
        ErrorKind::Unsupported,
        "this system has no pseudo-terminals; use tcp:PORT",
    ))
}
