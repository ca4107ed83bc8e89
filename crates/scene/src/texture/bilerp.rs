//! Four corner values, interpolated over the unit square:
//! (1 − s)(1 − t)·v₀₀ + (1 − s)t·v₀₁ + s(1 − t)·v₁₀ + st·v₁₁.
//!
//! Outside of the square the same formula extrapolates. Source: [Pharr 2023 §10.3.2].

use lanes::Real;
use math::Point2;

/// The weights of the values at (0, 0), (0, 1), (1, 0), (1, 1) at the point `st`; they sum to one.
#[inline(always)]
pub(super) fn weights<R: Real>(st: Point2<R>) -> [R; 4] {
    let (s, t, one) = (st.x, st.y, R::one());
    [(one - s) * (one - t), (one - s) * t, s * (one - t), s * t]
}
