//! Four floats at once, which every x86-64 processor can do; products are fused with sums in
//! doubles.

use super::pair::Pair;
use super::{Simd, Task, Vector};
use std::arch::x86_64::*;

/// See [`super::InstructionSet::Sse2`].
#[derive(Clone, Copy)]
pub(crate) struct Sse2;

impl Simd for Sse2 {
    type Four = Four;
    type Eight = Pair<Four>;
    type Sixteen = Pair<Pair<Four>>;

    #[inline(always)]
    fn prefetch(address: *const u8) {
        // SAFETY: every x86-64 processor has SSE, and this reads nothing.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(address.cast()) }
    }
}

/// Runs a task.
#[target_feature(enable = "sse2")]
pub unsafe fn run<T: Task>(task: T) -> T::Output {
    // SAFETY: who calls this has the instructions.
    unsafe { task.run::<Sse2>() }
}

/// See [`super::first_equal`].
#[inline(always)]
pub(super) fn first_equal(keys: &[u32; 16], to: usize) -> usize {
    // SAFETY: every x86-64 processor has SSE2; as many keys are read as there are.
    unsafe {
        let key = _mm_set1_epi32(keys[to] as i32);
        let same = |four: usize| _mm_cmpeq_epi32(_mm_loadu_si128(keys.as_ptr().add(4 * four).cast()), key);
        let halves = [_mm_packs_epi32(same(0), same(1)), _mm_packs_epi32(same(2), same(3))];
        _mm_movemask_epi8(_mm_packs_epi16(halves[0], halves[1])).trailing_zeros() as usize
    }
}

/// Four floats.
#[derive(Clone, Copy)]
pub(crate) struct Four(__m128);

// SAFETY, for every block below: the constructors' callers promised the instructions, and whoever
// has a vector got it from them. Arrays have as many floats as are read or written.
impl Vector<4> for Four {
    #[inline(always)]
    unsafe fn splat(x: f32) -> Self {
        unsafe { Self(_mm_set1_ps(x)) }
    }
    #[inline(always)]
    unsafe fn load(from: &[f32; 4]) -> Self {
        unsafe { Self(_mm_loadu_ps(from.as_ptr())) }
    }
    #[inline(always)]
    fn store(self) -> [f32; 4] {
        let mut to = [0.0; 4];
        unsafe { _mm_storeu_ps(to.as_mut_ptr(), self.0) };
        to
    }
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        unsafe { Self(_mm_add_ps(self.0, b.0)) }
    }
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        unsafe { Self(_mm_sub_ps(self.0, b.0)) }
    }
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        unsafe { Self(_mm_mul_ps(self.0, b.0)) }
    }
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        unsafe { Self(_mm_div_ps(self.0, b.0)) }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        unsafe { Self(_mm_andnot_ps(_mm_set1_ps(-0.0), self.0)) }
    }
    #[inline(always)]
    fn min(self, b: Self) -> Self {
        unsafe { Self(_mm_min_ps(self.0, b.0)) }
    }
    #[inline(always)]
    fn max(self, b: Self) -> Self {
        unsafe { Self(_mm_max_ps(self.0, b.0)) }
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        unsafe { Self(fused(self.0, b.0, c.0)) }
    }
    #[inline(always)]
    fn neg_mul_add(self, b: Self, c: Self) -> Self {
        unsafe { Self(fused(_mm_xor_ps(self.0, _mm_set1_ps(-0.0)), b.0, c.0)) }
    }
    #[inline(always)]
    fn mul_sub(self, b: Self, c: Self) -> Self {
        unsafe { Self(fused(self.0, b.0, _mm_xor_ps(c.0, _mm_set1_ps(-0.0)))) }
    }
    #[inline(always)]
    fn mul_sub_loosely(self, b: Self, c: Self) -> Self {
        unsafe { Self(_mm_sub_ps(_mm_mul_ps(self.0, b.0), c.0)) }
    }
    #[inline(always)]
    fn le(self, b: Self) -> u32 {
        unsafe { _mm_movemask_ps(_mm_cmple_ps(self.0, b.0)) as u32 }
    }
    #[inline(always)]
    fn lt(self, b: Self) -> u32 {
        unsafe { _mm_movemask_ps(_mm_cmplt_ps(self.0, b.0)) as u32 }
    }
}

/// a·b + c, rounded once. The product of two floats is exact in doubles. The sum is rounded there
/// *to odd*: where it is not exact, its last bit is made 1, so that rounding it again to a float
/// goes as if from the exact sum ([Boldo 2008]).
#[inline(always)]
unsafe fn fused(a: __m128, b: __m128, c: __m128) -> __m128 {
    // SAFETY: every x86-64 processor has SSE2.
    unsafe {
        let low = fused_doubles(_mm_cvtps_pd(a), _mm_cvtps_pd(b), _mm_cvtps_pd(c));
        let [a, b, c] = [a, b, c].map(|v| _mm_cvtps_pd(_mm_movehl_ps(v, v)));
        _mm_movelh_ps(low, fused_doubles(a, b, c))
    }
}

#[inline(always)]
unsafe fn fused_doubles(a: __m128d, b: __m128d, c: __m128d) -> __m128 {
    // SAFETY: every x86-64 processor has SSE2.
    unsafe {
        let product = _mm_mul_pd(a, b);
        let sum = _mm_add_pd(product, c);
        // What rounding took from the sum (Knuth's two-sum).
        let c_part = _mm_sub_pd(sum, product);
        let product_part = _mm_sub_pd(sum, c_part);
        let lost = _mm_add_pd(_mm_sub_pd(product, product_part), _mm_sub_pd(c, c_part));
        // An inexact sum with an even last bit moves one bit towards what it lost. As an integer it
        // grows when both have one sign, and shrinks otherwise.
        let inexact = _mm_castpd_si128(_mm_cmpneq_pd(lost, _mm_setzero_pd()));
        let inexact = _mm_and_si128(inexact, _mm_castpd_si128(_mm_cmpord_pd(lost, lost)));
        let bits = _mm_castpd_si128(sum);
        let one = _mm_set1_epi64x(1);
        let is_even = _mm_andnot_si128(bits, one);
        let differ = _mm_srli_epi64::<63>(_mm_xor_si128(bits, _mm_castpd_si128(lost)));
        let step = _mm_sub_epi64(one, _mm_add_epi64(differ, differ));
        let moves = _mm_and_si128(inexact, _mm_sub_epi64(_mm_setzero_si128(), is_even));
        let odd = _mm_add_epi64(bits, _mm_and_si128(moves, step));
        _mm_cvtpd_ps(_mm_castsi128_pd(odd))
    }
}
