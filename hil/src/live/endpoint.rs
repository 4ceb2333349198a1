//! Where the other end of a wire is, as it stands on the command line.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

/// Where a peer of the link is met.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Endpoint {
    /// Nobody is met: the wire is open at its other end.
    Nowhere,
    /// A pseudo-terminal of our own; whoever opens its device is the peer.
    Pty,
    /// A serial device that is there.
    Tty(PathBuf),
    /// A TCP port of this machine.
    Tcp(TcpPort),
}

/// A TCP port on localhost, not 0: both sides have to know it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TcpPort(u16);

/// Where the emulated camera's pose comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PoseSource {
    /// The STATE messages of the link.
    State,
    /// Lines of JSON on a TCP port.
    Tcp(TcpPort),
    /// Lines of JSON as long as somebody sends them, else the STATE messages.
    TcpElseState(TcpPort),
}

/// What stands there is no place to meet a peer.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EndpointError {
    /// Neither of the known kinds.
    #[error("`{0}` is none of pty, tty:PATH, tcp:PORT and none")]
    Kind(String),
    /// Not a pose source.
    #[error("`{0}` is neither state nor tcp:PORT")]
    Pose(String),
    /// A device without a name.
    #[error("tty: needs a path, as in tty:/dev/ttyUSB0")]
    NoPath,
    /// A port number that is none.
    #[error("`{0}` is no port: 1 to 65535")]
    Port(String),
}

impl TcpPort {
    /// Its number.
    pub const fn number(self) -> u16 {
        self.0
    }

    /// The port after this one, where there is one.
    pub const fn next(self) -> Option<Self> {
        match self.0.checked_add(1) {
            Some(number) => Some(Self(number)),
            None => None,
        }
    }
}

impl FromStr for TcpPort {
    type Err = EndpointError;

    /// `tcp:PORT`, or the port alone.
    fn from_str(text: &str) -> Result<Self, EndpointError> {
        let number = text.strip_prefix("tcp:").unwrap_or(text);
        match number.parse() {
            Ok(port) if port > 0 => Ok(Self(port)),
            _ => Err(EndpointError::Port(number.to_owned())),
        }
    }
}

impl FromStr for Endpoint {
    type Err = EndpointError;

    fn from_str(text: &str) -> Result<Self, EndpointError> {
        match text.split_once(':') {
            None if text == "none" => Ok(Self::Nowhere),
            None if text == "pty" => Ok(Self::Pty),
            Some(("tty", "")) => Err(EndpointError::NoPath),
            Some(("tty", path)) => Ok(Self::Tty(path.into())),
            Some(("tcp", port)) => port.parse().map(Self::Tcp),
            _ => Err(EndpointError::Kind(text.to_owned())),
        }
    }
}

impl FromStr for PoseSource {
    type Err = EndpointError;

    fn from_str(text: &str) -> Result<Self, EndpointError> {
        match text.strip_prefix("tcp:") {
            Some(port) => port.parse().map(Self::Tcp),
            None if text == "state" => Ok(Self::State),
            None => Err(EndpointError::Pose(text.to_owned())),
        }
    }
}

impl PoseSource {
    /// What holds where nothing is said: beside a TCP link its next port, else the STATE messages.
    pub fn beside(link: &Endpoint) -> Self {
        beside(link).map_or(Self::State, Self::TcpElseState)
    }

    /// The port that it listens on.
    pub fn port(self) -> Option<TcpPort> {
        match self {
            Self::State => None,
            Self::Tcp(port) | Self::TcpElseState(port) => Some(port),
        }
    }
}

/// The port on which two rigs that share a link exchange the true pose.
pub fn beside(link: &Endpoint) -> Option<TcpPort> {
    match link {
        Endpoint::Tcp(port) => port.next(),
        Endpoint::Nowhere | Endpoint::Pty | Endpoint::Tty(_) => None,
    }
}

impl fmt::Display for TcpPort {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "tcp:{}", self.0)
    }
}

impl fmt::Display for Endpoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nowhere => f.write_str("none"),
            Self::Pty => f.write_str("pty"),
            Self::Tty(path) => write!(f, "tty:{}", path.display()),
            Self::Tcp(port) => port.fmt(f),
        }
    }
}

impl fmt::Display for PoseSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::State => f.write_str("state"),
            Self::Tcp(port) => port.fmt(f),
            Self::TcpElseState(port) => write!(f, "{port}, else state"),
        }
    }
}
