//! Ranges and round numbers for axes.

/// A closed interval, `low < high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Range {
    /// The interval of all finite values, none if there are none. A single value is widened.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values.into_iter().filter(|value| value.is_finite()) {
            low = low.min(value);
            high = high.max(value);
        }
        (low <= high).then(|| Self { low, high }.widened())
    }

    /// The interval with `value` inside.
    pub fn with(self, value: f64) -> Self {
        Self {
            low: self.low.min(value),
            high: self.high.max(value),
        }
    }

    /// The interval stretched outwards to whole steps.
    pub fn rounded(self, step: f64) -> Self {
        Self {
            low: libm::floor(self.low / step) * step,
            high: libm::ceil(self.high / step) * step,
        }
    }

    /// Its length.
    pub fn span(self) -> f64 {
        self.high - self.low
    }

    /// Whether a value lies inside.
    pub fn contains(self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }

    fn widened(self) -> Self {
        let least = 1e-9 * self.low.abs().max(self.high.abs()).max(1.0);
        if self.span() > least {
            return self;
        }
        Self {
            low: self.low - 0.5,
            high: self.high + 0.5,
        }
    }
}

/// The smallest of 1, 2 and 5 times a power of ten that cuts `span` into at most `most` steps.
pub fn nice_step(span: f64, most: usize) -> f64 {
    let least = span / most.max(1) as f64;
    let decade = libm::pow(10.0, libm::floor(libm::log10(least)));
    [1.0, 2.0, 5.0]
        .into_iter()
        .map(|factor| factor * decade)
        .find(|step| *step >= least * (1.0 - 1e-9))
        .unwrap_or(10.0 * decade)
}

/// The whole steps inside a range, at most so many and one, and how many decimals tell them apart.
pub fn ticks(range: Range, most: usize) -> (Vec<f64>, usize) {
    let step = nice_step(range.span(), most);
    (whole_steps(range, step), decimals(step))
}

/// The multiples of a step inside a range.
pub fn whole_steps(range: Range, step: f64) -> Vec<f64> {
    let first = libm::ceil(range.low / step - 1e-6) as i64;
    let last = libm::floor(range.high / step + 1e-6) as i64;
    (first..=last).map(|index| index as f64 * step).collect()
}

/// How many decimals tell the multiples of a nice step apart.
pub fn decimals(step: f64) -> usize {
    libm::ceil(-libm::log10(step) - 1e-9).max(0.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_one_two_or_five_times_a_power_of_ten() {
        assert_eq!(nice_step(10.0, 10), 1.0);
        assert_eq!(nice_step(11.0, 10), 2.0);
        assert_eq!(nice_step(23.0, 5), 5.0);
        assert_eq!(nice_step(60.0, 10), 10.0);
        assert!((nice_step(0.34, 5) - 0.1).abs() < 1e-12);
    }

    #[test]
    fn ticks_lie_inside_the_range_with_the_decimals_they_need() {
        let (values, decimals) = ticks(
            Range {
                low: 0.1,
                high: 1.05,
            },
            5,
        );
        assert_eq!(decimals, 1);
        let expected = [0.2, 0.4, 0.6, 0.8, 1.0];
        assert_eq!(values.len(), expected.len());
        for (value, expected) in values.iter().zip(expected) {
            assert!((value - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn a_range_ignores_what_is_not_finite_and_is_never_empty() {
        assert_eq!(Range::of([f64::NAN, f64::INFINITY]), None);
        let single = Range::of([3.0, f64::NAN]).expect("one value");
        assert_eq!((single.low, single.high), (2.5, 3.5));
        let pair = Range::of([3.0, -1.0]).expect("two values");
        assert_eq!((pair.low, pair.high), (-1.0, 3.0));
    }
}
