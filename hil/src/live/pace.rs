//! Keeps step with the clock on the wall, and says how well that went.

use std::thread;
use std::time::{Duration, Instant};

use crate::summary::PaceFigures;

/// A step begun later than this is late: half of the 10 ms in which a Crazyflie's app listens after
/// each STATE.
pub const LATE: Duration = Duration::from_millis(5);
/// Further behind the clock than this is worth a word while it happens.
const BEHIND: Duration = Duration::from_secs(1);
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
    /// How far behind it was when that was told last.
    told: Duration,
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
            told: Duration::ZERO,
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

    /// The flight stood still for so long because somebody asked for it: that is no lateness.
    pub fn stood_still(&mut self, time: Duration) {
        self.started += time;
    }

    /// How far behind the clock the flight is, where that is news: a second, and then twice as far as
    /// when it was told last.
    pub fn falls_behind(&mut self) -> Option<Duration> {
        let is_news = self.largest >= BEHIND.max(2 * self.told);
        is_news.then(|| {
            self.told = self.largest;
            self.told
        })
    }

    /// Since the start, but for the time that the flight stood still.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_that_stood_still_is_no_lateness() {
        let mut pacer = Pacer::new(1.0);
        let minute = Duration::from_secs(60);
        pacer.started -= minute;
        pacer.stood_still(minute);
        pacer.wait();
        assert!(pacer.largest < minute / 2 && pacer.elapsed() < minute / 2);
    }

    #[test]
    fn falling_behind_is_told_at_a_second_and_whenever_it_has_doubled() {
        let mut pacer = Pacer::new(1.0);
        let mut told = Vec::new();
        for late_ms in (0..10_000).step_by(100) {
            pacer.largest = Duration::from_millis(late_ms);
            told.extend(pacer.falls_behind().map(|late| late.as_millis()));
        }
        assert_eq!(told, [1_000, 2_000, 4_000, 8_000]);
    }
}
