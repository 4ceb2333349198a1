//! The pictures of the paper's Fig. 3: the image difference function over a room, the field of homing vectors, the
//! trajectories and the catchment (3B), and the areas over the bytes (3C).

mod curves;
mod maps;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use maud::{Markup, PreEscaped, html};

use super::measure::{self, Row, Task};
use super::settings::Settings;
use super::survey::Survey;
use crate::report::style;
use crate::report::svg::px;

/// Space round a picture, user units.
const MARGIN: f64 = 24.0;

/// Draws the pictures of a place under a condition into a folder, and says which files they are. `rows` are
/// those of the tasks.
///
/// # Errors
/// Of the file system.
pub fn write(
    folder: &Path,
    survey: &Survey,
    tasks: &[Task],
    settings: &[Settings],
    rows: &[Row],
) -> io::Result<[PathBuf; 2]> {
    let name = file_name(&format!("{}-{}", survey.place, survey.condition));
    let [maps, curves] = ["maps", "areas"].map(|kind| folder.join(format!("{name}-{kind}.svg")));
    fs::write(&maps, maps_of(survey, tasks, settings))?;
    fs::write(&curves, curves::picture(rows))?;
    Ok([maps, curves])
}

/// The maps of the snapshot next to the middle of the room, at a middling size.
fn maps_of(survey: &Survey, tasks: &[Task], settings: &[Settings]) -> String {
    let mut sizes: Vec<u8> = tasks.iter().map(|task| task.bytes).collect();
    sizes.sort_unstable();
    let bytes = sizes.get(sizes.len() / 2).copied().unwrap_or(0);
    let to_one = Survey {
        goals: middle_goal(survey).into_iter().collect(),
        ..survey.clone()
    };
    let of_size = tasks
        .iter()
        .zip(settings)
        .filter(|(task, _)| task.bytes == bytes);
    let found: Vec<_> = of_size
        .filter_map(|(task, settings)| {
            let vectors = measure::vectors_with(&to_one, settings).pop()?;
            Some((task.method.to_string(), vectors))
        })
        .collect();
    maps::picture(&to_one, bytes, &found)
}

fn middle_goal(survey: &Survey) -> Option<super::survey::Goal> {
    let grid = &survey.grid;
    let middle = grid.position_m(grid.columns / 2 + grid.rows / 2 * grid.columns);
    let away = |index| {
        let [x, y] = grid.position_m(index);
        libm::hypotf(x - middle[0], y - middle[1])
    };
    let nearest = |a: &&super::survey::Goal, b: &&super::survey::Goal| {
        away(a.index).total_cmp(&away(b.index))
    };
    survey.goals.iter().min_by(nearest).cloned()
}

/// A name without what file systems take for something else.
fn file_name(name: &str) -> String {
    let harmless = |c: char| {
        if c.is_alphanumeric() || matches!(c, '.' | '-' | '_') {
            c
        } else {
            '-'
        }
    };
    name.chars().map(harmless).collect()
}

/// A picture of this size as a stand-alone SVG on a light background.
fn page([width, height]: [f64; 2], label: &str, content: &Markup) -> String {
    let [wide, high] = [width, height].map(|size| px(size + 2.0 * MARGIN));
    html! {
        svg xmlns="http://www.w3.org/2000/svg" width=(wide) height=(high)
            viewBox=(format!("{0} {0} {wide} {high}", px(-MARGIN))) role="img" aria-label=(label) {
            style { (PreEscaped(style::figure())) }
            rect class="f-paper" x=(px(-MARGIN)) y=(px(-MARGIN)) width=(wide) height=(high) {}
            (content)
        }
    }
    .into_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_named_after_its_place() {
        let name = file_name("hdri:a room/b.hdr,7x6-heading:10");
        assert_eq!(name, "hdri-a-room-b.hdr-7x6-heading-10");
    }
}
