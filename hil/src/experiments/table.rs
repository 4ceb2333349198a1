//! The rows as documents have them.

use super::Row;

/// The lines above and below the tables in a document.
pub const MARKERS: [&str; 2] = [
    "<!-- From here on as `hil experiments --markdown` prints it. -->",
    "<!-- To here. -->",
];

/// The columns.
pub const HEADS: [&str; 7] = [
    "claim",
    "what",
    "paper",
    "here",
    "seeds",
    "kept",
    "emulated board, one seed",
];

type Cells = [String; HEADS.len()];

/// One table in Markdown.
pub fn markdown(rows: &[Row]) -> String {
    let heads = HEADS.map(str::to_owned);
    let body: Vec<Cells> = rows.iter().map(cells).collect();
    let width = |column: usize| {
        let of = |line: &Cells| line[column].chars().count();
        body.iter().map(of).fold(of(&heads), usize::max)
    };
    let widths: [usize; HEADS.len()] = core::array::from_fn(width);
    let line = |cells: &Cells| {
        let padded = cells
            .iter()
            .zip(widths)
            .map(|(cell, width)| format!("{cell:width$}"));
        format!("| {} |", padded.collect::<Vec<_>>().join(" | "))
    };
    let rule = widths.map(|width| "-".repeat(width));
    let lines: Vec<_> = [&heads, &rule].into_iter().chain(&body).map(line).collect();
    lines.join("\n")
}

/// The part of a document that is made by the command: the paper's claims, and what goes beyond them.
pub fn document(rows: &[Row]) -> String {
    let (claims, beyond): (Vec<Row>, Vec<Row>) =
        rows.iter().cloned().partition(|row| row.claim.is_some());
    let [begin, end] = MARKERS;
    format!(
        "{begin}\n\n### The paper's claims\n\n{}\n\n### Beside and beyond them\n\n{}\n\n{end}",
        markdown(&claims),
        markdown(&beyond)
    )
}

/// One row for people, as soon as it is there.
pub fn in_words(row: &Row) -> String {
    let claim = row
        .claim
        .map_or(String::new(), |claim| format!("{claim}: "));
    let paper = match row.paper.as_str() {
        "" => String::new(),
        paper => format!(" (paper: {paper})"),
    };
    format!("{claim}{}: {}{paper}", row.what, row.ours)
}

fn cells(row: &Row) -> Cells {
    let emulated = row.emulated.as_ref().map_or("–".to_owned(), |beside| {
        let same = if beside.as_native {
            "the native flight"
        } else {
            "ANOTHER flight"
        };
        format!("{}, {same}", beside.ours)
    });
    [
        row.claim.map_or("–".to_owned(), |claim| claim.to_string()),
        row.what.clone(),
        row.paper.clone(),
        row.ours.clone(),
        match row.seeds {
            0 => "–".to_owned(),
            seeds => seeds.to_string(),
        },
        kept(row.kept).to_owned(),
        emulated,
    ]
    // A bar within a text would end the cell.
    .map(|cell| cell.replace('|', "\\|"))
}

/// Whether a claim holds, in a word.
pub fn kept(kept: Option<bool>) -> &'static str {
    match kept {
        Some(true) => "yes",
        Some(false) => "NO",
        None => "not checked",
    }
}
