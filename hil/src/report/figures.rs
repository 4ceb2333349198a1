//! The flight in a sentence, and in all figures of the summary.

use maud::{Markup, html};
use serde_json::Value;

use super::number::{self, NONE};
use crate::record::{Recording, Reference};
use crate::summary::Summary;

/// The backend of flights that come from the logs of the real thing.
const IMPORTED: &str = "cfclient";

/// Whether the flight was imported: the rig flew nothing and counted nothing.
pub fn is_imported(summary: &Summary) -> bool {
    summary.backend == IMPORTED
}

/// The flight in one sentence.
pub fn headline(recording: &Recording, summary: &Summary) -> String {
    let out = number::fixed(summary.outbound_m, 0);
    let memory = number::grouped(summary.memory_bytes as u64);
    let error = number::fixed(summary.home_error_m, 2);
    let back = number::fixed(summary.inbound_m, 0);
    match (recording.reference, summary.completed) {
        (Reference::Truth, true) => format!(
            "{out} m out and home again, to within {error} m, on {memory} bytes of route memory"
        ),
        (Reference::Truth, false) => format!("{out} m out, not home again"),
        (Reference::Estimate, _) if summary.inbound_m > 0.0 => {
            format!("{out} m out and {back} m back, by the drone's own estimate")
        }
        (Reference::Estimate, _) => format!("{out} m out, by the drone's own estimate"),
    }
}

/// What was flown, and with what.
pub fn subline(summary: &Summary) -> String {
    if is_imported(summary) {
        return format!(
            "A flight of the real thing, from logs of {IMPORTED}: {}",
            summary.route
        );
    }
    let apart = if summary.spacing_m.is_finite() {
        format!("{} m apart", number::trimmed(summary.spacing_m, 2))
    } else {
        "as far apart as odometry allows".to_owned()
    };
    let how = match summary.homing {
        "odometry" => "odometry alone".to_owned(),
        "sequence" => format!("snapshots alone, {apart}"),
        _ => format!("snapshots {apart} and odometry"),
    };
    format!(
        "World {} · route {} · {how} · seed {} · {}",
        summary.world, summary.route, summary.seed, summary.backend,
    )
}

/// Every known figure of `summary.json` under its name there.
pub fn all_figures(recording: &Recording, summary: &Summary) -> Markup {
    let mut rows = Vec::new();
    match serde_json::to_value(summary) {
        Ok(value) => flatten("", &value, &mut rows),
        Err(error) => rows.push(("error".into(), error.to_string())),
    }
    let unknown = unknown(recording, summary);
    let is_known = |name: &str| !unknown.iter().any(|prefix| name.starts_with(prefix));
    html! {
        details {
            summary { "All figures of summary.json" }
            dl.all {
                @for (name, value) in rows {
                    @if is_known(&name) && value != NONE { div { dt { (name) } dd { (value) } } }
                }
            }
        }
    }
}

/// Beginnings of the names of figures that stand in the summary without being known.
fn unknown(recording: &Recording, summary: &Summary) -> Vec<&'static str> {
    let mut names = Vec::new();
    if recording.reference == Reference::Estimate {
        names.push("odometry_only_error_m");
    }
    if is_imported(summary) {
        names.extend(["seed", "world", "conditions.", "frames_", "link."]);
    }
    names
}

/// Objects become dotted names.
fn flatten(name: &str, value: &Value, rows: &mut Vec<(String, String)>) {
    match value {
        Value::Object(fields) => {
            for (field, value) in fields {
                let dot = if name.is_empty() { "" } else { "." };
                flatten(&format!("{name}{dot}{field}"), value, rows);
            }
        }
        Value::Array(values) => {
            let words: Vec<String> = values
                .iter()
                .map(|value| {
                    value
                        .as_str()
                        .map_or_else(|| value.to_string(), str::to_owned)
                })
                .collect();
            rows.push((name.to_owned(), words.join(", ")));
        }
        Value::String(text) => rows.push((name.to_owned(), text.clone())),
        Value::Number(number) if number.is_f64() => {
            let value = number.as_f64().unwrap_or(f64::NAN);
            rows.push((name.to_owned(), number::trimmed(value, 4)));
        }
        Value::Null => rows.push((name.to_owned(), NONE.to_owned())),
        other => rows.push((name.to_owned(), other.to_string())),
    }
}
