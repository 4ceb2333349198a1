//! Flights against the clock on the wall: who meets whom, what the camera sees, and what is left when
//! somebody pulls a plug. No test here looks at a clock to pass; all only give up waiting some day.

#[path = "live/endpoints.rs"]
mod endpoints;
#[path = "live/meeting.rs"]
mod meeting;
#[path = "live/poses.rs"]
mod poses;
#[cfg(unix)]
#[path = "live/program.rs"]
mod program;
#[cfg(unix)]
#[path = "live/programs.rs"]
mod programs;
#[cfg(unix)]
#[path = "live/serial.rs"]
mod serial;

use std::fmt::Display;
use std::sync::atomic::{AtomicU16, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use hil::live::{News, Port, TcpPort};

/// After this long a test gives up.
const PATIENCE: Duration = Duration::from_secs(120);

/// Two free ports, one after the other; below those that the system gives to callers.
fn free_port() -> TcpPort {
    static NEXT: AtomicU16 = AtomicU16::new(0);
    loop {
        let step = NEXT.fetch_add(2, Ordering::Relaxed);
        let port = 20_000
            + (std::process::id() as u16)
                .wrapping_mul(64)
                .wrapping_add(step)
                % 10_000;
        let free = |port| std::net::TcpListener::bind(("127.0.0.1", port)).is_ok();
        if free(port) && free(port + 1) {
            return format!("tcp:{port}").parse().expect("a port");
        }
    }
}

/// Waits for something to be true.
fn wait_until(what: impl Display, mut is_so: impl FnMut() -> bool) {
    let since = Instant::now();
    while !is_so() {
        assert!(since.elapsed() < PATIENCE, "waited in vain: {what}");
        thread::sleep(Duration::from_millis(2));
    }
}

/// A port with all that ever happened there.
struct Watched {
    port: Port,
    news: Vec<News>,
    received: Vec<u8>,
}

impl Watched {
    fn tcp(port: TcpPort) -> Self {
        Self::new(Port::open_tcp(port).expect("a port"))
    }

    fn new(port: Port) -> Self {
        Self {
            port,
            news: Vec::new(),
            received: Vec::new(),
        }
    }

    fn poll(&mut self) -> &mut Self {
        self.news.extend(self.port.poll(&mut self.received));
        self
    }
}

/// Polls two ports until both have a peer.
fn meet(a: &mut Watched, b: &mut Watched) {
    wait_until("two meet", || {
        a.poll().port.has_peer() & b.poll().port.has_peer()
    });
}

/// Sends `bytes` from one to the other.
fn pass(from: &mut Watched, to: &mut Watched, bytes: &[u8]) {
    let before = to.received.len();
    from.port.send(bytes).expect("a peer");
    wait_until("bytes arrive", || {
        from.poll();
        to.poll().received.len() >= before + bytes.len()
    });
    assert_eq!(&to.received[before..], bytes);
}
