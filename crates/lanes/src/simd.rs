//! What every instruction set offers, and what is computed with it.

use crate::real::{Callee, Kernel, Real};
use std::marker::PhantomData;

/// `N` floats, one in each lane.
pub trait Vector<const N: usize>: Copy {
    /// The same number in all lanes.
    ///
    /// # Safety
    /// The processor must have the instruction set that the vector belongs to.
    unsafe fn splat(x: f32) -> Self;

    /// A number for each lane.
    ///
    /// # Safety
    /// The processor must have the instruction set that the vector belongs to.
    unsafe fn load(from: &[f32; N]) -> Self;

    /// The number in each lane.
    fn store(self) -> [f32; N];

    /// The number in a lane, whose index is below `N`.
    fn lane(self, lane: usize) -> f32;

    /// `self` + b.
    fn add(self, b: Self) -> Self;
    /// `self` − b.
    fn sub(self, b: Self) -> Self;
    /// `self`·b.
    fn mul(self, b: Self) -> Self;
    /// `self` / b.
    fn div(self, b: Self) -> Self;
    /// |`self`|.
    fn abs(self) -> Self;
    /// The smaller of the two; `b` where either is NaN.
    fn min(self, b: Self) -> Self;
    /// The larger of the two; `b` where either is NaN.
    fn max(self, b: Self) -> Self;
    /// The one that is less as a signed integer of the same bits: for numbers that are not NaN the
    /// smaller one, unless both are negative. Faster than [`Self::min`] on many processors.
    fn min_int(self, b: Self) -> Self;
    /// The one that is greater as a signed integer of the same bits: for numbers that are not NaN
    /// the larger one, unless both are negative. Faster than [`Self::max`] on many processors.
    fn max_int(self, b: Self) -> Self;
    /// The one that is less as an unsigned integer of the same bits: for numbers that are not NaN
    /// the smaller magnitude of one sign, where positive numbers precede negative ones.
    fn min_uint(self, b: Self) -> Self;
    /// The one that is greater as an unsigned integer of the same bits: see [`Self::min_uint`].
    fn max_uint(self, b: Self) -> Self;
    /// `self`·b + c, rounded once.
    fn mul_add(self, b: Self, c: Self) -> Self;
    /// c − `self`·b, rounded once.
    fn neg_mul_add(self, b: Self, c: Self) -> Self;
    /// `self`·b − c, rounded once.
    fn mul_sub(self, b: Self, c: Self) -> Self;

    /// `self`·b − c, rounded once or twice, whichever is faster.
    #[inline(always)]
    fn relaxed_mul_sub(self, b: Self, c: Self) -> Self {
        self.mul_sub(b, c)
    }

    /// A bit for each lane where `self` ≤ b; 0 where either is NaN.
    fn le(self, b: Self) -> u32;
    /// A bit for each lane where `self` < b; 0 where either is NaN.
    fn lt(self, b: Self) -> u32;
}

/// An instruction set, as a type.
pub trait Simd: Copy {
    /// Four floats.
    type F32x4: Vector<4>;
    /// Eight floats.
    type F32x8: Vector<8>;
    /// Sixteen floats.
    type F32x16: Vector<16>;
    /// As many floats as a register holds.
    type Real: Real;

    /// The four lanes of `from` whose indices are in byte `BYTE` of each element of `indices`. All
    /// bytes are below 8.
    #[inline(always)]
    fn permute<const BYTE: usize>(from: Self::F32x8, indices: &[u32; 4]) -> Self::F32x4 {
        let from = from.store();
        // SAFETY: `from` is the proof of the instruction set.
        unsafe { Self::F32x4::load(&indices.map(|index| from[(index >> (8 * BYTE)) as usize & 7])) }
    }

    /// The same of two vectors: that of the first in the low half.
    #[inline(always)]
    fn permute_both<const BYTE: usize>(from: [Self::F32x8; 2], indices: [&[u32; 4]; 2]) -> Self::F32x8 {
        let half = |i: usize| Self::permute::<BYTE>(from[i], indices[i]).store();
        let halves = [half(0), half(1)];
        // SAFETY: `from` is the proof of the instruction set.
        unsafe { Self::F32x8::load(&std::array::from_fn(|i| halves[i / 4][i % 4])) }
    }
}

/// A computation that is compiled for every instruction set.
pub trait Task {
    /// The result.
    type Output;

    /// Whether builds that need AVX2 have it for the sets below, too. Where they have not, AVX2
    /// stands in, with the same results.
    const EVERY_SET: bool = cfg!(debug_assertions);

    /// Computes it. This and everything it calls must be `#[inline(always)]`: a function that is
    /// called instead is compiled without the instruction set.
    ///
    /// # Safety
    /// The processor must have the instruction set `S`.
    unsafe fn run<S: Simd>(self) -> Self::Output;
}

/// Runs a kernel with the widest vectors of an instruction set.
pub(crate) struct Widest<K>(pub K);

impl<K: Kernel> Task for Widest<K> {
    type Output = K::Output;

    #[inline(always)]
    unsafe fn run<S: Simd>(self) -> K::Output {
        self.0.run::<S::Real>()
    }
}

/// Runs a callee of an instruction set's own floats.
pub(crate) struct Applied<C, R> {
    callee: C,
    real: PhantomData<R>,
}

impl<C, R> Applied<C, R> {
    #[inline(always)]
    pub fn new(callee: C) -> Self {
        Self { callee, real: PhantomData }
    }
}

impl<R: Real, C: Callee<R>> Task for Applied<C, R> {
    type Output = C::Output;

    #[inline(always)]
    unsafe fn run<S: Simd>(self) -> C::Output {
        self.callee.run()
    }
}
