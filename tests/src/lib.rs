//! What the tests share: the limits of `budgets.toml`.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;

/// One limit.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Budget {
    /// The largest value that passes.
    pub at_most: Option<f64>,
    /// The smallest value that passes.
    pub at_least: Option<f64>,
    /// In which unit.
    pub unit: String,
    /// Why this limit.
    pub reason: String,
}

/// All limits, by name.
#[derive(Clone, Debug)]
pub struct Budgets(BTreeMap<String, Budget>);

impl Budgets {
    /// Reads `tests/budgets.toml`.
    ///
    /// # Panics
    ///
    /// If the file is missing or malformed: a test without its limits must fail.
    pub fn load() -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("budgets.toml");
        let text = std::fs::read_to_string(&path).expect("budgets.toml is there");
        Self(toml::from_str(&text).expect("budgets.toml is well formed"))
    }

    /// Holds a measured value against its limit.
    ///
    /// # Panics
    ///
    /// If the value is beyond the limit, or if there is no limit of this name.
    #[track_caller]
    pub fn hold(&self, name: &str, value: f64) {
        let budget = self
            .0
            .get(name)
            .unwrap_or_else(|| panic!("budgets.toml has no limit `{name}`"));
        let Budget {
            at_most,
            at_least,
            unit,
            reason,
        } = budget;
        assert!(
            at_most.is_some() || at_least.is_some(),
            "`{name}` limits nothing"
        );
        // Written so that NaN fails.
        let within = at_most.is_none_or(|limit| value <= limit)
            && at_least.is_none_or(|limit| value >= limit);
        assert!(
            within,
            "{name}: {value} {unit} is beyond {at_most:?}..{at_least:?} ({reason})"
        );
    }
}
