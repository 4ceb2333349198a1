//! The tree of functions as a picture: a flame graph, hanging from its roots.

use maud::{Markup, PreEscaped, html};

use emulator::core::Cycle;

use super::stacks::Stacks;
use crate::report::number::grouped;
use crate::report::style;
use crate::report::svg::px;

/// User units of the whole picture.
const WIDTH: f64 = 1200.0;
const MARGIN: f64 = 16.0;
/// Room for the title.
const TOP: f64 = 56.0;
const ROW: f64 = 17.0;
/// What is narrower is not drawn.
const NARROWEST: f64 = 0.4;
/// Width of a character of the labels, on average.
const CHARACTER: f64 = 5.6;

/// A flame graph as a stand-alone SVG. A box is as wide as its function's cycles; pointing at one
/// tells its name, cycles and share.
pub fn picture(stacks: &Stacks) -> String {
    let all = stacks.total().max(1);
    let height = TOP + ROW * stacks.depth() as f64 + MARGIN;
    let scale = (WIDTH - 2.0 * MARGIN) / all as f64;
    let graph = Graph { all, scale };
    html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {} {}", px(WIDTH), px(height)))
            role="img" aria-label="Flame graph of a flight" {
            style { (PreEscaped(style::figure())) }
            rect class="f-paper" width=(px(WIDTH)) height=(px(height)) {}
            text class="f-ink title" x=(px(MARGIN)) y="24" { "Cycles by function" }
            text class="f-muted subtitle" x=(px(MARGIN)) y="44" {
                (grouped(all)) " cycles awake; callers above what they call, inlined functions among them"
            }
            (graph.row(stacks, MARGIN, TOP))
        }
    }
    .into_string()
}

struct Graph {
    all: Cycle,
    scale: f64,
}

impl Graph {
    /// What a function calls, side by side, and so on downwards.
    fn row(&self, stacks: &Stacks, left: f64, top: f64) -> Markup {
        let mut right = left;
        let cells = stacks.callees.iter().map(|(name, callee)| {
            let width = callee.total() as f64 * self.scale;
            right += width;
            (name, callee, right - width, width)
        });
        html! {
            @for (name, callee, left, width) in cells {
                @if width >= NARROWEST {
                    (self.cell(name, callee, [left, top], width))
                    (self.row(callee, left, top + ROW))
                }
            }
        }
    }

    fn cell(&self, name: &str, stacks: &Stacks, [left, top]: [f64; 2], width: f64) -> Markup {
        let total = stacks.total();
        let share = 100.0 * total as f64 / self.all as f64;
        let room = ((width - 6.0) / CHARACTER).max(0.0) as usize;
        html! {
            g {
                title { (name) ": " (grouped(total)) " cycles, " (format!("{share:.2}")) " %" }
                rect class=(class_of(name)) x=(px(left)) y=(px(top)) width=(px((width - 0.5).max(0.3))) height=(px(ROW - 1.0)) {}
                @if room > 3 {
                    text class="f-ink tiny" x=(px(left + 3.0)) y=(px(top + 11.5)) { (shortened(name, room)) }
                }
            }
        }
    }
}

/// Colours by where a function comes from: ours, others', and roots.
fn class_of(name: &str) -> &'static str {
    const OURS: [&str; 6] = [
        "nav::",
        "pilot::",
        "link::",
        "firmware::",
        "sensor::",
        "vision_frame",
    ];
    let bare = name.trim_start_matches(['<', '&']);
    if OURS.iter().any(|ours| bare.starts_with(ours)) {
        "f-odometry"
    } else if name.starts_with("interrupt ") || name == "thread" {
        "f-soft"
    } else {
        "f-route"
    }
}

/// The end of a name says most.
fn shortened(name: &str, room: usize) -> String {
    let count = name.chars().count();
    if count <= room {
        return name.to_owned();
    }
    let tail: String = name.chars().skip(count + 1 - room).collect();
    format!("…{tail}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_is_as_wide_as_its_share_and_what_is_too_narrow_is_left_out() {
        let mut stacks = Stacks::default();
        let chain = |name: &str| [name.to_owned()];
        stacks.add(&chain("thread"), &chain("nav::half"), 500_000);
        stacks.add(&chain("thread"), &chain("rest"), 499_999);
        stacks.add(&chain("thread"), &chain("speck"), 1);
        let picture = picture(&stacks);
        // Half of the width between the margins.
        assert!(picture.contains(r#"width="583.5""#), "{picture}");
        assert!(picture.contains("50.00 %"));
        assert!(!picture.contains("speck"));
    }
}
