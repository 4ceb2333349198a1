//! Two programs meet on a TCP port of this machine, whichever comes first and however often either
//! starts again: who finds the port free listens there, who finds it taken connects to it, and who
//! loses the other one begins anew. One peer at a time; others are told so and sent away.

use std::io::{self, ErrorKind, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::time::{Duration, Instant};

use super::{Meeting, News, Peer, is_idle};
use crate::live::endpoint::TcpPort;

/// Between two attempts to get hold of the port.
const RETRY: Duration = Duration::from_millis(100);
/// How long a connection may take on this machine.
const CONNECT_LIMIT: Duration = Duration::from_millis(100);
/// How long who connects waits for [`BUSY`] before the connection counts.
const GRACE: Duration = Duration::from_millis(200);
/// What a second peer reads. No frame of the link begins in it.
const BUSY: &[u8] = b"busy: another peer is connected\n";

/// A place on a port.
#[derive(Debug)]
pub struct Tcp {
    port: TcpPort,
    /// Kept while there is a peer: its successor finds the port taken.
    listener: Option<TcpListener>,
    joining: Option<Joining>,
    retry_at: Instant,
    told_busy: bool,
}

/// A connection that we have made and that the other side may yet refuse.
#[derive(Debug)]
struct Joining {
    stream: TcpStream,
    since: Instant,
}

/// What has become of it.
enum Welcome {
    Open,
    Granted,
    Busy,
    Closed,
}

impl Tcp {
    /// Takes the port, or sees that another holds it.
    ///
    /// # Errors
    /// Where the port can neither be listened on nor is taken.
    pub fn open(port: TcpPort) -> io::Result<Self> {
        let listener = listen(port)?;
        Ok(Self {
            port,
            listener,
            joining: None,
            retry_at: Instant::now(),
            told_busy: false,
        })
    }

    /// For people: what is done there.
    pub fn place(&self) -> String {
        let address = address(self.port);
        match self.listener {
            Some(_) => format!("listening on {address}"),
            None => format!("connecting to {address}"),
        }
    }

    fn accept(&self) -> Option<(TcpStream, SocketAddr)> {
        let (stream, from) = self.listener.as_ref()?.accept().ok()?;
        prepare(&stream).ok()?;
        Some((stream, from))
    }

    /// Whether the connection that was made is one.
    fn join(&mut self, news: &mut Vec<News>) -> Option<TcpStream> {
        match welcome(self.joining.as_ref()?) {
            Welcome::Open => return None,
            Welcome::Granted => {
                self.told_busy = false;
                return self.joining.take().map(|joining| joining.stream);
            }
            Welcome::Busy if !self.told_busy => {
                self.told_busy = true;
                news.push(News::Note(format!(
                    "{} is busy: another peer is connected there; trying again",
                    address(self.port)
                )));
            }
            Welcome::Busy | Welcome::Closed => {}
        }
        self.joining = None;
        None
    }

    /// Listens, or else connects.
    fn take_place(&mut self, news: &mut Vec<News>) {
        let now = Instant::now();
        if now < self.retry_at {
            return;
        }
        self.retry_at = now + RETRY;
        match listen(self.port) {
            Ok(Some(listener)) => {
                self.listener = Some(listener);
                news.push(News::Note(self.place()));
            }
            Ok(None) => self.joining = connect(self.port),
            // Not when the port was opened; whatever it is, it may pass.
            Err(_) => {}
        }
    }
}

impl Meeting for Tcp {
    fn seek(&mut self, news: &mut Vec<News>) -> Option<Peer> {
        let (stream, name) = if self.listener.is_some() {
            let (stream, from) = self.accept()?;
            (stream, from.to_string())
        } else if self.joining.is_some() {
            (self.join(news)?, address(self.port).to_string())
        } else {
            self.take_place(news);
            return None;
        };
        Some(Peer {
            stream: Box::new(stream),
            name,
        })
    }

    fn turn_away(&mut self) -> Option<News> {
        let (mut stream, from) = self.accept()?;
        // It is closed in any case.
        let _ = stream.write(BUSY);
        Some(News::Note(format!(
            "{from} sent away: another peer is connected"
        )))
    }

    fn lost(&mut self) {
        self.retry_at = Instant::now();
    }
}

fn address(port: TcpPort) -> SocketAddr {
    (Ipv4Addr::LOCALHOST, port.number()).into()
}

/// A listener; `None` where another has the port.
fn listen(port: TcpPort) -> io::Result<Option<TcpListener>> {
    match TcpListener::bind(address(port)) {
        Ok(listener) => {
            listener.set_nonblocking(true)?;
            Ok(Some(listener))
        }
        Err(error) if error.kind() == ErrorKind::AddrInUse => Ok(None),
        Err(error) => Err(error),
    }
}

fn connect(port: TcpPort) -> Option<Joining> {
    let stream = TcpStream::connect_timeout(&address(port), CONNECT_LIMIT).ok()?;
    // A free port among those that the system gives to callers can be connected with itself.
    if stream.local_addr().ok()? == stream.peer_addr().ok()? {
        return None;
    }
    prepare(&stream).ok()?;
    Some(Joining {
        stream,
        since: Instant::now(),
    })
}

/// Frames are short and want to be there at once.
fn prepare(stream: &TcpStream) -> io::Result<()> {
    stream.set_nodelay(true)?;
    stream.set_nonblocking(true)
}

fn welcome(joining: &Joining) -> Welcome {
    let mut start = [0; BUSY.len()];
    match joining.stream.peek(&mut start) {
        Ok(0) => Welcome::Closed,
        Ok(length) if start == BUSY => {
            debug_assert_eq!(length, BUSY.len());
            Welcome::Busy
        }
        Ok(length) if BUSY.starts_with(&start[..length]) => patience(joining),
        Ok(_) => Welcome::Granted,
        Err(error) if is_idle(&error) => patience(joining),
        Err(_) => Welcome::Closed,
    }
}

fn patience(joining: &Joining) -> Welcome {
    if joining.since.elapsed() >= GRACE {
        Welcome::Granted
    } else {
        Welcome::Open
    }
}
