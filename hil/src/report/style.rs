//! Colours and style sheets. Figures take their colours from classes `s-NAME` (stroke) and `f-NAME`
//! (fill) whose values are written out, because many SVG viewers know no CSS variables.

use core::fmt::Write;

/// Structure of all figures: fonts, widths, dash patterns.
const FIGURE_CSS: &str = include_str!("figure.css");

/// Structure of the page.
const PAGE_CSS: &str = include_str!("page.css");

/// A named colour on light and on dark paper.
struct Colour {
    name: &'static str,
    light: &'static str,
    dark: &'static str,
}

const fn colour(name: &'static str, light: &'static str, dark: &'static str) -> Colour {
    Colour { name, light, dark }
}

/// Outbound, odometry and homing follow Fig. 6 of van Dijk et al. 2024. They also differ in
/// lightness, so that they stay apart in grey and for colour-blind eyes.
const COLOURS: [Colour; 10] = [
    colour("paper", "#ffffff", "#15171a"),
    colour("ink", "#1d1c1a", "#e9e7e2"),
    colour("muted", "#67635c", "#a09c94"),
    colour("soft", "#a8a39a", "#6f6c67"),
    colour("grid", "#ebe8e2", "#26292d"),
    colour("route", "#f1e9dc", "#2b2a26"),
    colour("outbound", "#c4291f", "#ff6a5c"),
    colour("odometry", "#e3a500", "#ffcf3f"),
    colour("homing", "#1c5fc4", "#5b9dff"),
    colour("uncorrected", "#8b6fa8", "#b79ad6"),
];

/// The style sheet of `report.html`: light, and dark on screens that ask for it.
pub fn page() -> String {
    format!(
        "{variables}{figure}{page}{light}@media screen and (prefers-color-scheme:dark){{{dark_variables}{dark}}}",
        variables = variables(|colour| colour.light),
        figure = FIGURE_CSS,
        page = PAGE_CSS,
        light = classes(|colour| colour.light),
        dark_variables = variables(|colour| colour.dark),
        dark = classes(|colour| colour.dark),
    )
}

/// The style sheet of a stand-alone figure: light.
pub fn figure() -> String {
    format!("{FIGURE_CSS}{}", classes(|colour| colour.light))
}

fn classes(shade: fn(&Colour) -> &'static str) -> String {
    let mut css = String::new();
    for colour in &COLOURS {
        let (name, value) = (colour.name, shade(colour));
        // Writing to a String cannot fail.
        let _ = write!(css, ".s-{name}{{stroke:{value}}}.f-{name}{{fill:{value}}}");
    }
    css
}

fn variables(shade: fn(&Colour) -> &'static str) -> String {
    let mut css = String::from(":root{");
    for colour in &COLOURS {
        // Writing to a String cannot fail.
        let _ = write!(css, "--{}:{};", colour.name, shade(colour));
    }
    css.push('}');
    css
}
