//! Keeps step with the clock on the wall, and says how well that went.

use std::thread;
use std::time::{Duration, Instant};

use crate::summary::PaceFigures;

/// A step begun later than this is late: half of the 10 ms in which a Crazyflie's app listens after
/// each STATE.
pub const LATE: Duration = Duration::from_millis(5);
/// One step.
const STEP_S: f64 = 0.001;

/// Steps of a millisecond against the clock. Who is late goes on without a pause until he is not.
#[derive(Debug)]
pub struct Pacer {
    started: Instant,
    speed: f64,
    steps: u64,
    late: u64,
    largest: Duration,
}

impl Pacer {
    /// Starts now; `speed` is virtual over real time, positive.
    pub fn new(speed: f64) -> Self {
        Self {
            started: Instant::now(),
            speed,
            steps: 0,
            late: 0,
            largest: Duration::ZERO,
        }
    }

    /// Waits until the next step is due.
    pub fn wait(&mut self) {
        let after_s = self.steps as f64 * STEP_S / self.speed;
        let due = self.started + Duration::from_secs_f64(after_s);
        self.steps += 1;
        let early = due.saturating_duration_since(Instant::now());
        if !early.is_zero() {
            thread::sleep(early);
        }
        let late = due.elapsed();
        self.largest = self.largest.max(late);
        self.late += u64::from(late > LATE);
    }

    /// Since the start.
    pub fn elapsed(&self) -> Duration {
        self.started.elapsed()
    }

    /// How well it went.
    pub fn figures(&self) -> PaceFigures {
        PaceFigures {
            speed: self.speed,
            largest_lateness_ms: self.largest.as_secs_f64() * 1_000.0,
            late_share: self.late as f64 / self.steps.max(1) as f64,
        }
    }
}
