//! The triangle filter: f(x) = max(0, r − |x|) along each axis. Its samples follow it, their
//! weights are one.

use math::Vec2;
use sampling::warp::sample_tent;

use super::FilterSample;

/// A triangle filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleFilter {
    /// Half width and half height in pixels.
    pub radius: Vec2,
}

impl TriangleFilter {
    pub(super) fn evaluate(&self, p: Vec2) -> f32 {
        (self.radius - p.abs()).max(Vec2::ZERO).element_product()
    }

    pub(super) fn sample(&self, u: Vec2) -> FilterSample {
        let offset = Vec2::new(sample_tent(u.x, self.radius.x), sample_tent(u.y, self.radius.y));
        FilterSample { offset, weight: 1.0 }
    }

    pub(super) fn integral(&self) -> f32 {
        (self.radius * self.radius).element_product()
    }
}
