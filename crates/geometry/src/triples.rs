//! Vectors in arrays, of which lanes gather some.

#![allow(unsafe_code)]

use lanes::Real;
use math::{Vec3, Vector3};

/// The coordinates of vectors, one after another.
#[inline(always)]
pub(crate) fn triples(vectors: &[Vec3]) -> &[f32] {
    // SAFETY: a vector is three floats, in order and without padding (`repr(C)`).
    unsafe { std::slice::from_raw_parts(vectors.as_ptr().cast(), 3 * vectors.len()) }
}

/// The vectors whose first coordinates are at some places.
#[inline(always)]
pub(crate) fn vector<R: Real>(numbers: &[f32], x: R::Int) -> Vector3<R> {
    Vec3::from_array(R::gather_rows::<3>(numbers, x))
}
