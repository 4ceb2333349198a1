//! The model beside the silicon, kernel by kernel.

use serde::Serialize;

use super::{CalibrationError, Timing};

/// How far the model may be from silicon on code that computes, as a share: the estimate of its error
/// that stands beside every modelled figure. Published cores differ by as much through the flash
/// interface's replacement and prefetch, and through the branch refill of 1 to 3 cycles.
pub const TOLERANCE: f64 = 0.15;

/// A kernel's cycles as somebody else measured them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Published {
    /// The kernel.
    pub kernel: &'static str,
    /// Cycles.
    pub cycles: u32,
    /// On what, by whom.
    pub source: &'static str,
}

impl Published {
    /// All that is known.
    pub const ALL: [Self; 1] = [Self {
        kernel: "microfft rfft_128",
        cycles: 8_269,
        source: "STM32F303 (Cortex-M4F), the crate's own benchmark of July 2025",
    }];

    /// What is published of a kernel.
    pub fn of(kernel: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|known| known.kernel == kernel)
    }
}

/// A kernel on both.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pair {
    /// On the emulated core.
    #[serde(flatten)]
    pub modelled: Timing,
    /// On the board: cycles of the second run; none without a board.
    pub board: Option<u32>,
    /// Modelled over the board's.
    pub ratio: Option<f64>,
    /// Published cycles.
    pub published: Option<u32>,
}

impl Pair {
    /// Modelled cycles of one item, beyond those of the kernel that does `nothing`.
    pub fn per_item(&self, nothing: u32) -> f64 {
        let items = f64::from(self.modelled.items.max(1));
        f64::from(self.modelled.then.saturating_sub(nothing)) / items
    }
}

/// All kernels.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// In the order of the image.
    pub kernels: Vec<Pair>,
    /// The ratio farthest from 1; none without a board.
    pub worst_ratio: Option<f64>,
    /// Whether every ratio is within the error that is claimed; true without a board.
    pub within: bool,
}

impl Comparison {
    /// The model alone.
    pub fn modelled(timings: Vec<Timing>) -> Self {
        Self::of(timings, |_| None)
    }

    /// The model and a board.
    pub fn with_board(timings: Vec<Timing>, board: &[Timing]) -> Result<Self, CalibrationError> {
        let find = |timing: &Timing| board.iter().find(|other| other.is_same_as(timing));
        match timings.iter().find(|timing| find(timing).is_none()) {
            Some(missing) => Err(CalibrationError::Missing(missing.to_string())),
            None => Ok(Self::of(timings, |timing| {
                find(timing).map(|other| other.then)
            })),
        }
    }

    fn of(timings: Vec<Timing>, board: impl Fn(&Timing) -> Option<u32>) -> Self {
        let pair = |modelled: Timing| {
            let board = board(&modelled);
            Pair {
                ratio: board.map(|board| f64::from(modelled.then) / f64::from(board.max(1))),
                published: Published::of(&modelled.kernel).map(|known| known.cycles),
                modelled,
                board,
            }
        };
        let kernels: Vec<Pair> = timings.into_iter().map(pair).collect();
        // As far from 1 is twice as half.
        let distance = |ratio: &f64| ratio.max(1.0 / ratio);
        let ratios = kernels.iter().filter_map(|pair| pair.ratio);
        let worst_ratio = ratios.max_by(|a, b| distance(a).total_cmp(&distance(b)));
        Self {
            within: worst_ratio.is_none_or(|ratio| distance(&ratio) <= 1.0 + TOLERANCE),
            worst_ratio,
            kernels,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timing(kernel: &str, then: u32) -> Timing {
        Timing {
            round: "accelerated".to_owned(),
            kernel: kernel.to_owned(),
            items: 1,
            first: then,
            then,
        }
    }

    #[test]
    fn the_ratio_is_the_models_cycles_over_the_boards_and_the_worst_decides() {
        let modelled = vec![timing("a", 90), timing("b", 110)];
        let board = [timing("b", 100), timing("a", 100)];
        let comparison = Comparison::with_board(modelled.clone(), &board).unwrap();
        let ratios: Vec<f64> = comparison.kernels.iter().filter_map(|p| p.ratio).collect();
        assert_eq!(ratios, [0.9, 1.1]);
        assert_eq!(comparison.worst_ratio, Some(0.9));
        assert!(comparison.within);

        let slow = [timing("b", 100), timing("a", 120)];
        let comparison = Comparison::with_board(modelled.clone(), &slow).unwrap();
        assert_eq!(comparison.worst_ratio, Some(0.75));
        assert!(!comparison.within);
        assert!(Comparison::with_board(modelled, &slow[..1]).is_err());
    }

    #[test]
    fn a_published_figure_stands_beside_its_kernel_alone() {
        let comparison = Comparison::modelled(vec![timing("microfft rfft_128", 1), timing("a", 1)]);
        let published: Vec<_> = comparison.kernels.iter().map(|p| p.published).collect();
        assert_eq!(published, [Some(8_269), None]);
        assert!(comparison.within && comparison.worst_ratio.is_none());
    }
}
