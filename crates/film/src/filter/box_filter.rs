//! The box filter: f(p) = 1 within the radius. Its samples are uniform, their weights one.

use lanes::Real;
use math::{Bounds2, Vec2};

use super::FilterSample;

/// A box filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxFilter {
    /// Half width and half height in pixels.
    pub radius: Vec2,
}

impl BoxFilter {
    pub(super) fn evaluate(&self, p: Vec2) -> f32 {
        if p.abs().cmple(self.radius).all() { 1.0 } else { 0.0 }
    }

    #[inline(always)]
    pub(super) fn sample<R: Real>(&self, u: Vec2<R>) -> FilterSample<R> {
        FilterSample { offset: Bounds2::new(-self.radius, self.radius).lerp(u), weight: R::one() }
    }

    pub(super) fn integral(&self) -> f32 {
        4.0 * self.radius.x * self.radius.y
    }
}
