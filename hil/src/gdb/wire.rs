//! The TCP connection to a GDB.

use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::thread;
use std::time::{Duration, Instant};

use gdbstub::conn::Connection;

/// Bytes taken at once, at most.
const PIECE_BYTES: usize = 4096;
/// A GDB that does not read for so long is gone.
const PATIENCE: Duration = Duration::from_secs(5);
/// Between two attempts to write.
const RETRY: Duration = Duration::from_millis(1);

/// Reads without waiting; what is written is kept until it is flushed.
#[derive(Debug)]
pub struct Wire {
    stream: TcpStream,
    unsent: Vec<u8>,
}

impl Wire {
    /// Takes a connection.
    ///
    /// # Errors
    /// The system's.
    pub fn new(stream: TcpStream) -> io::Result<Self> {
        stream.set_nodelay(true)?;
        stream.set_nonblocking(true)?;
        Ok(Self {
            stream,
            unsent: Vec::new(),
        })
    }

    /// What has come.
    ///
    /// # Errors
    /// The other end has gone.
    pub fn receive(&mut self) -> io::Result<Vec<u8>> {
        let mut piece = vec![0; PIECE_BYTES];
        let length = match self.stream.read(&mut piece) {
            Ok(0) => return Err(ErrorKind::ConnectionReset.into()),
            Ok(length) => length,
            Err(error) if error.kind() == ErrorKind::WouldBlock => 0,
            Err(error) => return Err(error),
        };
        piece.truncate(length);
        Ok(piece)
    }
}

impl Connection for Wire {
    type Error = io::Error;

    fn write(&mut self, byte: u8) -> io::Result<()> {
        self.unsent.push(byte);
        Ok(())
    }

    fn flush(&mut self) -> io::Result<()> {
        let since = Instant::now();
        while !self.unsent.is_empty() {
            match Write::write(&mut self.stream, &self.unsent) {
                Ok(written) => drop(self.unsent.drain(..written)),
                Err(error) if error.kind() != ErrorKind::WouldBlock => return Err(error),
                Err(error) if since.elapsed() > PATIENCE => return Err(error),
                Err(_) => thread::sleep(RETRY),
            }
        }
        Ok(())
    }
}
