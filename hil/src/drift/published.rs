//! What the firmware's own filter core made of the same flight and sensors, and whether ours agrees.

use core::f64::consts::PI;

use serde::Serialize;

use super::Row;

/// One row of the reference: RMS errors of the C core, crazyflie-firmware 2a18fc29, on the same flight with the same
/// sensor model. Cross-track over 200 seeds, the others over 50.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Published {
    /// Length of the leg, metres.
    pub distance_m: f64,
    /// Across the leg, metres.
    pub cross_rms_m: f64,
    /// Along it, metres.
    pub along_rms_m: f64,
    /// Of the heading, radians.
    pub yaw_rms_rad: f64,
    /// How far off the cross-track figure may be, as a share of it.
    #[serde(skip)]
    pub cross_tolerance: f64,
}

/// How far off a figure may be, as a share of it: the reference's own seeds leave a standard error of 5 to 10 %.
pub const TOLERANCE: f64 = 0.25;

const fn row(distance_m: f64, cross_m: f64, along_m: f64, yaw_deg: f64) -> Published {
    Published {
        distance_m,
        cross_rms_m: cross_m,
        along_rms_m: along_m,
        yaw_rms_rad: yaw_deg * PI / 180.0,
        cross_tolerance: TOLERANCE,
    }
}

/// The reference, by distance.
pub const PUBLISHED: [Published; 5] = [
    row(1.0, 0.036, 0.058, 0.85),
    row(2.0, 0.060, 0.102, 1.0),
    Published {
        // The paper's own odometry experiment: 13 cm, here to 2 cm.
        cross_rms_m: 0.13,
        cross_tolerance: 0.02 / 0.13,
        ..row(5.0, 0.132, 0.258, 1.5)
    },
    row(10.0, 0.305, 0.507, 2.4),
    row(20.0, 1.01, 1.04, 4.6),
];

impl Published {
    /// The reference at a distance, if there is one.
    pub fn at(distance_m: f64) -> Option<&'static Self> {
        PUBLISHED
            .iter()
            .find(|published| (published.distance_m - distance_m).abs() < 1e-9)
    }

    /// Whether a row agrees: every figure within its tolerance, or within three standard errors of an RMS over so
    /// few seeds.
    pub fn agrees(&self, row: &Row) -> bool {
        let chance = 3.0 / (2.0 * row.seeds as f64).sqrt();
        let near = |found: f64, expected: f64, tolerance: f64| {
            (found / expected - 1.0).abs() <= tolerance.max(chance)
        };
        near(row.cross_rms_m, self.cross_rms_m, self.cross_tolerance)
            && near(row.along_rms_m, self.along_rms_m, TOLERANCE)
            && near(row.yaw_rms_rad, self.yaw_rms_rad, TOLERANCE)
    }
}

/// Whether every row that has a reference agrees with it.
pub fn verdict(rows: &[Row]) -> bool {
    rows.iter()
        .all(|row| Published::at(row.distance_m).is_none_or(|published| published.agrees(row)))
}
