//! The probe of an emulated board: [`wire`] on TCP.

use std::io::{BufRead, BufReader, ErrorKind, Read, Write};
use std::net::{Ipv4Addr, TcpStream};
use std::path::Path;
use std::time::Duration;

use super::wire::{LINE_BYTES, READ_BYTES, Request};
use super::{Image, LogSource, Probe, ProbeError};
use crate::board::FirmwareLog;
use crate::board::firmware_log::LogDecoder;
use crate::live::TcpPort;

/// For a connection on this machine.
const CONNECT: Duration = Duration::from_secs(1);
/// For an answer: the board does one thing after the other, a millisecond at a time.
const ANSWER: Duration = Duration::from_secs(4);
/// Bytes of the log taken at a time.
const PIECE_BYTES: usize = 4096;

/// A probe on an emulated board.
#[derive(Debug)]
pub struct DeskProbe {
    port: TcpPort,
}

impl DeskProbe {
    /// The one at this port.
    pub fn new(port: TcpPort) -> Self {
        Self { port }
    }

    /// Asks; the answer's bytes, and the connection.
    fn ask(&self, request: &Request) -> Result<(Vec<u8>, BufReader<TcpStream>), ProbeError> {
        let failed = |source| ProbeError::NoDesk {
            port: self.port.to_string(),
            source,
        };
        let address = (Ipv4Addr::LOCALHOST, self.port.number()).into();
        let mut stream = TcpStream::connect_timeout(&address, CONNECT).map_err(failed)?;
        stream.set_read_timeout(Some(ANSWER)).map_err(failed)?;
        stream.set_write_timeout(Some(ANSWER)).map_err(failed)?;
        stream.write_all(&request.encode()).map_err(failed)?;
        let mut reader = BufReader::new(stream);
        let mut line = String::new();
        let limited = &mut (&mut reader).take(LINE_BYTES as u64);
        limited.read_line(&mut line).map_err(failed)?;
        let line = line.trim_end();
        if let Some(why) = line.strip_prefix("refused ") {
            return Err(ProbeError::Refused(why.to_owned()));
        }
        let length = line.strip_prefix("ok ").and_then(|text| text.parse().ok());
        let Some(length) = length.filter(|length| *length <= READ_BYTES) else {
            return Err(ProbeError::NotUnderstood {
                command: self.port.to_string(),
                said: line.to_owned(),
            });
        };
        let mut bytes = vec![0; length];
        reader.read_exact(&mut bytes).map_err(failed)?;
        Ok((bytes, reader))
    }
}

impl Probe for DeskProbe {
    fn find(&mut self) -> Result<String, ProbeError> {
        let (bytes, _) = self.ask(&Request::Info)?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }

    fn flash(&mut self, elf: &Path) -> Result<(), ProbeError> {
        let bytes = std::fs::read(elf).map_err(|source| ProbeError::NotStarted {
            command: format!("flash {}", elf.display()),
            source,
        })?;
        self.ask(&Request::Flash(bytes)).map(drop)
    }

    fn reset(&mut self) -> Result<(), ProbeError> {
        self.ask(&Request::Reset).map(drop)
    }

    fn read(&mut self, address: u32, length: usize) -> Result<Vec<u8>, ProbeError> {
        self.ask(&Request::Read { address, length })
            .map(|(bytes, _)| bytes)
    }

    fn log<'f>(&mut self, image: &Image<'f>) -> Result<Box<dyn LogSource + 'f>, ProbeError> {
        let (_, reader) = self.ask(&Request::Log)?;
        let failed = |source| ProbeError::NoDesk {
            port: self.port.to_string(),
            source,
        };
        reader.get_ref().set_nonblocking(true).map_err(failed)?;
        Ok(Box::new(Stream {
            reader,
            decoder: image.firmware.log_decoder(),
        }))
    }
}

/// A log that comes over TCP.
struct Stream<'f> {
    reader: BufReader<TcpStream>,
    decoder: LogDecoder<'f>,
}

impl LogSource for Stream<'_> {
    fn poll(&mut self, into: &mut Vec<FirmwareLog>) -> Result<(), ProbeError> {
        let mut piece = [0; PIECE_BYTES];
        match self.reader.read(&mut piece) {
            Ok(0) => Err(ProbeError::LogEnded(
                "the emulated board is gone".to_owned(),
            )),
            Ok(length) => Ok(self.decoder.decode(&piece[..length], into)?),
            Err(error) if error.kind() == ErrorKind::WouldBlock => Ok(()),
            Err(error) => Err(ProbeError::LogEnded(error.to_string())),
        }
    }
}
