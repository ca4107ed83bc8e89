//! Transforms that may move while the shutter is open.

use math::{DMat4, DVec3};

/// A transform at the start and at the end of a time range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransformDesc {
    /// The transform at `times[0]`.
    pub start: DMat4,
    /// The transform at `times[1]`.
    pub end: DMat4,
    /// The two times; the transform is constant before and after them.
    pub times: [f32; 2],
}

impl Default for TransformDesc {
    fn default() -> Self {
        Self::fixed(DMat4::IDENTITY)
    }
}

impl TransformDesc {
    /// A transform that does not move.
    pub fn fixed(matrix: DMat4) -> Self {
        Self { start: matrix, end: matrix, times: [0.0, 1.0] }
    }

    /// A fixed translation.
    pub fn translation(x: f64, y: f64, z: f64) -> Self {
        Self::fixed(DMat4::from_translation(DVec3::new(x, y, z)))
    }

    /// Whether anything moves.
    pub fn is_animated(&self) -> bool {
        self.start != self.end
    }

    /// The inverse transform, at both times.
    pub fn inverse(&self) -> Self {
        Self { start: self.start.inverse(), end: self.end.inverse(), times: self.times }
    }
}
