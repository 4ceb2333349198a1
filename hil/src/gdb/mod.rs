//! A GDB server for the emulated board (GDB's remote serial protocol, by the crate `gdbstub`).
//!
//! ```text
//! gdb-multiarch <- TCP -> server -> debug unit of the machine
//! ```
//!
//! The board lives in steps of a millisecond; the server runs the machine through each of them. While
//! GDB has it halted, in whatever instruction, the step is not over and virtual time stands still.

mod registers;
mod target;
mod wire;

use std::io::{self, ErrorKind};
use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::thread;
use std::time::{Duration, Instant};

use emulator::time::Nanos;
use gdbstub::common::Signal;
use gdbstub::stub::state_machine::GdbStubStateMachine;
use gdbstub::stub::{GdbStub, GdbStubError, SingleThreadStopReason};

use crate::board::BoardError;
use crate::board::emulated::Emulated;
use wire::Wire;

/// Between two looks at the connection while the board is halted.
const LOOK: Duration = Duration::from_micros(500);

type Stub<'f> = GdbStubStateMachine<'static, Emulated<'f>, Wire>;
type StopReason = SingleThreadStopReason<u32>;
type Gone = GdbStubError<core::convert::Infallible, io::Error>;

/// The server's port cannot be had.
#[derive(Debug, thiserror::Error)]
#[error("no GDB server on 127.0.0.1:{port}: {error}")]
pub struct PortError {
    port: u16,
    #[source]
    error: io::Error,
}

/// Serves one GDB at a time; further ones wait.
pub struct Server<'f> {
    listener: TcpListener,
    place: SocketAddr,
    /// None while no GDB is there.
    stub: Option<Stub<'f>>,
    /// How long the board was halted, by the clock on the wall.
    halted: Duration,
    news: Vec<String>,
}

impl<'f> Server<'f> {
    /// Listens on a port of this machine; 0 takes any that is free.
    ///
    /// # Errors
    /// [`PortError`], where another program has the port or it is not ours to use.
    pub fn open(port: u16) -> Result<Self, PortError> {
        let listen = || {
            let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
            listener.set_nonblocking(true)?;
            Ok((listener.local_addr()?, listener))
        };
        let (place, listener) = listen().map_err(|error| PortError { port, error })?;
        Ok(Self {
            listener,
            place,
            stub: None,
            halted: Duration::ZERO,
            news: Vec::new(),
        })
    }

    /// Where it listens.
    pub fn place(&self) -> SocketAddr {
        self.place
    }

    /// What people should know of the time since the last call.
    pub fn take_news(&mut self) -> Vec<String> {
        std::mem::take(&mut self.news)
    }

    /// How long the board was halted since the last call: time that nobody may call lateness.
    pub fn take_halted(&mut self) -> Duration {
        std::mem::take(&mut self.halted)
    }

    /// Runs the board until virtual time reaches `until`, as GDB lets it. Whenever it stands still
    /// `attend` takes the news and may look after other things; false from it sends GDB away, and the
    /// board goes on.
    ///
    /// # Errors
    /// A fault of the chip that no GDB is there to look at.
    pub fn run(
        &mut self,
        board: &mut Emulated<'f>,
        until: Nanos,
        attend: &mut dyn FnMut(Vec<String>) -> bool,
    ) -> Result<(), BoardError> {
        self.welcome(board);
        loop {
            let since = Instant::now();
            self.listen(board);
            match self.stub.take() {
                None => return Ok(board.machine().run_until(until)?),
                Some(GdbStubStateMachine::Running(stub)) => match self.go(board, until) {
                    None => {
                        self.stub = Some(stub.into());
                        return Ok(());
                    }
                    Some(reason) => {
                        let stub = stub.report_stop(board, reason);
                        self.keep(board, stub);
                    }
                },
                Some(stub) => {
                    self.stub = Some(stub);
                    if !attend(self.take_news()) {
                        self.part(board, "sent away");
                    }
                    thread::sleep(LOOK);
                    self.halted += since.elapsed();
                }
            }
        }
    }

    /// Runs the machine until it pauses, and tells why; `None` where it has reached the instant.
    fn go(&mut self, board: &mut Emulated<'f>, until: Nanos) -> Option<StopReason> {
        match board.machine().run_debugged(until) {
            Ok(pause) => target::stop_reason(pause),
            Err(fault) => {
                self.news.push(format!("halted: {fault}"));
                Some(target::fault_reason(&fault))
            }
        }
    }

    /// Lets a GDB in that has come; that halts the board.
    fn welcome(&mut self, board: &mut Emulated<'f>) {
        if self.stub.is_some() {
            return;
        }
        let Ok((stream, from)) = self.listener.accept() else {
            return;
        };
        // Who has gone by now has gone.
        let Ok(wire) = Wire::new(stream) else {
            return;
        };
        self.news
            .push(format!("{from} attached; the board is halted"));
        let stub = GdbStub::new(wire).run_state_machine(board);
        self.keep(board, stub);
    }

    /// Hears what GDB says.
    fn listen(&mut self, board: &mut Emulated<'f>) {
        let Some(mut stub) = self.stub.take() else {
            return;
        };
        let heard = match &mut stub {
            GdbStubStateMachine::Idle(stub) => stub.borrow_conn().receive(),
            GdbStubStateMachine::Running(stub) => stub.borrow_conn().receive(),
            GdbStubStateMachine::CtrlCInterrupt(stub) => stub.borrow_conn().receive(),
            GdbStubStateMachine::Disconnected(_) => Err(ErrorKind::NotConnected.into()),
        };
        match heard {
            Ok(bytes) => {
                let fed = bytes
                    .into_iter()
                    .try_fold(stub, |stub, byte| feed(stub, board, byte));
                self.keep(board, fed);
            }
            Err(error) => self.part(board, &error.to_string()),
        }
    }

    /// Goes on with a GDB that is still there.
    fn keep(&mut self, board: &mut Emulated<'f>, stub: Result<Stub<'f>, Gone>) {
        match stub {
            Ok(GdbStubStateMachine::Disconnected(stub)) => {
                let why = format!("{:?}", stub.get_reason()).to_lowercase();
                self.part(board, &why);
            }
            Ok(stub) => self.stub = Some(stub),
            Err(error) => self.part(board, &error.to_string()),
        }
    }

    /// Without GDB the board runs freely.
    fn part(&mut self, board: &mut Emulated<'f>, why: &str) {
        self.stub = None;
        *board.machine().debug_unit() = Default::default();
        self.news.push(format!("detached ({why}); the board runs"));
    }
}

/// Hands a byte of GDB's on. Ctrl-C halts the board where it is.
fn feed<'f>(stub: Stub<'f>, board: &mut Emulated<'f>, byte: u8) -> Result<Stub<'f>, Gone> {
    let stub = match stub {
        GdbStubStateMachine::Idle(stub) => stub.incoming_data(board, byte)?,
        GdbStubStateMachine::Running(stub) => stub.incoming_data(board, byte)?,
        other => other,
    };
    match stub {
        GdbStubStateMachine::CtrlCInterrupt(stub) => {
            let reason = SingleThreadStopReason::Signal(Signal::SIGINT);
            stub.interrupt_handled(board, Some(reason))
        }
        other => Ok(other),
    }
}
