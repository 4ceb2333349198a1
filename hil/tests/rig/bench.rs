//! What the tests of the rig share: folders, the command, and an emulated board on the desk.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU16, Ordering};
use std::sync::mpsc::channel;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use hil::image::Variant;
use hil::live::{Common, Endpoint, Stop, TcpPort};
use hil::rig::desk::{Desk, DeskSetup};
use hil::rig::file::{BoardName, Rig};

/// What every rig that is not whole has to be known in.
pub const AT_ONCE: Duration = Duration::from_secs(5);

/// A folder for one test, gone after it.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("hil-rig-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).expect("a folder");
        Self(path)
    }

    /// A file in it.
    pub fn file(&self, name: &str, text: &str) -> PathBuf {
        let path = self.0.join(name);
        std::fs::write(&path, text).expect("a file");
        path
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.0.join(name)).unwrap_or_default()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// The command, with nothing on its PATH but this folder and the system's own tools.
pub fn hil(arguments: &[&str], path: &Path) -> Output {
    let path = format!("{}:/usr/bin:/bin", path.display());
    Command::new(env!("CARGO_BIN_EXE_hil"))
        .args(arguments)
        .env("PATH", path)
        .output()
        .expect("the command starts")
}

pub fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

pub fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Does it, and holds it to [`AT_ONCE`].
pub fn at_once<T>(work: impl FnOnce() -> T) -> T {
    let started = Instant::now();
    let done = work();
    assert!(started.elapsed() < AT_ONCE, "took {:?}", started.elapsed());
    done
}

/// The flight image.
pub fn flight_image() -> &'static Path {
    static ELF: OnceLock<PathBuf> = OnceLock::new();
    ELF.get_or_init(|| hil::image::build(&|line| eprintln!("{line}")).expect("the firmware builds"))
}

/// The rig image of the same board.
pub fn rig_image() -> &'static Path {
    static ELF: OnceLock<PathBuf> = OnceLock::new();
    ELF.get_or_init(|| {
        let say = |line: &str| eprintln!("{line}");
        hil::image::build_variant(&Variant::RIG, &say).expect("the firmware builds")
    })
}

/// A free port; below those that the system gives to callers.
pub fn free_port() -> TcpPort {
    static NEXT: AtomicU16 = AtomicU16::new(0);
    loop {
        let step = NEXT.fetch_add(1, Ordering::Relaxed);
        let own = (std::process::id() as u16).wrapping_mul(64);
        let port = 10_000 + own.wrapping_add(step) % 10_000;
        if std::net::TcpListener::bind(("127.0.0.1", port)).is_ok() {
            return port.to_string().parse().expect("a port");
        }
    }
}

/// An emulated board, switched off after the test.
pub struct OnDesk {
    pub rig: Rig,
    stop: Stop,
    runs: Option<JoinHandle<()>>,
}

impl OnDesk {
    /// A board with this image, `speed` times faster than the clock.
    pub fn with(elf: &Path, speed: f64) -> Self {
        let elf = std::fs::read(elf).expect("an image");
        let (sender, receiver) = channel();
        let stop = Stop::default();
        let asked = stop.clone();
        let runs = thread::spawn(move || {
            let setup = DeskSetup {
                common: Common {
                    link: Endpoint::Pty,
                    baud: 921_600,
                    speed,
                    limit_ms: None,
                    stop: &asked,
                },
                elf: &elf,
                frames: Endpoint::Pty,
                frames_baud: 3_000_000,
                probe: free_port(),
            };
            let hear = |notice| eprintln!("desk: {notice:?}");
            let desk = Desk::open(setup, &hear).expect("a desk");
            sender
                .send(desk.rig("emulated", BoardName::Flight))
                .expect("somebody waits");
            desk.run();
        });
        Self {
            rig: receiver.recv().expect("a rig"),
            stop,
            runs: Some(runs),
        }
    }
}

impl Drop for OnDesk {
    fn drop(&mut self) {
        self.stop.request();
        if let Some(runs) = self.runs.take() {
            let _ = runs.join();
        }
    }
}
