//! Pictures of rooms that people work in: walls, windows, doors, ceilings.

use super::between;
use super::canvas::{Area, Canvas, Sheet};
use crate::random::Normal;

/// Reflectance of a painted wall.
const PLASTER: f32 = 0.42;
/// Reflectance of a suspended ceiling.
const CEILING: f32 = 0.45;
/// A lamp behind its diffuser, as bright as a canvas can be.
const DIFFUSER: f32 = 0.9;

/// A bare wall, with a skirting and hardly a stain.
pub fn plaster(noise: &mut Normal, sheet: &Sheet, contrast: Option<f32>) -> Canvas {
    let mut canvas = Canvas::new(sheet, PLASTER);
    skirting(&mut canvas, sheet);
    canvas.weather(noise, contrast.unwrap_or(0.03));
    canvas
}

/// A corridor's wall: doors at uneven distances, with frames, panes, name plates and notices.
pub fn doors(noise: &mut Normal, sheet: &Sheet, contrast: Option<f32>) -> Canvas {
    let mut canvas = plaster(noise, sheet, Some(0.02));
    let mut u = between(noise, 0.3, 1.5);
    while u + 1.2 < sheet.width_m {
        door(&mut canvas, noise, u);
        if noise.uniform() < 0.7 {
            notices(&mut canvas, noise, u + 1.3);
        }
        u += between(noise, 2.2, 4.4);
    }
    canvas.weather(noise, contrast.unwrap_or(0.06));
    canvas
}

/// An office's inner wall: a door, shelves with books, posters and a white board.
pub fn office_wall(noise: &mut Normal, sheet: &Sheet, contrast: Option<f32>) -> Canvas {
    let mut canvas = plaster(noise, sheet, Some(0.02));
    let mut u = between(noise, 0.2, 0.8);
    let mut turn = (4.0 * noise.uniform()) as usize;
    while u + 2.4 < sheet.width_m {
        match turn % 4 {
            0 => door(&mut canvas, noise, u + 0.4),
            1 => bookshelf(&mut canvas, noise, u),
            2 => white_board(&mut canvas, noise, u),
            _ => posters(&mut canvas, noise, u),
        }
        u += between(noise, 2.3, 2.9);
        turn += 1;
    }
    canvas.weather(noise, contrast.unwrap_or(0.06));
    canvas
}

/// Windows from 0.9 m up, with a view of roofs under the sky, half of them with blinds.
pub fn windows(noise: &mut Normal, sheet: &Sheet, contrast: Option<f32>) -> Canvas {
    let mut canvas = plaster(noise, sheet, Some(0.02));
    let (sill, lintel) = (0.9, (0.88 * sheet.height_m).max(1.2));
    let mut u = 0.4;
    while u + 1.6 < sheet.width_m {
        let frame = Area {
            u,
            v: sill,
            width: between(noise, 1.3, 1.7),
            height: lintel - sill,
        };
        view(&mut canvas, noise, frame);
        let radiator = Area {
            v: 0.15,
            height: 0.55,
            ..frame
        };
        canvas.paint(radiator, |x, _, _| {
            if ((14.0 * x) as usize).is_multiple_of(2) {
                0.5
            } else {
                0.33
            }
        });
        u += frame.width + between(noise, 0.25, 0.6);
    }
    canvas.weather(noise, contrast.unwrap_or(0.04));
    canvas
}

/// A suspended ceiling: a grid of 0.6 m with lamps two fields long.
pub fn office_ceiling(noise: &mut Normal, sheet: &Sheet, contrast: Option<f32>) -> Canvas {
    const FIELD_M: f32 = 0.6;
    let mut canvas = Canvas::new(sheet, CEILING);
    let [columns, rows] = [sheet.width_m, sheet.height_m].map(|m| (m / FIELD_M) as usize);
    for line in 1..=columns.max(rows) {
        let at = FIELD_M * line as f32 - 0.02;
        canvas.fill(
            Area {
                u: at,
                width: 0.04,
                ..sheet.area()
            },
            0.3,
        );
        canvas.fill(
            Area {
                v: at,
                height: 0.04,
                ..sheet.area()
            },
            0.3,
        );
    }
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let lamp = Area {
            u: FIELD_M * column as f32 + 0.03,
            v: FIELD_M * row as f32 + 0.03,
            width: FIELD_M - 0.06,
            height: 2.0 * FIELD_M - 0.06,
        };
        if row % 5 == 1 && column % 4 == 1 && row + 2 <= rows && noise.uniform() < 0.9 {
            canvas.fill(lamp, DIFFUSER);
        }
    }
    canvas.weather(noise, contrast.unwrap_or(0.02));
    canvas
}

/// A ceiling with one row of long lamps along its longer side.
pub fn corridor_ceiling(noise: &mut Normal, sheet: &Sheet, contrast: Option<f32>) -> Canvas {
    const PITCH_M: f32 = 2.8;
    let mut canvas = Canvas::new(sheet, CEILING);
    let along_u = sheet.width_m > sheet.height_m;
    let length_m = sheet.width_m.max(sheet.height_m);
    let middle_m = 0.5 * sheet.width_m.min(sheet.height_m);
    for lamp in 0..(length_m / PITCH_M) as usize {
        let along = PITCH_M * (lamp as f32 + 0.5) - 0.6;
        let (u, v, width, height) = if along_u {
            (along, middle_m - 0.08, 1.2, 0.16)
        } else {
            (middle_m - 0.08, along, 0.16, 1.2)
        };
        let area = Area {
            u,
            v,
            width,
            height,
        };
        // One tube in eight is dark.
        canvas.fill(
            area,
            if noise.uniform() < 0.875 {
                DIFFUSER
            } else {
                0.3
            },
        );
    }
    canvas.weather(noise, contrast.unwrap_or(0.03));
    canvas
}

fn skirting(canvas: &mut Canvas, sheet: &Sheet) {
    canvas.fill(
        Area {
            height: 0.1,
            ..sheet.area()
        },
        0.15,
    );
}

/// A door in its frame, 0.9 m wide, with a handle and sometimes a pane.
fn door(canvas: &mut Canvas, noise: &mut Normal, u: f32) {
    let leaf = Area {
        u: u + 0.1,
        v: 0.0,
        width: 0.9,
        height: 2.1,
    };
    let frame = Area {
        u,
        width: 1.1,
        height: 2.2,
        ..leaf
    };
    let grey = between(noise, 0.06, 0.3);
    canvas.fill(frame, 0.6 * grey);
    canvas.fill(leaf, grey);
    if noise.uniform() < 0.4 {
        let pane = Area {
            u: leaf.u + 0.2,
            v: 1.1,
            width: 0.5,
            height: 0.8,
        };
        canvas.fill(pane, between(noise, 0.5, 0.8));
    }
    let handle = Area {
        u: leaf.u + 0.78,
        v: 1.0,
        width: 0.06,
        height: 0.16,
    };
    let plate = Area {
        u: u + 1.15,
        v: 1.5,
        width: 0.2,
        height: 0.14,
    };
    canvas.fill(handle, 0.7);
    canvas.fill(plate, 0.75);
}

/// One to four sheets of paper beside each other.
fn notices(canvas: &mut Canvas, noise: &mut Normal, u: f32) {
    let count = 1 + (4.0 * noise.uniform()) as usize;
    for sheet in 0..count {
        let area = Area {
            u: u + 0.27 * sheet as f32,
            v: between(noise, 1.3, 1.5),
            width: 0.21,
            height: 0.3,
        };
        let ink = between(noise, 0.35, 0.75);
        canvas.paint(area, |x, y, _| {
            let text = (9.0 * y) as usize % 2 == 1 && (0.15..0.85).contains(&x);
            if text { 0.6 * ink } else { ink }
        });
    }
}

/// A shelf as tall as a door, full of books.
fn bookshelf(canvas: &mut Canvas, noise: &mut Normal, u: f32) {
    let case = Area {
        u,
        v: 0.0,
        width: 1.9,
        height: 2.1,
    };
    canvas.fill(case, 0.12);
    for board in 0..6 {
        let v = 0.06 + 0.34 * board as f32;
        let mut at = u + 0.04;
        while at < u + 1.8 {
            let book = Area {
                u: at,
                v,
                width: between(noise, 0.03, 0.09),
                height: between(noise, 0.2, 0.29),
            };
            canvas.fill(book, between(noise, 0.04, 0.6));
            at += book.width + if noise.uniform() < 0.08 { 0.2 } else { 0.005 };
        }
    }
}

/// A white board with some writing.
fn white_board(canvas: &mut Canvas, noise: &mut Normal, u: f32) {
    let board = Area {
        u,
        v: 0.9,
        width: 2.0,
        height: 1.2,
    };
    canvas.fill(board, 0.2);
    let white = Area {
        u: u + 0.03,
        v: 0.93,
        width: 1.94,
        height: 1.14,
    };
    canvas.fill(white, 0.72);
    for line in 0..6 {
        let text = Area {
            u: u + between(noise, 0.1, 0.4),
            v: 1.05 + 0.16 * line as f32,
            width: between(noise, 0.3, 1.3),
            height: 0.05,
        };
        canvas.paint(text, |x, _, old| {
            if ((23.0 * x) as usize).is_multiple_of(3) {
                old
            } else {
                0.25
            }
        });
    }
}

/// Two or three posters.
fn posters(canvas: &mut Canvas, noise: &mut Normal, u: f32) {
    let mut at = u;
    for _ in 0..2 {
        let poster = Area {
            u: at,
            v: between(noise, 0.9, 1.2),
            width: between(noise, 0.6, 0.9),
            height: between(noise, 0.8, 1.15),
        };
        let (ground, figure) = (between(noise, 0.1, 0.7), between(noise, 0.05, 0.7));
        canvas.fill(poster, ground);
        let inner = Area {
            u: poster.u + 0.15 * poster.width,
            v: poster.v + between(noise, 0.15, 0.4) * poster.height,
            width: 0.7 * poster.width,
            height: 0.4 * poster.height,
        };
        if noise.uniform() < 0.5 {
            canvas.fill_ellipse(inner, figure);
        } else {
            canvas.fill(inner, figure);
        }
        at += poster.width + between(noise, 0.15, 0.4);
    }
}

/// A window with its bars: sky over a skyline, or a blind.
fn view(canvas: &mut Canvas, noise: &mut Normal, frame: Area) {
    let skyline = between(noise, 0.15, 0.4);
    let town = between(noise, 0.2, 0.4);
    let blind = if noise.uniform() < 0.5 {
        between(noise, 0.3, 0.9)
    } else {
        1.0
    };
    let steps = between(noise, 2.0, 5.0);
    canvas.paint(frame, |x, y, _| {
        let bar =
            !(0.04..=0.96).contains(&x) || !(0.04..=0.96).contains(&y) || (x - 0.5).abs() < 0.02;
        let roof = skyline + 0.08 * ((steps * x) as usize % 2) as f32;
        if bar {
            0.5
        } else if y > blind {
            if ((40.0 * y) as usize).is_multiple_of(2) {
                0.55
            } else {
                0.4
            }
        } else if y > roof {
            0.9
        } else {
            town
        }
    });
}
