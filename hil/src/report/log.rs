//! The log of the flight, with a box for each level.

use core::fmt::Write;

use maud::{Markup, PreEscaped, html};

use super::number;
use crate::record::LogLine;

/// Lines shown at most; finer levels give way first.
const MOST_LINES: usize = 2500;

/// Characters of a line that are shown.
const MOST_CHARACTERS: usize = 400;

/// From the gravest to the finest.
const LEVELS: [&str; 5] = ["error", "warn", "info", "debug", "trace"];

/// The log, folded away. Boxes hide and show levels without any script.
pub fn log(lines: &[LogLine]) -> Markup {
    let finest = finest_shown(lines);
    let shown: Vec<&LogLine> = lines
        .iter()
        .filter(|line| rank(line) <= finest)
        .take(MOST_LINES)
        .collect();
    let left_out = lines.len() - shown.len();
    html! {
        details.log {
            summary { (number::grouped(lines.len() as u64)) " lines" }
            style { (PreEscaped(hiding_rules())) }
            @for (level, count) in counts(&shown) {
                input type="checkbox" id=(format!("log-{level}")) checked;
                label for=(format!("log-{level}")) { " " (level) " " (number::grouped(count as u64)) }
            }
            @if left_out > 0 {
                p.note { (number::grouped(left_out as u64)) " lines, the finest levels first, are left out here to keep the page small." }
            }
            ol { @for line in shown {
                li class=(level(line)) {
                    span { (number::fixed(line.t, 3)) }
                    span { (line.source) }
                    span { (line.level) }
                    span {
                        (shortened(&line.text))
                        @if let Some(place) = line.place() {
                            " " small title=(place.module) { (place.file) ":" (place.line) }
                        }
                    }
                }
            } }
        }
    }
}

/// The finest level at which the lines fit; the gravest always stays.
fn finest_shown(lines: &[LogLine]) -> usize {
    let fits =
        |finest: &usize| lines.iter().filter(|line| rank(line) <= *finest).count() <= MOST_LINES;
    (0..LEVELS.len()).rev().find(fits).unwrap_or(0)
}

fn counts(shown: &[&LogLine]) -> Vec<(&'static str, usize)> {
    let count = |level: &'static str| {
        (
            level,
            shown
                .iter()
                .filter(|line| self::level(line) == level)
                .count(),
        )
    };
    LEVELS
        .into_iter()
        .map(count)
        .filter(|(_, count)| *count > 0)
        .collect()
}

/// The line's level; unknown ones count as info.
fn level(line: &LogLine) -> &'static str {
    LEVELS[rank(line)]
}

fn rank(line: &LogLine) -> usize {
    const INFO: usize = 2;
    let is_level = |level: &&str| level.eq_ignore_ascii_case(&line.level);
    LEVELS.iter().position(is_level).unwrap_or(INFO)
}

fn hiding_rules() -> String {
    LEVELS.iter().fold(String::new(), |mut css, level| {
        // Writing to a String cannot fail.
        let _ = write!(
            css,
            "#log-{level}:not(:checked)~ol .{level}{{display:none}}"
        );
        css
    })
}

fn shortened(text: &str) -> String {
    match text.char_indices().nth(MOST_CHARACTERS) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::board::origin::{Origin, Place};

    fn line(level: &str) -> LogLine {
        LogLine {
            t: 1.0,
            source: "firmware",
            level: level.into(),
            text: format!("<{level}>"),
            origin: None,
        }
    }

    #[test]
    fn a_line_of_an_image_shows_its_log_statement() {
        let place = Place {
            module: "firmware::log::health".to_owned(),
            file: "firmware/src/log.rs".to_owned(),
            line: 97,
        };
        let origin = Some(Origin {
            stamp: "1.000000".to_owned(),
            place: Some(place),
        });
        let page = log(&[LogLine {
            origin,
            ..line("info")
        }]);
        let shown = r#"<small title="firmware::log::health">firmware/src/log.rs:97</small>"#;
        assert!(page.into_string().contains(shown));
    }

    #[test]
    fn a_log_too_long_gives_up_its_finest_levels_and_says_so() {
        let mut lines = vec![line("error"), line("info")];
        lines.extend((0..9000).map(|_| line("debug")));
        let page = log(&lines).into_string();
        assert!(page.contains("&lt;error&gt;") && page.contains("&lt;info&gt;"));
        assert!(!page.contains("&lt;debug&gt;"));
        assert!(page.contains("9\u{202f}000 lines, the finest levels first"));
    }

    #[test]
    fn every_level_shown_has_a_box_that_hides_it() {
        let page = log(&[line("warn"), line("TRACE")]).into_string();
        assert_eq!(page.matches("type=\"checkbox\"").count(), 2);
        assert!(page.contains("#log-warn:not(:checked)~ol .warn{display:none}"));
        assert!(page.contains("<li class=\"trace\">"));
    }

    #[test]
    fn long_lines_are_cut_between_characters() {
        let text = "ü".repeat(MOST_CHARACTERS + 1);
        assert_eq!(shortened(&text).chars().count(), MOST_CHARACTERS + 1);
    }
}
