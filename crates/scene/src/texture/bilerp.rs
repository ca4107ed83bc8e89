//! Four corner values, interpolated over the unit square:
//! (1 − s)(1 − t)·v₀₀ + (1 − s)t·v₀₁ + s(1 − t)·v₁₀ + st·v₁₁.
//!
//! Outside of the square the same formula extrapolates. Source: [Pharr 2023 §10.3.2].

use math::Point2;

/// The weights of the values at (0, 0), (0, 1), (1, 0), (1, 1) at the point `st`; they sum to one.
pub(super) fn weights(st: Point2) -> [f32; 4] {
    let (s, t) = (st.x, st.y);
    [(1.0 - s) * (1.0 - t), (1.0 - s) * t, s * (1.0 - t), s * t]
}
