//! A pseudo-terminal of our own. Whoever opens its device is the peer, and goes by closing it.

use std::ffi::OsString;
use std::fs::{File, OpenOptions};
use std::io;
use std::os::unix::ffi::OsStringExt;
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::OFlags;
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, QueueSelector, tcflush, tcgetattr, tcsetattr};

use super::{Meeting, News, Peer};

/// Our end.
#[derive(Debug)]
pub struct Pty {
    controller: File,
    device: PathBuf,
}

impl Pty {
    /// A new pseudo-terminal whose device is raw: what goes in comes out.
    ///
    /// # Errors
    /// The system's.
    pub fn open() -> io::Result<Self> {
        let controller = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY)?;
        grantpt(&controller)?;
        unlockpt(&controller)?;
        rustix::fs::fcntl_setfl(&controller, OFlags::NONBLOCK)?;
        let device = ptsname(&controller, Vec::new())?;
        let pty = Self {
            controller: File::from(controller),
            device: OsString::from_vec(device.into_bytes()).into(),
        };
        pty.make_ready()?;
        Ok(pty)
    }

    /// The device that a peer opens.
    pub fn device(&self) -> &Path {
        &self.device
    }

    /// Raw, and empty of what the last peer did not read. That the device has been open and is
    /// closed again is what makes the system tell us that nobody has it open.
    fn make_ready(&self) -> io::Result<()> {
        let device = OpenOptions::new()
            .read(true)
            .write(true)
            .custom_flags(OFlags::NOCTTY.bits().cast_signed())
            .open(&self.device)?;
        let mut mode = tcgetattr(&device)?;
        mode.make_raw();
        tcsetattr(&device, OptionalActions::Now, &mode)?;
        tcflush(&device, QueueSelector::IOFlush)?;
        Ok(())
    }

    /// Whether somebody has the device open.
    fn is_open(&self) -> io::Result<bool> {
        let mut fds = [PollFd::new(&self.controller, PollFlags::empty())];
        poll(&mut fds, Some(&Timespec::default()))?;
        Ok(!fds[0].revents().contains(PollFlags::HUP))
    }
}

impl Meeting for Pty {
    fn seek(&mut self, _: &mut Vec<News>) -> Option<Peer> {
        if !self.is_open().ok()? {
            return None;
        }
        Some(Peer {
            stream: Box::new(self.controller.try_clone().ok()?),
            name: format!("whoever opened {}", self.device.display()),
        })
    }

    fn turn_away(&mut self) -> Option<News> {
        None
    }

    fn lost(&mut self) {
        // What fails here only leaves old bytes to the next peer.
        let _ = self.make_ready();
    }
}
