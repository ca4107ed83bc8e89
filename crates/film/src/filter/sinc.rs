//! The windowed sinc of Lanczos: f(x) = sinc(x) · sinc(x/τ) within the radius along each axis,
//! sinc(x) = sin(πx) / πx [Pharr 2023 §8.8]. The ideal filter of band-limited images, cut off
//! softly; its negative lobes ring at hard edges.

use std::f32::consts::PI;

use math::Vec2;

/// A windowed sinc filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LanczosSincFilter {
    /// Half width and half height in pixels.
    pub radius: Vec2,
    /// The width of the window: its sinc has its first zero at τ pixels.
    pub tau: f32,
}

impl LanczosSincFilter {
    pub(super) fn evaluate(&self, p: Vec2) -> f32 {
        if p.abs().cmpgt(self.radius).any() {
            return 0.0;
        }
        let axis = |x: f32| sinc(x) * sinc(x / self.tau);
        axis(p.x) * axis(p.y)
    }
}

fn sinc(x: f32) -> f32 {
    let x = PI * x;
    // Below this, sin(x) / x rounds to one.
    if x.abs() < 1e-4 { 1.0 } else { lanes::sin(x) / x }
}
