//! What a reader of the report has to know about the logs: what they are, and what is missing in them.

use super::clock::Clock;
use super::estimate::Track;
use super::series::{GAP_MS, Variables};
use super::table::Table;

/// A line of the flight's log before the flight.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// `info` or `warn`.
    pub level: &'static str,
    /// For people.
    pub text: String,
}

/// Variables that belong together, and what is not in the report without them.
const GROUPS: [(&[&str], &str); 6] = [
    (
        &["vh.v_to_n", "vh.v_to_e", "vh.v_from_n", "vh.v_from_e"],
        "homing vectors, and with them where the way back begins",
    ),
    (&["vh.v_source"], "whether the camera or odometry led"),
    (&["vh.v_dpsi"], "how far vectors asked to turn"),
    (&["vh.m_ss_idx", "vh.m_ss_n", "vh.m_ss_e"], "snapshots"),
    (
        &["vh.m_odo_idx", "vh.m_odo_n", "vh.m_odo_e"],
        "odometry vectors and their memory",
    ),
    (
        &[
            "vh.i_ss_idx",
            "vh.i_from_n",
            "vh.i_from_e",
            "vh.i_from_psi",
            "vh.i_to_n",
            "vh.i_to_e",
            "vh.i_to_psi",
        ],
        "corrections of the filter",
    ),
];

/// All that is to be told.
pub fn notes(
    tables: &[Table],
    clock: &Clock,
    variables: &Variables,
    track: Option<&Track>,
) -> Vec<Note> {
    let mut notes: Vec<Note> = Vec::new();
    for (file, table) in tables.iter().enumerate() {
        of_file(file, tables, table, clock, &mut notes);
    }
    if tables.iter().any(|table| table.wrapped) {
        let text = "the tick wrapped at 24 bits; flight time goes on".to_owned();
        notes.push(info(text));
    }
    notes.push(info(held(tables)));
    of_track(track, &mut notes);
    for (names, what) in GROUPS {
        let absent: Vec<&str> = names
            .iter()
            .copied()
            .filter(|name| variables.get(name).is_none())
            .collect();
        if !absent.is_empty() {
            notes.push(warn(format!(
                "{what}: not known for want of {}",
                absent.join(", ")
            )));
        }
    }
    notes
}

fn of_file(file: usize, tables: &[Table], table: &Table, clock: &Clock, notes: &mut Vec<Note>) {
    let name = &table.name;
    let Some((first, last)) = clock.span_ms(file, table) else {
        notes.push(warn(format!("{name} has no row")));
        return;
    };
    let seconds = |ms: u64| ms as f64 / 1_000.0;
    let period = table
        .period_ms()
        .map_or(String::new(), |ms| format!(", one each {ms} ms"));
    notes.push(info(format!(
        "{name}: {} rows from {:.1} s to {:.1} s{period}: {}",
        table.rows.len(),
        seconds(first),
        seconds(last),
        table.variables.join(", ")
    )));
    if let Some((count, longest)) = gaps(table) {
        notes.push(warn(format!(
            "{name}: {count} times more than {} s without a row, once {:.1} s: nothing is known there",
            GAP_MS / 1_000,
            seconds(longest)
        )));
    }
    if table.cut {
        notes.push(warn(format!(
            "{name}: the last line is not whole and is left out"
        )));
    }
    let others = tables
        .iter()
        .enumerate()
        .filter(|(other, _)| *other != file);
    let mut spans = others
        .filter_map(|(other, table)| clock.span_ms(other, table))
        .peekable();
    if spans.peek().is_some() && !spans.any(|(from, to)| from <= last && first <= to) {
        notes.push(warn(format!(
            "{name} shares no time with the other files: is it of another flight?"
        )));
    }
}

/// How often and how long at most the rows pause: the radio was lost, or the log was stopped.
fn gaps(table: &Table) -> Option<(usize, u64)> {
    let steps = table.rows.windows(2).map(|pair| pair[1].ms - pair[0].ms);
    let gaps: Vec<u64> = steps.filter(|step| *step > GAP_MS).collect();
    Some((gaps.len(), *gaps.iter().max()?))
}

/// What sampling does to messages.
fn held(tables: &[Table]) -> String {
    let camera = |table: &&Table| table.variables.iter().any(|name| name.starts_with("vh."));
    let slowest = tables
        .iter()
        .filter(camera)
        .filter_map(Table::period_ms)
        .max();
    let how_often = slowest.map_or(String::new(), |ms| format!(", here up to {ms} ms apart"));
    format!(
        "the logs are samples: a value holds from row to row{how_often}; what the camera sent and \
         replaced in between is not in them"
    )
}

fn of_track(track: Option<&Track>, notes: &mut Vec<Note>) {
    let Some(track) = track else {
        notes.push(warn(
            "where the drone was: not known for want of stateEstimate.x, stateEstimate.y".into(),
        ));
        return;
    };
    let [place, yaw, height] = track.sources();
    if let Some(place) = place.filter(|name| *name != "stateEstimate.x") {
        notes.push(info(format!(
            "places are from {place}: there is no stateEstimate.x"
        )));
    }
    if yaw.is_none() {
        notes.push(warn(
            "headings: not known for want of stateEstimate.yaw".into(),
        ));
    }
    if height.is_none() {
        notes.push(warn(
            "when the drone was on the ground: not known for want of stateEstimate.z".into(),
        ));
    }
}

fn info(text: String) -> Note {
    let level = "info";
    Note { level, text }
}

fn warn(text: String) -> Note {
    let level = "warn";
    Note { level, text }
}
