//! The port at which a probe asks; never waits.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};

use crate::live::{OpenError, TcpPort};
use crate::rig::probe::wire::{Request, refused};

/// Bytes taken at a time.
const PIECE_BYTES: usize = 64 << 10;

/// Everybody who asks.
pub struct ProbePort {
    listener: TcpListener,
    clients: Vec<Client>,
    next: usize,
}

/// One who asks.
struct Client {
    id: usize,
    stream: TcpStream,
    asked: Vec<u8>,
    unsent: Vec<u8>,
    listens: bool,
}

impl ProbePort {
    /// Listens on a port of this machine.
    pub fn open(port: TcpPort) -> Result<Self, OpenError> {
        let opened = TcpListener::bind((Ipv4Addr::LOCALHOST, port.number()));
        let opened = opened.and_then(|listener| {
            listener.set_nonblocking(true)?;
            Ok(listener)
        });
        Ok(Self {
            listener: opened.map_err(|error| OpenError::new(&port, error))?,
            clients: Vec::new(),
            next: 0,
        })
    }

    /// What is asked now, and by whom.
    pub fn poll(&mut self) -> Vec<(usize, Request)> {
        while let Ok((stream, _)) = self.listener.accept() {
            if stream.set_nonblocking(true).is_ok() {
                self.clients.push(Client {
                    id: self.next,
                    stream,
                    asked: Vec::new(),
                    unsent: Vec::new(),
                    listens: false,
                });
                self.next += 1;
            }
        }
        let mut requests = Vec::new();
        self.clients.retain_mut(|client| {
            let alive = client.hear().is_ok() && client.push().is_ok();
            match Request::take(&mut client.asked) {
                Ok(request) => requests.extend(request.map(|request| (client.id, request))),
                Err(error) => client.say(&refused(&error.to_string())),
            }
            alive
        });
        requests
    }

    /// Answers; who asked for the log hears it from now on.
    pub fn answer(&mut self, id: usize, request: &Request, answer: &[u8]) {
        if let Some(client) = self.clients.iter_mut().find(|client| client.id == id) {
            client.say(answer);
            client.listens |= *request == Request::Log;
        }
    }

    /// Passes the log on to whoever listens.
    pub fn log(&mut self, bytes: &[u8]) {
        let listeners = self.clients.iter_mut().filter(|client| client.listens);
        listeners.for_each(|client| client.say(bytes));
    }
}

impl Client {
    fn hear(&mut self) -> io::Result<()> {
        let mut piece = vec![0; PIECE_BYTES];
        match self.stream.read(&mut piece) {
            Ok(0) => Err(ErrorKind::UnexpectedEof.into()),
            Ok(length) => {
                self.asked.extend_from_slice(&piece[..length]);
                Ok(())
            }
            Err(error) if error.kind() == ErrorKind::WouldBlock => Ok(()),
            Err(error) => Err(error),
        }
    }

    fn say(&mut self, bytes: &[u8]) {
        self.unsent.extend_from_slice(bytes);
        // Who has gone is noticed when he is heard.
        let _ = self.push();
    }

    fn push(&mut self) -> io::Result<()> {
        while !self.unsent.is_empty() {
            match self.stream.write(&self.unsent) {
                Ok(written) => drop(self.unsent.drain(..written)),
                Err(error) if error.kind() == ErrorKind::WouldBlock => break,
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }
}
