//! The homing vectors of a search, with the loops the other way round: a guess's lines of sight once for all
//! views, and each warped view once for all snapshots. What the method finds one by one, an order sooner.

use nav::methods::search::{self, Guess};
use nav::methods::{HomingMethod, Pixels, Search};

use super::measure::{Vectors, by_its_north};
use super::survey::{Current, Survey};

/// Views that are warped side by side: two vector registers.
const RINGS: usize = 8;

/// Views side by side, and the best guess so far for each snapshot and view.
struct Searched<'a> {
    currents: Vec<(usize, &'a Current)>,
    seen: Vec<[f32; RINGS]>,
    best: Vec<[Option<(f32, Guess)>; RINGS]>,
}

impl<'a> Searched<'a> {
    fn new(method: &Search, currents: &[(usize, &'a Current)], snapshots: usize) -> Self {
        let mut rings = Vec::new();
        for (ring, (_, current)) in currents.iter().enumerate() {
            let seen = method.see(&current.view);
            rings.resize(seen.len(), [0.0; RINGS]);
            for (all, [luma]) in rings.iter_mut().zip(seen) {
                all[ring] = luma;
            }
        }
        Self {
            currents: currents.to_vec(),
            seen: rings,
            best: vec![[None; RINGS]; snapshots],
        }
    }

    fn offer(&mut self, snapshot: usize, differences: [f32; RINGS], guess: Guess) {
        for (best, difference) in self.best[snapshot].iter_mut().zip(differences) {
            if best.is_none_or(|(least, _)| difference < least) {
                *best = Some((difference, guess));
            }
        }
    }
}

/// The homing vectors to each snapshot, to the bit those of [`measure::vectors`](super::measure::vectors).
pub fn vectors(survey: &Survey, method: &Search) -> Vec<Vectors> {
    let goals = survey.goals.iter();
    let stored: Vec<Pixels> = goals
        .map(|goal| method.stored(&method.remember(&goal.view)))
        .collect();
    let currents = survey.currents.iter().enumerate();
    let currents: Vec<_> = currents
        .filter_map(|(index, current)| Some((index, current.as_ref()?)))
        .collect();
    let views = currents.chunks(RINGS);
    let mut views: Vec<Searched> = views
        .map(|currents| Searched::new(method, currents, stored.len()))
        .collect();
    for guess in method.guesses() {
        let gaze = method.gaze(&guess);
        for views in &mut views {
            let warped = gaze.warped(&views.seen);
            for (snapshot, stored) in stored.iter().enumerate() {
                views.offer(snapshot, search::differences(&warped, stored), guess);
            }
        }
    }
    let mut found = vec![Vectors::none(survey.currents.len()); stored.len()];
    for views in &views {
        for ((found, best), stored) in found.iter_mut().zip(&views.best).zip(&stored) {
            for ((index, current), best) in views.currents.iter().zip(best) {
                let way = best.map(|best| method.homeward(best, stored));
                if let Some(Ok(way)) = way {
                    found.moves[*index] = Some(by_its_north(current, &way));
                    found.qualities[*index] = way.quality;
                }
            }
        }
    }
    found
}
