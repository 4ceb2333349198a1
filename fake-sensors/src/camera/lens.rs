//! The panoramic optic: which direction each pixel of the annulus looks in.
//!
//! A mirror folds the whole horizon into a ring. The maker's own software unrolls it linearly in
//! radius, and so does this model (Kogeto Dot 360: ratio of inner to outer radius 0.41..0.53,
//! inner edge up). The vertical field of view is unpublished; 90 degrees is a user's estimate.

use core::f32::consts::{FRAC_PI_2, FRAC_PI_4};

use super::{HEIGHT, WIDTH};

/// The sense in which bearing grows round the image as it is displayed (x right, y down).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// As a clock's hands.
    Clockwise,
    /// Against a clock's hands.
    CounterClockwise,
}

impl Direction {
    /// The sign of the image angle, which runs from x (right) to y (down): clockwise.
    fn sign(self) -> f32 {
        match self {
            Self::Clockwise => 1.0,
            Self::CounterClockwise => -1.0,
        }
    }
}

/// A direction in the camera's body frame: x forward, y left, z up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Counter-clockwise from forward, seen from above; radians in [-pi, pi].
    pub bearing_rad: f32,
    /// Above the horizontal plane; radians.
    pub elevation_rad: f32,
}

/// A panoramic lens in front of the image sensor: linear in radius, round, without skew.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PanoramicLens {
    /// Centre of the ring in pixels. Pixel (x, y) covers [x, x+1) x [y, y+1).
    pub centre_px: [f32; 2],
    /// Radius of the ring's inner edge in pixels.
    pub inner_radius_px: f32,
    /// Radius of the ring's outer edge in pixels.
    pub outer_radius_px: f32,
    /// Image angle of bearing 0 (forward), from x (right) towards y (down); radians.
    pub zero_bearing_rad: f32,
    /// The sense in which bearing grows.
    pub direction: Direction,
    /// The inner edge looks up; otherwise the outer edge does.
    pub inner_is_up: bool,
    /// Elevation of the upper edge, and depression of the lower; radians.
    pub half_field_rad: f32,
}

impl Default for PanoramicLens {
    /// A Kogeto-like optic over a camera that looks up, image top forward: 24 pixels for the
    /// vertical field, 188 pixels round the middle of the ring.
    fn default() -> Self {
        Self {
            centre_px: [WIDTH as f32 / 2.0, HEIGHT as f32 / 2.0],
            inner_radius_px: 18.0,
            outer_radius_px: 42.0,
            zero_bearing_rad: -FRAC_PI_2,
            direction: Direction::Clockwise,
            inner_is_up: true,
            half_field_rad: FRAC_PI_4,
        }
    }
}

impl PanoramicLens {
    /// Where in the image a direction appears, in pixels; outside the ring for elevations outside
    /// the field.
    #[must_use]
    pub fn project(&self, view: View) -> [f32; 2] {
        let radius = self.radius_px(view.elevation_rad);
        let angle = self.zero_bearing_rad + self.direction.sign() * view.bearing_rad;
        let (sin, cos) = libm::sincosf(angle);
        let [x, y] = self.centre_px;
        [x + radius * cos, y + radius * sin]
    }

    /// The direction a point of the image looks in; extrapolated linearly outside the ring.
    #[must_use]
    pub fn view(&self, point_px: [f32; 2]) -> View {
        let [dx, dy] = self.offset(point_px);
        let angle = libm::atan2f(dy, dx);
        let (sin, cos) = libm::sincosf(self.direction.sign() * (angle - self.zero_bearing_rad));
        View {
            bearing_rad: libm::atan2f(sin, cos),
            elevation_rad: self.elevation_rad(self.distance_from_centre(point_px)),
        }
    }

    /// Distance of a point of the image from the ring's centre, in pixels.
    #[must_use]
    pub fn distance_from_centre(&self, point_px: [f32; 2]) -> f32 {
        let [dx, dy] = self.offset(point_px);
        (dx * dx + dy * dy).sqrt()
    }

    /// Elevation covered by one pixel along the radius, in radians.
    #[must_use]
    pub fn elevation_per_px(&self) -> f32 {
        2.0 * self.half_field_rad / (self.outer_radius_px - self.inner_radius_px)
    }

    fn offset(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        [x - self.centre_px[0], y - self.centre_px[1]]
    }

    fn elevation_rad(&self, radius_px: f32) -> f32 {
        let middle = 0.5 * (self.inner_radius_px + self.outer_radius_px);
        self.upward() * (radius_px - middle) * self.elevation_per_px()
    }

    fn radius_px(&self, elevation_rad: f32) -> f32 {
        let middle = 0.5 * (self.inner_radius_px + self.outer_radius_px);
        middle + self.upward() * elevation_rad / self.elevation_per_px()
    }

    /// The sign of elevation along the radius.
    fn upward(&self) -> f32 {
        if self.inner_is_up { -1.0 } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::PI;

    fn lenses() -> [PanoramicLens; 2] {
        let other = PanoramicLens {
            centre_px: [62.0, 50.5],
            zero_bearing_rad: 0.7,
            direction: Direction::CounterClockwise,
            inner_is_up: false,
            ..PanoramicLens::default()
        };
        [PanoramicLens::default(), other]
    }

    #[test]
    fn a_direction_comes_back_from_its_pixel() {
        for lens in lenses() {
            for i in -17..=17 {
                for j in -4..=4 {
                    let view = View {
                        bearing_rad: i as f32 * 0.18,
                        elevation_rad: j as f32 * 0.19,
                    };
                    let back = lens.view(lens.project(view));
                    assert!((back.bearing_rad - view.bearing_rad).abs() < 1e-5);
                    assert!((back.elevation_rad - view.elevation_rad).abs() < 1e-5);
                }
            }
        }
    }

    #[test]
    fn the_ring_spans_90_degrees_with_the_inner_edge_up() {
        let lens = PanoramicLens::default();
        let up = lens.view([64.0, 48.0 - 18.0]);
        let down = lens.view([64.0, 48.0 - 42.0]);
        assert!((up.elevation_rad - PI / 4.0).abs() < 1e-6);
        assert!((down.elevation_rad + PI / 4.0).abs() < 1e-6);
    }

    #[test]
    fn forward_is_at_the_top_and_left_is_a_quarter_turn_clockwise() {
        let lens = PanoramicLens::default();
        assert!(lens.view([64.0, 18.0]).bearing_rad.abs() < 1e-6);
        assert!((lens.view([94.0, 48.0]).bearing_rad - PI / 2.0).abs() < 1e-6);
    }
}
