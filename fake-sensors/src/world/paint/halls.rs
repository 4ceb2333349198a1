//! Pictures of large buildings: factory halls and greenhouses.

use super::between;
use super::canvas::{Area, Canvas, Sheet};
use crate::random::Normal;

/// Distance between a hall's columns in metres.
const BAY_M: f32 = 5.0;
/// Distance between the bars of a greenhouse in metres.
const PANE_M: f32 = 1.2;

/// A hall's wall: bays between steel columns; gates, racks of goods or sheet metal below, a band of
/// windows above.
pub fn wall(noise: &mut Normal, sheet: &Sheet, contrast: Option<f32>) -> Canvas {
    let mut canvas = Canvas::new(sheet, 0.24);
    let bays = (sheet.width_m / BAY_M) as usize + 1;
    for bay in 0..bays {
        let u = BAY_M * bay as f32;
        match (4.0 * noise.uniform()) as usize {
            0 => gate(&mut canvas, noise, u),
            1 | 2 => rack(&mut canvas, noise, u),
            _ => sheet_metal(&mut canvas, noise, u),
        }
        let pane = Area {
            u: u + 0.5,
            v: 0.62 * sheet.height_m,
            width: BAY_M - 1.0,
            height: 0.2 * sheet.height_m,
        };
        let sky = between(noise, 0.55, 0.9);
        canvas.paint(pane, |x, y, _| {
            let bar = (x * 6.0) - libm::floorf(x * 6.0) < 0.08 || (y - 0.5).abs() < 0.04;
            if bar { 0.2 } else { sky }
        });
        let column = Area {
            u: u - 0.15,
            width: 0.3,
            ..sheet.area()
        };
        canvas.fill(column, 0.07);
    }
    canvas.weather(noise, contrast.unwrap_or(0.1));
    canvas
}

/// A dark roof on trusses, with skylights and rows of lamps.
pub fn roof(noise: &mut Normal, sheet: &Sheet, contrast: Option<f32>) -> Canvas {
    let mut canvas = Canvas::new(sheet, 0.1);
    let [bays, rows] = [sheet.width_m, sheet.height_m].map(|m| (m / BAY_M) as usize + 1);
    for (bay, row) in (0..bays).flat_map(|bay| (0..rows).map(move |row| (bay, row))) {
        let (u, v) = (BAY_M * bay as f32, BAY_M * row as f32);
        let skylight = Area {
            u: u + 1.2,
            v: v + 1.4,
            width: 2.6,
            height: 1.4,
        };
        if row % 2 == 0 {
            canvas.fill(skylight, between(noise, 0.6, 0.9));
        } else {
            let lamp = Area {
                width: 0.5,
                height: 0.5,
                u: u + 2.3,
                ..skylight
            };
            canvas.fill(lamp, 0.9);
        }
    }
    for truss in 0..=bays {
        let at = BAY_M * truss as f32;
        canvas.fill(
            Area {
                u: at - 0.15,
                width: 0.3,
                ..sheet.area()
            },
            0.04,
        );
    }
    for purlin in 0..2 * rows {
        let at = 0.5 * BAY_M * purlin as f32;
        canvas.fill(
            Area {
                v: at - 0.06,
                height: 0.12,
                ..sheet.area()
            },
            0.05,
        );
    }
    canvas.weather(noise, contrast.unwrap_or(0.08));
    canvas
}

/// A greenhouse's wall: panes in bars, behind them a hedge and trees under a bright sky.
pub fn glass_wall(noise: &mut Normal, sheet: &Sheet, contrast: Option<f32>) -> Canvas {
    let mut canvas = Canvas::new(sheet, 0.62);
    let hedge = Area {
        height: between(noise, 0.9, 1.4),
        ..sheet.area()
    };
    canvas.fill(hedge, 0.16);
    let trees = (sheet.width_m / 4.0) as usize + 1;
    for _ in 0..trees {
        let width = between(noise, 1.5, 4.0);
        let crown = Area {
            u: between(noise, -0.5 * width, sheet.width_m - 0.5 * width),
            v: between(noise, 0.3, 1.2),
            width,
            height: between(noise, 1.2, 2.4),
        };
        canvas.fill_ellipse(crown, between(noise, 0.12, 0.3));
    }
    canvas.weather(noise, contrast.unwrap_or(0.16));
    canvas.fill(
        Area {
            height: 0.5,
            ..sheet.area()
        },
        0.3,
    );
    bars(&mut canvas, sheet, 0.5);
    canvas
}

/// A greenhouse's roof: panes in bars, some of them open or shaded.
pub fn glass_roof(noise: &mut Normal, sheet: &Sheet, contrast: Option<f32>) -> Canvas {
    let mut canvas = Canvas::new(sheet, 0.72);
    let [columns, rows] = [sheet.width_m, sheet.height_m].map(|m| (m / PANE_M) as usize + 1);
    for (column, row) in (0..columns).flat_map(|column| (0..rows).map(move |row| (column, row))) {
        let pane = Area {
            u: PANE_M * column as f32,
            v: PANE_M * row as f32,
            width: PANE_M,
            height: PANE_M,
        };
        if noise.uniform() < 0.12 {
            canvas.fill(pane, between(noise, 0.35, 0.55));
        }
    }
    canvas.weather(noise, contrast.unwrap_or(0.1));
    bars(&mut canvas, sheet, 0.3);
    canvas
}

/// Bars every pane: upright or lengthwise thick, across thin; none below `from_m`.
fn bars(canvas: &mut Canvas, sheet: &Sheet, from_m: f32) {
    let [columns, rows] = [sheet.width_m, sheet.height_m].map(|m| (m / PANE_M) as usize + 1);
    for column in 0..=columns {
        let width = if column % 4 == 0 { 0.2 } else { 0.07 };
        let u = PANE_M * column as f32 - 0.5 * width;
        canvas.fill(
            Area {
                u,
                width,
                ..sheet.area()
            },
            0.3,
        );
    }
    for row in 0..=rows {
        let v = from_m + PANE_M * row as f32;
        canvas.fill(
            Area {
                v,
                height: 0.07,
                ..sheet.area()
            },
            0.28,
        );
    }
}

/// A roller gate with slats and a number over it.
fn gate(canvas: &mut Canvas, noise: &mut Normal, u: f32) {
    let leaf = Area {
        u: u + 0.6,
        v: 0.0,
        width: 3.8,
        height: 4.0,
    };
    let grey = between(noise, 0.1, 0.5);
    canvas.paint(leaf, |_, y, _| {
        if ((16.0 * y) as usize).is_multiple_of(2) {
            grey
        } else {
            0.8 * grey
        }
    });
    let sign = Area {
        u: u + 2.1,
        v: 4.2,
        width: 0.8,
        height: 0.6,
    };
    canvas.fill(sign, 0.8);
}

/// A rack of goods four boards high.
fn rack(canvas: &mut Canvas, noise: &mut Normal, u: f32) {
    for board in 0..3 {
        let v = 0.1 + 1.4 * board as f32;
        let mut at = u + 0.4;
        while at < u + 4.2 {
            let goods = Area {
                u: at,
                v,
                width: between(noise, 0.5, 1.1),
                height: between(noise, 0.4, 1.2),
            };
            canvas.fill(goods, between(noise, 0.06, 0.6));
            at += goods.width + between(noise, 0.02, 0.3);
        }
        let shelf = Area {
            u: u + 0.3,
            v: v - 0.1,
            width: 4.4,
            height: 0.1,
        };
        canvas.fill(shelf, 0.35);
    }
}

/// Trapezoidal sheet metal with a stripe of paint.
fn sheet_metal(canvas: &mut Canvas, noise: &mut Normal, u: f32) {
    let area = Area {
        u: u + 0.2,
        v: 0.0,
        width: BAY_M - 0.4,
        height: 4.4,
    };
    let (metal, paint) = (between(noise, 0.2, 0.35), between(noise, 0.06, 0.5));
    canvas.paint(area, |x, y, _| {
        let shade = if ((24.0 * x) as usize).is_multiple_of(2) {
            1.0
        } else {
            0.85
        };
        shade
            * if (0.2..0.4).contains(&y) {
                paint
            } else {
                metal
            }
    });
}
