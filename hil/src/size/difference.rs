//! What became larger or smaller since a baseline.

use std::collections::BTreeMap;

use serde::Serialize;

use super::{Bytes, Size};

/// Bytes more than before; negative: less.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Change {
    /// Of flash.
    pub flash: i64,
    /// Of RAM.
    pub ram: i64,
}

/// All that changed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Difference {
    /// Flash and RAM in all.
    pub all: Change,
    /// The deepest stack; none where one of the two is not known.
    pub stack_peak: Option<i64>,
    /// Crates that changed.
    pub crates: BTreeMap<String, Change>,
    /// Symbols that changed, came or went.
    pub symbols: BTreeMap<String, Change>,
}

impl Difference {
    /// From `before` to `now`.
    pub fn between(before: &Size, now: &Size) -> Self {
        let peaks = before.stack_peak_bytes.zip(now.stack_peak_bytes);
        let all = |size: &Size| Bytes {
            flash: size.flash_bytes,
            ram: size.ram_bytes,
        };
        Self {
            all: change(all(before), all(now)),
            stack_peak: peaks.map(|(before, now)| i64::from(now) - i64::from(before)),
            crates: changes(&before.crates, &now.crates),
            symbols: changes(&before.symbols, &now.symbols),
        }
    }
}

fn change(before: Bytes, now: Bytes) -> Change {
    Change {
        flash: i64::from(now.flash) - i64::from(before.flash),
        ram: i64::from(now.ram) - i64::from(before.ram),
    }
}

fn changes(
    before: &BTreeMap<String, Bytes>,
    now: &BTreeMap<String, Bytes>,
) -> BTreeMap<String, Change> {
    let names = before.keys().chain(now.keys());
    let of =
        |sizes: &BTreeMap<String, Bytes>, name: &str| sizes.get(name).copied().unwrap_or_default();
    names
        .map(|name| (name.clone(), change(of(before, name), of(now, name))))
        .filter(|(_, change)| *change != Change::default())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn size(symbols: &[(&str, u32)], peak: Option<u32>) -> Size {
        let symbols: BTreeMap<String, Bytes> = symbols
            .iter()
            .map(|(name, flash)| {
                (
                    (*name).to_owned(),
                    Bytes {
                        flash: *flash,
                        ram: 0,
                    },
                )
            })
            .collect();
        Size {
            flash_bytes: symbols.values().map(|bytes| bytes.flash).sum(),
            ram_bytes: 0,
            stack_bytes: 1_000,
            stack_peak_bytes: peak,
            stack_free_bytes: peak.map(|peak| 1_000 - peak),
            crates: BTreeMap::new(),
            symbols,
        }
    }

    #[test]
    fn what_grew_shrank_came_and_went_is_named_and_the_rest_is_not() {
        let before = size(&[("same", 5), ("grew", 10), ("went", 7)], Some(100));
        let now = size(&[("same", 5), ("grew", 30), ("came", 1)], Some(90));
        let difference = Difference::between(&before, &now);
        let flash: Vec<(&str, i64)> = difference
            .symbols
            .iter()
            .map(|(name, change)| (name.as_str(), change.flash))
            .collect();
        assert_eq!(flash, [("came", 1), ("grew", 20), ("went", -7)]);
        assert_eq!(difference.all.flash, 14);
        assert_eq!(difference.stack_peak, Some(-10));
    }
}
