//! The Gaussian filter, moved down so that it ends at zero: f(x) = max(0, g(x) − g(r)) along each
//! axis, where g(x) = exp(−x² / 2σ²) / √(2πσ²) [Pharr 2023 §8.8].

use std::f32::consts::TAU;

use math::Vec2;

/// A Gaussian filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussianFilter {
    /// Half width and half height in pixels.
    pub radius: Vec2,
    /// Standard deviation in pixels.
    pub sigma: f32,
}

impl GaussianFilter {
    pub(super) fn evaluate(&self, p: Vec2) -> f32 {
        let axis = |x, radius| (self.gaussian(x) - self.gaussian(radius)).max(0.0);
        axis(p.x, self.radius.x) * axis(p.y, self.radius.y)
    }

    fn gaussian(&self, x: f32) -> f32 {
        let variance = self.sigma * self.sigma;
        lanes::exp(-x * x / (2.0 * variance)) / (TAU * variance).sqrt()
    }
}
