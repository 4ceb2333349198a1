//! How often a frame took how many cycles, a panel for every stage and one for all of vision.

use emulator::core::Cycle;
use maud::{Markup, PreEscaped, html};

use super::figures::Quantiles;
use super::frames::FrameProfile;
use super::stage::Stage;
use crate::report::histogram::{self, Lines, Words};
use crate::report::style;
use crate::report::svg::px;

/// Panels side by side.
const COLUMNS: usize = 2;
const MARGIN: f64 = 24.0;

/// All panels as a stand-alone SVG.
pub fn picture(frames: &[FrameProfile]) -> String {
    let stages = Stage::ALL.map(|stage| {
        let cycles = frames
            .iter()
            .filter_map(|frame| frame.stages[stage as usize]);
        (stage.name(), cycles.collect())
    });
    let vision = frames.iter().map(FrameProfile::vision).collect();
    let panels: Vec<(&str, Vec<Cycle>)> = stages
        .into_iter()
        .chain([("vision in all", vision)])
        .collect();
    let [width, height] = histogram::SIZE.map(|side| side + MARGIN);
    let rows = panels.len().div_ceil(COLUMNS) as f64;
    let view = [MARGIN + COLUMNS as f64 * width, MARGIN + rows * height].map(px);
    html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {} {}", view[0], view[1]))
            role="img" aria-label="Histograms of cycles, stage by stage" {
            style { (PreEscaped(style::figure())) }
            rect class="f-paper" width=(view[0]) height=(view[1]) {}
            @for (index, (name, cycles)) in panels.into_iter().enumerate() {
                @let x = MARGIN + width * (index % COLUMNS) as f64;
                @let y = MARGIN + height * (index / COLUMNS) as f64;
                g transform=(format!("translate({} {})", px(x), px(y))) { (panel(name, cycles)) }
            }
        }
    }
    .into_string()
}

fn panel(name: &str, cycles: Vec<Cycle>) -> Markup {
    let narrow = |cycles: Cycle| u32::try_from(cycles).unwrap_or(u32::MAX);
    let values: Vec<u32> = cycles.iter().copied().map(narrow).collect();
    let quantiles = Quantiles::of(cycles);
    let lines = (!values.is_empty()).then_some(Lines {
        p50: narrow(quantiles.p50),
        p99: narrow(quantiles.p99),
        max: narrow(quantiles.max),
    });
    let words = Words {
        title: name,
        axis: "cycles of a frame",
        nothing: "No frame needed it.",
    };
    histogram::panel(words, &values, lines)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::number::grouped;

    #[test]
    fn every_stage_has_a_panel_with_its_quantiles_also_one_that_never_ran() {
        let mut frame = FrameProfile::default();
        frame.stages[Stage::Unwrap as usize] = Some(9_437);
        let picture = picture(&[frame]);
        for stage in Stage::ALL {
            assert!(
                picture.contains(&format!(">{}</text>", stage.name())),
                "{stage:?}"
            );
        }
        // The stage's, and that of vision, which is nothing else.
        let told = format!("p99 {}", grouped(9_437));
        assert_eq!(picture.matches(&told).count(), 2);
        let never = Stage::ALL.len() - 1;
        assert_eq!(picture.matches("No frame needed it.").count(), never);
    }
}
