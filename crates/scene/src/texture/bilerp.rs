//! Four corner values, interpolated over the unit square: (1 − s)(1 − t)·v₀₀ + (1 − s)t·v₀₁ + s(1 −
//! t)·v₁₀ + st·v₁₁.
//!
//! Beyond the square the same formula goes on. Source: [Pharr 2023 §10.3.2].

use super::{Mapping2d, TextureContext};

/// A bilinear texture of constants `C`.
#[derive(Clone, Debug)]
pub struct Bilerp<C> {
    /// Values at (s, t) = (0, 0), (0, 1), (1, 0), (1, 1).
    pub corners: [C; 4],
    /// Where on the square a point lies.
    pub mapping: Mapping2d,
}

impl<C> Bilerp<C> {
    /// The corners' weights at a point; they sum to one.
    pub fn weights(&self, ctx: &TextureContext) -> [f32; 4] {
        let st = self.mapping.map(ctx).st;
        let (s, t) = (st.x, st.y);
        [(1.0 - s) * (1.0 - t), (1.0 - s) * t, s * (1.0 - t), s * t]
    }
}
