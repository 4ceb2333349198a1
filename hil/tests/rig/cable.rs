//! A cable between the board and this machine that can do what cables do.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::mpsc::channel;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use hil::live::{Endpoint, Port, Stop};
use hil::rig::file::Line;

const LOOK_EVERY: Duration = Duration::from_micros(500);

/// What becomes of a byte that passes, either way, `since` the first one did; none where it is lost.
pub type Mischief = fn(since: Duration, random: &mut Random, byte: u8) -> Option<u8>;

/// A generator (xorshift, Marsaglia 2003) that a test can repeat.
pub struct Random(u64);

impl Random {
    /// 0..1.
    pub fn share(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A cable that lies between a device and another one.
pub struct Cable {
    /// The end that this machine has.
    pub line: Line,
    stop: Stop,
    runs: Option<JoinHandle<()>>,
}

impl Cable {
    /// A cable to a device; after `pulled` it is no more.
    pub fn to(far: &Line, pulled: Option<Duration>, mischief: Mischief) -> Self {
        let (sender, receiver) = channel();
        let stop = Stop::default();
        let (asked, far_line) = (stop.clone(), far.clone());
        let runs = thread::spawn(move || {
            let mut near = Port::open(&Endpoint::Pty, 0).expect("a pseudo-terminal");
            sender
                .send(PathBuf::from(near.place()))
                .expect("waited for");
            let mut far = Port::open(&Endpoint::Tty(far_line.device), far_line.baud).expect("far");
            let (mut there, mut back) = (Way::default(), Way::default());
            let mut random = Random(0x9e37_79b9_7f4a_7c15);
            let mut since: Option<Instant> = None;
            let is_pulled = |since: Option<Instant>| match (since, pulled) {
                (Some(since), Some(pulled)) => since.elapsed() >= pulled,
                _ => false,
            };
            while !asked.requested() && !is_pulled(since) {
                let moved = there.carry(&mut near, &mut far, since, &mut random, mischief)
                    | back.carry(&mut far, &mut near, since, &mut random, mischief);
                if moved {
                    since.get_or_insert_with(Instant::now);
                }
                thread::sleep(LOOK_EVERY);
            }
        });
        Self {
            line: Line {
                device: receiver.recv().expect("a device"),
                baud: far.baud,
            },
            stop,
            runs: Some(runs),
        }
    }
}

impl Drop for Cable {
    fn drop(&mut self) {
        self.stop.request();
        if let Some(runs) = self.runs.take() {
            let _ = runs.join();
        }
    }
}

/// Bytes that could not be handed over yet.
#[derive(Default)]
struct Way(VecDeque<u8>);

impl Way {
    fn carry(
        &mut self,
        from: &mut Port,
        to: &mut Port,
        since: Option<Instant>,
        random: &mut Random,
        mischief: Mischief,
    ) -> bool {
        let mut bytes = Vec::new();
        // Not more than the far end takes: who sends has to wait.
        if self.0.len() < 4096 {
            from.poll(&mut bytes);
        }
        let moved = !bytes.is_empty();
        let since = since.map_or(Duration::ZERO, |since| since.elapsed());
        let arriving = bytes.into_iter();
        self.0
            .extend(arriving.filter_map(|byte| mischief(since, random, byte)));
        if let Ok(sent) = to.send_some(self.0.make_contiguous()) {
            self.0.drain(..sent);
        }
        moved
    }
}
