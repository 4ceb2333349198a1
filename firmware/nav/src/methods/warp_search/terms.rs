//! Which products of two coefficients turn with the direction as which harmonic.
//!
//! After a turn by α coefficient m of a view is c_m e^{imα}. So a product of two of them, one of which
//! may be conjugate, turns as the sum or the difference of their frequencies, and with 36 directions
//! only 19 harmonics can be told apart.

use super::{DIRECTIONS, IN, MOST_COMPARED};

/// Harmonics of the direction, 0 to 18.
pub const HARMONICS: usize = DIRECTIONS as usize / 2 + 1;

/// Rows of the warp matrices: one more than is compared, because the gradient of the last step leans
/// on it.
pub const ROWS: usize = MOST_COMPARED + 1;

/// A product of coefficient `first` of one view and `second` of another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Term {
    /// k of the first coefficient, from 1; [`Self::NONE`] where a place is left empty.
    pub first: u8,
    /// m of the second, from 1.
    pub second: u8,
    /// Where the second stands among all that a first is multiplied by: [`IN`] of each kind of product,
    /// plain, mirrored, apart, and both. Apart has the first conjugate, and the harmonic is the
    /// difference of the frequencies, else their sum; mirrored counts conjugate, because its harmonic
    /// is a negative one.
    pub factor: u8,
}

impl Term {
    /// No frequency that there is.
    const NONE: u8 = u8::MAX;
    /// Fills up a harmonic to pairs of terms.
    const EMPTY: Self = Self {
        first: Self::NONE,
        second: 1,
        factor: 0,
    };

    /// The term with the harmonic that it turns as.
    const fn new(first: usize, second: usize, apart: bool) -> (Self, usize) {
        let turns = if apart {
            second as i32 - first as i32
        } else {
            (second + first) as i32
        };
        let directions = DIRECTIONS as i32;
        let turns = turns.rem_euclid(directions);
        let mirrored = 2 * turns > directions;
        let harmonic = if mirrored { directions - turns } else { turns };
        let term = Self {
            first: first as u8,
            second: second as u8,
            factor: ((apart as usize * 2 + mirrored as usize) * IN + second - 1) as u8,
        };
        (term, harmonic as usize)
    }

    /// Whether the first is conjugate.
    pub const fn is_apart(self) -> bool {
        self.factor as usize >= 2 * IN
    }
}

/// All products, by harmonic, and there by their first frequency; each harmonic starts at an even
/// place. `N` places are enough for them.
pub struct Terms<const N: usize> {
    /// By place.
    pub all: [Term; N],
    /// The place at which each harmonic starts, and where the last ends.
    pub starts: [u16; HARMONICS + 1],
}

impl<const N: usize> Terms<N> {
    /// Products of the first `rows` frequencies with all of [`IN`], or with those up to the first's if
    /// the order of the two does not matter.
    const fn new(rows: usize, either_way: bool) -> Self {
        let mut terms = Self {
            all: [Term::EMPTY; N],
            starts: [0; HARMONICS + 1],
        };
        let mut place = 0;
        let mut harmonic = 0;
        while harmonic < HARMONICS {
            terms.starts[harmonic] = place as u16;
            let mut first = 1;
            while first <= rows {
                let last = if either_way { first } else { IN };
                let mut second = 1;
                while second <= last {
                    let mut kind = 0;
                    while kind < 2 {
                        let (term, turns) = Term::new(first, second, kind == 0);
                        if turns == harmonic {
                            terms.all[place] = term;
                            place += 1;
                        }
                        kind += 1;
                    }
                    second += 1;
                }
                first += 1;
            }
            place += place % 2;
            harmonic += 1;
        }
        terms.starts[HARMONICS] = place as u16;
        terms
    }

    /// The places of a harmonic.
    pub const fn places(&self, harmonic: usize) -> core::ops::Range<usize> {
        self.starts[harmonic] as usize..self.starts[harmonic + 1] as usize
    }

    /// How many of each harmonic's terms have a first frequency of at most this.
    pub fn up_to(&self, frequencies: usize) -> [u8; HARMONICS] {
        core::array::from_fn(|harmonic| {
            let terms = &self.all[self.places(harmonic)];
            let within = terms
                .iter()
                .take_while(|term| usize::from(term.first) <= frequencies);
            within.count() as u8
        })
    }
}

/// Pairs of places for the products of the stored view with the current one.
pub const CROSS_PAIRS: usize = 350;
/// The same for the products of the current view with itself.
pub const OWN_PAIRS: usize = 220;

/// Stored view (first) times current view (second).
pub static CROSS: Terms<{ 2 * CROSS_PAIRS }> = Terms::new(ROWS, false);
/// Current view times itself.
pub static OWN: Terms<{ 2 * OWN_PAIRS }> = Terms::new(IN, true);
