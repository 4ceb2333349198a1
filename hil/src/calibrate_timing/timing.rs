//! What a kernel took, as the image tells it in its log.

use std::fmt;

use serde::Serialize;

/// One kernel in one round.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Timing {
    /// How the flash was read: `accelerated` as in flight, `cached` without prefetch, `bare`.
    pub round: String,
    /// The kernel.
    pub kernel: String,
    /// What it does so many times.
    pub items: u32,
    /// Cycles of the first run.
    pub first: u32,
    /// Cycles of the second, with warm caches.
    pub then: u32,
}

impl Timing {
    /// Reads `kernel ROUND NAME items N first N then N`, with whatever a log viewer puts before and
    /// behind it.
    pub fn from_log(line: &str) -> Option<Self> {
        let (_, line) = line.split_once("kernel ")?;
        let (round, line) = line.split_once(' ')?;
        let (kernel, line) = line.split_once(" items ")?;
        let mut words = line.split_whitespace();
        let [items, _, first, _, then] = std::array::from_fn(|_| words.next());
        Some(Self {
            round: round.to_owned(),
            kernel: kernel.to_owned(),
            items: items?.parse().ok()?,
            first: first?.parse().ok()?,
            then: then?.parse().ok()?,
        })
    }

    /// Whether the other is the same kernel in the same round.
    pub fn is_same_as(&self, other: &Self) -> bool {
        (&self.round, &self.kernel, self.items) == (&other.round, &other.kernel, other.items)
    }
}

impl fmt::Display for Timing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.kernel, self.round)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_read_bare_and_as_a_log_viewer_prints_it() {
        let timing = Timing {
            round: "cached".to_owned(),
            kernel: "ldr and its use".to_owned(),
            items: 128,
            first: 400,
            then: 390,
        };
        let bare = "kernel cached ldr and its use items 128 first 400 then 390";
        for line in [bare, &format!("[INFO ] {bare} (kernels src/main.rs:90)")] {
            assert_eq!(Timing::from_log(line), Some(timing.clone()));
        }
        assert_eq!(Timing::from_log("kernels done"), None);
        let cut = "kernel cached ldr and its use items 128 first 400 then";
        assert_eq!(Timing::from_log(cut), None);
    }
}
