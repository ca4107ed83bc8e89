//! Rectangles on the plane z = 1, seen from the origin.

use math::{Bounds2, Vec2};

/// A rectangle on the plane z = 1, its lowest and its highest corner.
#[derive(Clone, Copy, Debug)]
pub(super) struct Screen {
    min: [f64; 2],
    max: [f64; 2],
}

impl Screen {
    /// The rectangle of these bounds.
    pub fn new(bounds: Bounds2) -> Self {
        let [min, max] = [bounds.min, bounds.max].map(|p: Vec2| p.as_dvec2().to_array());
        Self { min, max }
    }

    /// The rectangle between angles about the y and the x axis, in −π/2 … π/2.
    pub fn between_angles(min: [f64; 2], max: [f64; 2]) -> Self {
        Self { min: min.map(libm::tan), max: max.map(libm::tan) }
    }

    /// Its solid angle, ∫ cos³θ dA.
    pub fn solid_angle(&self) -> f64 {
        self.integral(|x, y| libm::atan(x * y / (1.0 + x * x + y * y).sqrt()))
    }

    /// Its solid angle weighted by the cosine with z, ∫ cos⁴θ dA.
    pub fn projected_solid_angle(&self) -> f64 {
        let term = |x: f64, y: f64| {
            let root = (1.0 + x * x).sqrt();
            x / root * libm::atan(y / root)
        };
        self.integral(|x, y| 0.5 * (term(x, y) + term(y, x)))
    }

    /// From the integral between the axes and a corner.
    fn integral(&self, corner: impl Fn(f64, f64) -> f64) -> f64 {
        let ([x0, y0], [x1, y1]) = (self.min, self.max);
        corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI};

    #[test]
    fn solid_angles_of_a_half_space_and_of_the_side_of_a_cube() {
        let half = Screen::between_angles([-FRAC_PI_2; 2], [FRAC_PI_2; 2]);
        assert!((half.solid_angle() - 2.0 * PI).abs() < 1e-9);
        assert!((half.projected_solid_angle() - PI).abs() < 1e-9);
        let side = Screen::new(Bounds2::new(Vec2::splat(-1.0), Vec2::ONE));
        assert!((side.solid_angle() - 4.0 * PI / 6.0).abs() < 1e-9);
    }

    #[test]
    fn they_are_sums_over_their_parts() {
        let (min, max) = ([-0.7, 0.2], [FRAC_PI_2, FRAC_PI_3]);
        let whole = Screen::between_angles(min, max);
        let (count, mut sums) = (200, [0.0; 2]);
        for i in 0..count * count {
            let at = |i: u32, axis: usize| {
                min[axis] + (f64::from(i) + 0.5) / f64::from(count) * (max[axis] - min[axis])
            };
            let [x, y] = [at(i % count, 0), at(i / count, 1)].map(libm::tan);
            // dA = (1 + x²)(1 + y²) dα dβ.
            let r2 = 1.0 + x * x + y * y;
            let area = (1.0 + x * x) * (1.0 + y * y);
            sums[0] += area * r2.powf(-1.5);
            sums[1] += area * r2.powi(-2);
        }
        let cell = (max[0] - min[0]) * (max[1] - min[1]) / f64::from(count * count);
        assert!((whole.solid_angle() / (sums[0] * cell) - 1.0).abs() < 1e-4);
        assert!((whole.projected_solid_angle() / (sums[1] * cell) - 1.0).abs() < 1e-4);
    }
}
