//! The roll call: every task says that it lives, and the watchdog is fed when all have.

use core::sync::atomic::{AtomicU32, Ordering};

use embassy_time::Duration;

/// The longest a task may wait for anything before it checks in.
pub const PERIOD: Duration = Duration::from_millis(200);

/// The tasks that must check in.
#[derive(Clone, Copy)]
pub enum Member {
    /// The camera task.
    Camera,
    /// The exposure task.
    Exposure,
    /// The vision task.
    Vision,
    /// The link's receiver.
    LinkRx,
    /// The link's transmitter.
    LinkTx,
}

/// A bit for every [`Member`].
const ALL: u32 = (1 << (Member::LinkTx as u32 + 1)) - 1;

static PRESENT: AtomicU32 = AtomicU32::new(0);

/// Says that the task lives.
pub fn check_in(member: Member) {
    PRESENT.fetch_or(1 << member as u32, Ordering::Relaxed);
}

/// Whether all have checked in since this last was true. A new round begins then.
pub fn all_present() -> bool {
    PRESENT
        .compare_exchange(ALL, 0, Ordering::Relaxed, Ordering::Relaxed)
        .is_ok()
}
