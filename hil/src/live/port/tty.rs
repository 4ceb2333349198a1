//! A serial device that is there: a USB adapter, a board's own port, the far end of a pseudo-terminal.

use std::io::{self, Read, Write};
use std::path::PathBuf;
use std::time::{Duration, Instant};

use serial2::SerialPort;

use super::{Meeting, News, Peer};

/// Between two attempts to open a device that has gone.
const RETRY: Duration = Duration::from_secs(1);

/// A device by its path.
#[derive(Debug)]
pub struct Tty {
    path: PathBuf,
    baud: u32,
    /// Opened before anybody asked.
    opened: Option<Serial>,
    retry_at: Instant,
}

impl Tty {
    /// Opens the device: 8N1, raw, no flow control.
    ///
    /// # Errors
    /// Where it is not there, is no serial device, or cannot do the rate.
    pub fn open(path: PathBuf, baud: u32) -> io::Result<Self> {
        let opened = Serial::open(&path, baud)?;
        Ok(Self {
            path,
            baud,
            opened: Some(opened),
            retry_at: Instant::now(),
        })
    }

    fn open_again(&mut self) -> Option<Serial> {
        let now = Instant::now();
        if now < self.retry_at {
            return None;
        }
        self.retry_at = now + RETRY;
        Serial::open(&self.path, self.baud).ok()
    }
}

impl Meeting for Tty {
    fn seek(&mut self, _: &mut Vec<News>) -> Option<Peer> {
        let serial = self.opened.take().or_else(|| self.open_again())?;
        Some(Peer {
            stream: Box::new(serial),
            name: self.path.display().to_string(),
        })
    }

    fn turn_away(&mut self) -> Option<News> {
        None
    }

    fn lost(&mut self) {
        self.retry_at = Instant::now() + RETRY;
    }
}

#[derive(Debug)]
struct Serial(SerialPort);

impl Serial {
    fn open(path: &PathBuf, baud: u32) -> io::Result<Self> {
        let mut port = SerialPort::open(path, baud)?;
        port.set_read_timeout(Duration::ZERO)?;
        port.set_write_timeout(Duration::ZERO)?;
        Ok(Self(port))
    }
}

impl Read for Serial {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.0.read(buffer)
    }
}

impl Write for Serial {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
