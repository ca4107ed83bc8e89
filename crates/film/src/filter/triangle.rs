//! The triangle filter: f(x) = max(0, r − |x|) along each axis. Its samples follow it, their
//! weights are one.

use lanes::Real;
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

    #[inline(always)]
    pub(super) fn sample<R: Real>(&self, u: Vec2<R>) -> FilterSample<R> {
        let radius = Vec2::<R>::broadcast(self.radius);
        let offset = Vec2::new(sample_tent(u.x, radius.x), sample_tent(u.y, radius.y));
        FilterSample { offset, weight: R::one() }
    }

    pub(super) fn integral(&self) -> f32 {
        (self.radius * self.radius).element_product()
    }
}
