//! Boxes and references to primitives.

#![allow(unsafe_code)]

use super::pages::Zeroable;
use math::{Bounds3, Vec3, Vec4};
use rayon::prelude::*;

/// A box as (low, −high), so that a union is two minima. The lanes w are unused here; a
/// [`Reference`] keeps its ids in them.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct Extent {
    low: Vec4,
    minus_high: Vec4,
}

impl Extent {
    /// The empty box.
    pub const EMPTY: Self = Self { low: Vec4::INFINITY, minus_high: Vec4::INFINITY };

    /// The box around one point.
    #[inline]
    pub fn point(p: Vec4) -> Self {
        Self { low: p, minus_high: -p }
    }

    /// The smallest box around both.
    #[inline]
    pub fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), minus_high: self.minus_high.min(other.minus_high) }
    }

    /// The box around three points, unless one of them is not finite.
    #[inline(always)]
    pub fn around_finite(points: [Vec3; 3]) -> Option<Self> {
        let [a, b, c] = points.map(|p| p.extend(0.0));
        let nothing = a * 0.0 + b * 0.0 + c * 0.0;
        let extent = Self { low: a.min(b).min(c), minus_high: -a.max(b).max(c) };
        (nothing == Vec4::ZERO).then_some(extent)
    }

    /// The intersection of both.
    #[inline]
    pub fn intersection(self, other: Self) -> Self {
        Self { low: self.low.max(other.low), minus_high: self.minus_high.max(other.minus_high) }
    }

    /// The part below a plane perpendicular to an axis.
    pub fn below(mut self, axis: usize, at: f32) -> Self {
        self.minus_high[axis] = self.minus_high[axis].max(-at);
        self
    }

    /// The part above it.
    pub fn above(mut self, axis: usize, at: f32) -> Self {
        self.low[axis] = self.low[axis].max(at);
        self
    }

    pub fn is_empty(&self) -> bool {
        self.low.truncate().cmpgt(self.high().truncate()).any()
    }

    /// [`Extent::union`] with a box that may be empty with finite ends.
    #[inline]
    pub fn union_unless_empty(self, other: Self) -> Self {
        if other.is_empty() { self } else { self.union(other) }
    }

    /// Half of the surface area of the intersection.
    pub fn overlap(&self, other: &Self) -> f32 {
        let shared = self.intersection(*other);
        if shared.is_empty() { 0.0 } else { shared.half_area() }
    }

    /// The box around all references.
    pub fn around(references: &[Reference]) -> Self {
        let serial = |part: &[Reference]| part.iter().fold(Self::EMPTY, |all, r| all.union(r.extent()));
        in_parts(references, serial, Self::union)
    }

    /// The lower ends along all axes.
    #[inline]
    pub fn low(&self) -> Vec4 {
        self.low
    }

    /// The upper ends along all axes.
    #[inline]
    pub fn high(&self) -> Vec4 {
        -self.minus_high
    }

    /// Twice the centroid; infinite where that is too large for floats.
    #[inline]
    pub fn doubled_centroid(&self) -> Vec4 {
        self.low - self.minus_high
    }

    /// All coordinates doubled.
    pub fn doubled(&self) -> Self {
        Self { low: self.low * 2.0, minus_high: self.minus_high * 2.0 }
    }

    /// Half of the surface area; NaN or infinite for the empty box.
    #[inline]
    pub fn half_area(&self) -> f32 {
        let d = self.high() - self.low;
        d.x * (d.y + d.z) + d.y * d.z
    }

    pub fn bounds(&self) -> Bounds3 {
        Bounds3 { min: self.low.truncate().into(), max: self.high().truncate().into() }
    }
}

impl From<&Bounds3> for Extent {
    #[inline]
    fn from(b: &Bounds3) -> Self {
        Self { low: b.min.extend(0.0), minus_high: (-b.max).extend(0.0) }
    }
}

/// A primitive to be put into a tree: its box and its ids.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reference(Extent);

// SAFETY: all fields are floats.
unsafe impl Zeroable for Reference {}

impl Reference {
    /// [`Reference::primitive`] of an unused reference.
    const UNUSED: u32 = u32::MAX;

    /// An unused reference.
    pub fn none() -> Self {
        Self::new(Extent::EMPTY, Self::UNUSED, Self::UNUSED)
    }

    #[inline]
    pub fn new(extent: Extent, geometry: u32, primitive: u32) -> Self {
        let Extent { mut low, mut minus_high } = extent;
        (low.w, minus_high.w) = (f32::from_bits(geometry), f32::from_bits(primitive));
        Self(Extent { low, minus_high })
    }

    /// A reference to the part of the same primitive in `extent`.
    #[inline]
    pub fn within(&self, extent: Extent) -> Self {
        Self::new(extent, self.geometry(), self.primitive())
    }

    #[inline]
    pub fn extent(&self) -> Extent {
        self.0
    }

    #[inline]
    pub fn geometry(&self) -> u32 {
        self.0.low.w.to_bits()
    }

    #[inline]
    pub fn primitive(&self) -> u32 {
        self.0.minus_high.w.to_bits()
    }

    #[inline]
    pub fn ids(&self) -> Ids {
        [self.geometry(), self.primitive()]
    }

    #[inline]
    pub fn is_none(&self) -> bool {
        self.primitive() == Self::UNUSED
    }
}

/// A primitive by the ids of geometry and primitive.
pub(super) type Ids = [u32; 2];

/// Sets of this size and larger are processed in parallel, in parts of a quarter of this.
pub(super) const PARALLEL_SET: usize = 1 << 16;

/// Folds a set, in parallel where it is large. `merge` must be associative.
pub(super) fn in_parts<T: Send>(
    references: &[Reference],
    serial: impl Fn(&[Reference]) -> T + Sync + Send,
    merge: impl Fn(T, T) -> T + Sync + Send,
) -> T {
    if references.len() < PARALLEL_SET {
        return serial(references);
    }
    references.par_chunks(PARALLEL_SET / 4).map(&serial).reduce_with(merge).unwrap_or_else(|| serial(&[]))
}
