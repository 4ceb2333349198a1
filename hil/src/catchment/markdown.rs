//! The comparison as a table for documents: a line for each condition, place and size, a column for each method.

use std::fmt::Write as _;

use super::measure::Row;
use super::settings::Method;

/// The table, the largest area of each line in bold, and below it the lines that the default loses, where it
/// takes part.
pub fn table(rows: &[Row]) -> String {
    let mut methods: Vec<Method> = Vec::new();
    for row in rows {
        if !methods.contains(&row.method) {
            methods.push(row.method);
        }
    }
    let names: Vec<String> = methods.iter().map(Method::to_string).collect();
    let mut text = format!(
        "| condition | place | bytes | {} |\n| --- | --- | --- |{}\n",
        names.join(" | "),
        " --- |".repeat(methods.len())
    );
    let mut lost = Vec::new();
    let alike =
        |a: &Row, b: &Row| (a.condition, &a.world, a.bytes) == (b.condition, &b.world, b.bytes);
    for line in rows.chunk_by(alike) {
        let Some(best) = line.iter().max_by(|a, b| a.area_m2.total_cmp(&b.area_m2)) else {
            continue;
        };
        // Writing to a String cannot fail.
        let _ = write!(
            text,
            "| {} | {} | {} |",
            best.condition,
            short(&best.world),
            best.bytes
        );
        for method in &methods {
            let row = line.iter().find(|row| row.method == *method);
            let _ = write!(
                text,
                " {} |",
                row.map_or(String::new(), |row| cell(row, row.method == best.method))
            );
        }
        text.push('\n');
        lost.extend(line.iter().filter_map(|row| loss(row, best)));
    }
    if methods.contains(&Method::Default) {
        text.push('\n');
        text.push_str(&match lost.len() {
            0 => "The default loses no line.".to_owned(),
            _ => format!("The default loses:\n\n{}", lost.join("\n")),
        });
    }
    text
}

fn cell(row: &Row, is_best: bool) -> String {
    let stars = if is_best { "**" } else { "" };
    format!(
        "{stars}{:.1} ± {:.1} ({:.1}){stars}",
        row.area_m2, row.stderr_m2, row.area25_m2
    )
}

/// What the default lacks to the best, as an item of a list; none if nothing.
fn loss(row: &Row, best: &Row) -> Option<String> {
    let less_m2 = best.area_m2 - row.area_m2;
    // Of the difference of two means that are taken for independent.
    let stderr_m2 = libm::hypot(best.stderr_m2, row.stderr_m2);
    (row.method == Method::Default && less_m2 > 0.0).then(|| {
        format!(
            "- {}, {}, {} bytes: {less_m2:.1} ± {stderr_m2:.1} m² to {}",
            row.condition,
            short(&row.world),
            row.bytes,
            best.method
        )
    })
}

/// A panorama's place without its folder and ending.
fn short(world: &str) -> &str {
    let file = world.rsplit('/').next().unwrap_or(world);
    file.split(".hdr").next().unwrap_or(file)
}

#[cfg(test)]
mod tests {
    use super::super::measure::row_of;
    use super::*;

    #[test]
    fn the_largest_area_of_a_line_is_bold_and_what_the_default_loses_is_listed() {
        let world = "hdri:rooms/attic.hdr,7.3x6.9";
        let rows = [
            row_of(world, Method::Fourier, 8, [30.0, 3.0]),
            row_of(world, Method::Default, 8, [33.5, 1.0]),
            row_of(world, Method::Fourier, 16, [35.0, 3.0]),
            row_of(world, Method::Default, 16, [33.0, 4.0]),
        ];
        let text = table(&rows);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(
            lines[0],
            "| condition | place | bytes | fourier | default |"
        );
        assert!(
            lines[2].starts_with("| none | attic | 8 | 30.0 ± 3.0 ("),
            "{text}"
        );
        assert!(lines[2].contains("| **33.5 ± 1.0 ("), "{text}");
        assert!(lines[3].contains("| **35.0 ± 3.0 ("), "{text}");
        let lost: Vec<&str> = lines
            .iter()
            .copied()
            .filter(|line| line.starts_with("- "))
            .collect();
        assert_eq!(lost, ["- none, attic, 16 bytes: 2.0 ± 5.0 m² to fourier"]);
        assert!(table(&rows[..2]).ends_with("The default loses no line."));
        assert!(!table(&rows[..1]).contains("default"));
    }
}
