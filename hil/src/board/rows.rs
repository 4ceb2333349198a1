//! Where a flight's two threads meet: rows of a frame are rendered by whoever comes first, the flight when it needs
//! them, or a helper ahead of that.
//!
//! A row's light is known some milliseconds of flight before its bytes go over the bus, for a row is seen from amid its
//! exposure. So the flight orders rows as soon as they are known, and goes on with processor and vehicle; the helper
//! carries the orders out meanwhile. When the flight needs a row that is not there yet, it does not wait for the
//! helper to wake up, but works off the orders itself.
//!
//! What a row's bytes are does not depend on who renders it when: orders are carried out one after the other in the
//! order in which they were given, under one lock, and what they do depends on nothing but themselves and the orders
//! before them. And the flight takes a row's bytes at the very moment at which it would have rendered them alone. So
//! the processor sees the same bytes at the same cycle, with a helper or without.

use std::collections::VecDeque;
use std::fmt;
use std::hint;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread::{self, JoinHandle};

use fake_sensors::camera::{
    Exposure, FRAME_BYTES, Frame, HEIGHT, ImageTuning, LINE_BYTES, Line, Moment, PanoramicCamera,
};

/// Orders for which the helper is woken: to wake a thread costs the flight as much as it takes to render half a row.
/// In the usual light of a room, 135 lines of shutter, thirteen rows are known ahead.
const WORTH_WAKING: usize = 8;

/// Looks at a row that the helper is about to finish, before the flight sleeps until it is: some tens of
/// microseconds, longer than a row takes. A helper that takes longer has no processor: the machine is busy.
const LOOKS: u32 = 1_000;

/// Orders for which the flight then does without a helper: those of some ten frames. Each time that it waits for one
/// in vain costs it a slice of the scheduler's, milliseconds.
const ALONE: u64 = 1_000;

/// What is done to the optics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Order {
    /// A frame begins.
    Begin {
        /// Its number.
        number: u32,
        /// The sensor's tuning, for all of it.
        tuning: ImageTuning,
    },
    /// Light falls on a row, and the row above is read out, for now its neighbours have their light; the last row is
    /// read out at once.
    Light {
        /// The row.
        row: usize,
        /// What it is seen from.
        moment: Moment,
        /// The frame's exposure.
        exposure: Exposure,
    },
}

/// How many orders had been given when this one was.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Ticket(u64);

/// Rows to be rendered, and those that are.
pub struct Rows {
    shared: Arc<Shared>,
    given: u64,
    /// The helper is not woken before so many orders are given.
    alone_until: u64,
    helper: Option<JoinHandle<()>>,
}

/// Locked in this order, where both are.
struct Shared {
    /// Held while an order is carried out.
    optics: Mutex<PanoramicCamera>,
    /// Held for a moment.
    desk: Mutex<Desk>,
    /// Orders carried out; what they have written is on the desk.
    done: AtomicU64,
    /// The flight is over.
    closed: AtomicBool,
}

struct Desk {
    orders: VecDeque<Order>,
    /// Rows as they were read out last.
    frame: Box<Frame>,
}

impl Rows {
    /// Rows through `optics`, rendered by the flight's own thread.
    pub fn new(optics: PanoramicCamera) -> Self {
        let desk = Desk {
            orders: VecDeque::with_capacity(2 * HEIGHT),
            frame: Box::new([0; FRAME_BYTES]),
        };
        Self {
            shared: Arc::new(Shared {
                optics: Mutex::new(optics),
                desk: Mutex::new(desk),
                done: AtomicU64::new(0),
                closed: AtomicBool::new(false),
            }),
            given: 0,
            alone_until: 0,
            helper: None,
        }
    }

    /// The same with a helper. On a machine that gives no second thread, the flight's own does everything.
    #[must_use]
    pub fn with_helper(mut self) -> Self {
        let shared = Arc::clone(&self.shared);
        let helper = thread::Builder::new().name("rows".to_owned());
        self.helper = helper.spawn(move || shared.help()).ok();
        self
    }

    /// Gives an order.
    pub fn order(&mut self, order: Order) -> Ticket {
        self.given += 1;
        let mut desk = self.shared.desk();
        desk.orders.push_back(order);
        let worth = desk.orders.len() >= WORTH_WAKING && self.given > self.alone_until;
        drop(desk);
        if worth && let Some(helper) = &self.helper {
            helper.thread().unpark();
        }
        Ticket(self.given)
    }

    /// Row `row` (below [`HEIGHT`]) as it is once the order of this ticket has been carried out.
    pub fn read(&mut self, row: usize, ticket: Ticket) -> Line {
        let stalled = self.shared.finish(ticket);
        if stalled {
            self.alone_until = self.given + ALONE;
        }
        let desk = self.shared.desk();
        let (lines, _) = desk.frame.as_chunks::<LINE_BYTES>();
        lines[row]
    }
}

impl Drop for Rows {
    fn drop(&mut self) {
        if let Some(helper) = self.helper.take() {
            self.shared.closed.store(true, Ordering::Release);
            helper.thread().unpark();
            // What made it panic was told when the flight met the optics that it left.
            let _ = helper.join();
        }
    }
}

impl fmt::Debug for Rows {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Rows")
            .field("given", &self.given)
            .field("helper", &self.helper.is_some())
            .finish_non_exhaustive()
    }
}

impl Shared {
    /// The helper's life: it carries out what orders there are, and sleeps until it is woken for more.
    fn help(&self) {
        while !self.closed.load(Ordering::Acquire) {
            let Ok(mut optics) = self.optics.lock() else {
                return;
            };
            let worked = self.carry_out_next(&mut optics);
            drop(optics);
            if !worked {
                thread::park();
            }
        }
    }

    /// Comes back when the order of this ticket has been carried out, by the helper or by the caller. True: the
    /// helper had begun with one, and was stopped.
    fn finish(&self, Ticket(wanted): Ticket) -> bool {
        let mut looks = 0;
        while self.done.load(Ordering::Acquire) < wanted {
            let optics = match self.optics.try_lock() {
                Err(TryLockError::WouldBlock) if looks < LOOKS => {
                    looks += 1;
                    hint::spin_loop();
                    continue;
                }
                Err(TryLockError::WouldBlock) => self.optics.lock().ok(),
                optics => optics.ok(),
            };
            let mut optics = optics.expect("the thread that renders has not panicked");
            self.carry_out_next(&mut optics);
        }
        looks == LOOKS
    }

    /// False: there is no order.
    fn carry_out_next(&self, optics: &mut PanoramicCamera) -> bool {
        let Some(order) = self.desk().orders.pop_front() else {
            return false;
        };
        match order {
            Order::Begin { number, tuning } => {
                optics.set_tuning(tuning);
                optics.begin_frame(number);
            }
            Order::Light {
                row,
                moment,
                exposure,
            } => {
                optics.light_row(row, &moment);
                if let Some(above) = row.checked_sub(1) {
                    self.read_out(optics, above, exposure);
                }
                if row == HEIGHT - 1 {
                    self.read_out(optics, row, exposure);
                }
            }
        }
        // Only who holds the optics counts.
        self.done.fetch_add(1, Ordering::Release);
        true
    }

    fn read_out(&self, optics: &mut PanoramicCamera, row: usize, exposure: Exposure) {
        let line = optics.read_row(row, exposure);
        let mut desk = self.desk();
        let (lines, _) = desk.frame.as_chunks_mut::<LINE_BYTES>();
        lines[row] = *line;
    }

    /// Nothing that is done at the desk leaves it half done.
    fn desk(&self) -> MutexGuard<'_, Desk> {
        self.desk.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
