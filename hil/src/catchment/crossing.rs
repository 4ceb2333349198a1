//! At which size another method's catchment area overtakes that of Fourier homing (paper, Fig. 3C).

use std::fmt;

use serde::Serialize;

use super::condition::Condition;
use super::measure::Row;
use super::settings::Method;

/// The methods that may overtake: the published ones, and Franz's search at full resolution.
const OTHERS: [Method; 3] = [Method::Search, Method::SearchFull, Method::Mfdid];

/// From which size on a method has the larger area.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Crossing {
    /// The place; `mean` over all of them where there are several.
    pub world: String,
    /// What differs between memory and view.
    pub condition: Condition,
    /// The method that overtakes Fourier homing.
    pub method: Method,
    /// The size from which on it is ahead, by linear interpolation of both areas between the sizes that were
    /// measured; none where it is ahead at the smallest already, or not at the largest.
    pub bytes: Option<f64>,
    /// The largest size at which Fourier homing has the larger area.
    pub behind_at: Option<u8>,
    /// The smallest size from which on the other has it.
    pub ahead_at: Option<u8>,
}

/// By place, condition and method, in the order of the rows; where there are several places the last ones are
/// those of their mean.
pub fn crossings(rows: &[Row]) -> Vec<Crossing> {
    let mut groups: Vec<(String, Condition, Vec<&Row>)> = Vec::new();
    let mut means: Vec<(String, Condition, Vec<&Row>)> = Vec::new();
    for row in rows {
        for (groups, world) in [(&mut groups, row.world.as_str()), (&mut means, "mean")] {
            let known = groups
                .iter_mut()
                .find(|(name, condition, _)| name == world && *condition == row.condition);
            match known {
                Some((.., members)) => members.push(row),
                None => groups.push((world.to_owned(), row.condition, vec![row])),
            }
        }
    }
    if groups.len() > means.len() {
        groups.extend(means);
    }
    groups.iter().flat_map(of_group).collect()
}

fn of_group((world, condition, rows): &(String, Condition, Vec<&Row>)) -> Vec<Crossing> {
    let crossing = |method| {
        let ahead = ahead_by(rows, method);
        let (behind_at, ahead_at, bytes) = last_change(&ahead);
        (!ahead.is_empty()).then(|| Crossing {
            world: world.clone(),
            condition: *condition,
            method,
            bytes,
            behind_at,
            ahead_at,
        })
    };
    OTHERS.into_iter().filter_map(crossing).collect()
}

/// By how much a method is ahead of Fourier homing, m², at the sizes at which both were measured, the smallest
/// first.
fn ahead_by(rows: &[&Row], method: Method) -> Vec<(u8, f64)> {
    let mean_m2 = |method: Method, bytes: u8| {
        let areas = rows
            .iter()
            .filter(|row| row.method == method && row.bytes == bytes)
            .map(|row| row.area_m2);
        let (sum, count) = areas.fold((0.0, 0_u32), |(sum, count), area| (sum + area, count + 1));
        (count > 0).then(|| sum / f64::from(count))
    };
    let mut sizes: Vec<u8> = rows.iter().map(|row| row.bytes).collect();
    sizes.sort_unstable();
    sizes.dedup();
    let ahead = |bytes| {
        Some((
            bytes,
            mean_m2(method, bytes)? - mean_m2(Method::Fourier, bytes)?,
        ))
    };
    sizes.into_iter().filter_map(ahead).collect()
}

/// Where the sign changes for the last time: the sizes before and behind, and the zero between them.
fn last_change(ahead: &[(u8, f64)]) -> (Option<u8>, Option<u8>, Option<f64>) {
    let first = ahead.iter().rposition(|(_, by)| *by < 0.0);
    let next = first.map_or(0, |index| index + 1);
    let (behind, ahead) = (first.map(|index| ahead[index]), ahead.get(next).copied());
    let zero = behind.zip(ahead).map(|((small, below), (large, above))| {
        let [small, large] = [small, large].map(f64::from);
        small + (large - small) * below / (below - above)
    });
    (
        behind.map(|(bytes, _)| bytes),
        ahead.map(|(bytes, _)| bytes),
        zero,
    )
}

impl fmt::Display for Crossing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { method, world, .. } = self;
        match (self.bytes, self.behind_at, self.ahead_at) {
            (Some(bytes), ..) => write!(f, "{method} overtakes fourier at {bytes:.1} bytes")?,
            (None, Some(behind), _) => {
                write!(f, "{method} is behind fourier still at {behind} bytes")?
            }
            (None, None, Some(ahead)) => {
                write!(f, "{method} is ahead of fourier from {ahead} bytes on")?
            }
            (None, None, None) => write!(f, "{method} and fourier share no size")?,
        }
        write!(f, " ({world}, condition {})", self.condition)
    }
}

#[cfg(test)]
mod tests {
    use super::super::measure::row_of;
    use super::*;

    fn rows(world: &str, method: Method, areas: &[(u8, f64)]) -> Vec<Row> {
        let row = |(bytes, area_m2): &(u8, f64)| row_of(world, method, *bytes, [*area_m2, 1.0]);
        areas.iter().map(row).collect()
    }

    #[test]
    fn the_crossing_is_where_straight_lines_between_the_sizes_meet() {
        let mut all = rows("room", Method::Fourier, &[(4, 30.0), (8, 30.0), (16, 30.0)]);
        all.extend(rows(
            "room",
            Method::Search,
            &[(4, 5.0), (8, 24.0), (16, 32.0)],
        ));
        let [crossing] = &crossings(&all)[..] else {
            panic!("one place, one method");
        };
        // 6 m² behind at 8 bytes, 2 m² ahead at 16: three quarters of the way.
        assert_eq!(crossing.bytes, Some(14.0));
        assert_eq!((crossing.behind_at, crossing.ahead_at), (Some(8), Some(16)));
        assert!(crossing.to_string().contains("14.0 bytes"), "{crossing}");
    }

    #[test]
    fn of_several_crossings_the_last_counts() {
        let ahead = [(4, -1.0), (8, 1.0), (12, -1.0), (16, 3.0), (20, 2.0)];
        assert_eq!(last_change(&ahead), (Some(12), Some(16), Some(13.0)));
    }

    #[test]
    fn without_a_crossing_it_is_said_who_is_ahead() {
        assert_eq!(last_change(&[(4, 1.0), (8, 2.0)]), (None, Some(4), None));
        assert_eq!(last_change(&[(4, 1.0), (8, -2.0)]), (Some(8), None, None));
        assert_eq!(last_change(&[]), (None, None, None));
    }

    #[test]
    fn several_places_have_a_mean_beside_their_own() {
        let mut all = Vec::new();
        for (world, search) in [("a", [10.0, 30.0]), ("b", [20.0, 34.0])] {
            all.extend(rows(world, Method::Fourier, &[(4, 25.0), (8, 27.0)]));
            all.extend(rows(
                world,
                Method::Search,
                &[(4, search[0]), (8, search[1])],
            ));
        }
        let found = crossings(&all);
        let worlds: Vec<&str> = found
            .iter()
            .map(|crossing| crossing.world.as_str())
            .collect();
        assert_eq!(worlds, ["a", "b", "mean"]);
        // 10 m² behind and 5 ahead in the mean.
        assert_eq!(found[2].bytes, Some(4.0 + 4.0 * 10.0 / 15.0));
    }
}
