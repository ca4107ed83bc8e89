//! Eight floats at once, with fused multiplication and addition.

use super::pair::Pair;
use super::{Simd, Task, Vector};
use std::arch::x86_64::*;

/// See [`super::InstructionSet::Avx2`].
#[derive(Clone, Copy)]
pub(crate) struct Avx2;

impl Simd for Avx2 {
    type Four = Four;
    type Eight = Eight;
    type Sixteen = Pair<Eight>;

    #[inline(always)]
    fn pick<const BYTE: usize>(from: Eight, places: &[u32; 4]) -> Four {
        // SAFETY: who has vectors has the instructions; the array has as many numbers as are read.
        unsafe {
            let places = _mm_loadu_si128(places.as_ptr().cast());
            let places = _mm_srl_epi32(places, _mm_cvtsi32_si128(8 * BYTE as i32));
            let picked = _mm256_permutevar8x32_ps(from.0, _mm256_castsi128_si256(places));
            Four(_mm256_castps256_ps128(picked))
        }
    }

    #[inline(always)]
    fn prefetch(address: *const u8) {
        // SAFETY: every x86-64 processor has SSE, and this reads nothing.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(address.cast()) }
    }
}

/// Runs a task.
#[target_feature(enable = "avx2,fma,bmi1,bmi2,popcnt,lzcnt")]
pub unsafe fn run<T: Task>(task: T) -> T::Output {
    // SAFETY: who calls this has the instructions.
    unsafe { task.run::<Avx2>() }
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
        unsafe { Self(_mm_fmadd_ps(self.0, b.0, c.0)) }
    }
    #[inline(always)]
    fn neg_mul_add(self, b: Self, c: Self) -> Self {
        unsafe { Self(_mm_fnmadd_ps(self.0, b.0, c.0)) }
    }
    #[inline(always)]
    fn mul_sub(self, b: Self, c: Self) -> Self {
        unsafe { Self(_mm_fmsub_ps(self.0, b.0, c.0)) }
    }
    #[inline(always)]
    fn mul_sub_loosely(self, b: Self, c: Self) -> Self {
        self.mul_sub(b, c)
    }
    #[inline(always)]
    fn le(self, b: Self) -> u32 {
        unsafe { _mm_movemask_ps(_mm_cmp_ps::<_CMP_LE_OQ>(self.0, b.0)) as u32 }
    }
    #[inline(always)]
    fn lt(self, b: Self) -> u32 {
        unsafe { _mm_movemask_ps(_mm_cmp_ps::<_CMP_LT_OQ>(self.0, b.0)) as u32 }
    }
}

/// Eight floats.
#[derive(Clone, Copy)]
pub(crate) struct Eight(__m256);

// SAFETY, for every block below: the constructors' callers promised the instructions, and whoever
// has a vector got it from them. Arrays have as many floats as are read or written.
impl Vector<8> for Eight {
    #[inline(always)]
    unsafe fn splat(x: f32) -> Self {
        unsafe { Self(_mm256_set1_ps(x)) }
    }
    #[inline(always)]
    unsafe fn load(from: &[f32; 8]) -> Self {
        unsafe { Self(_mm256_loadu_ps(from.as_ptr())) }
    }
    #[inline(always)]
    fn store(self) -> [f32; 8] {
        let mut to = [0.0; 8];
        unsafe { _mm256_storeu_ps(to.as_mut_ptr(), self.0) };
        to
    }
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        unsafe { Self(_mm256_add_ps(self.0, b.0)) }
    }
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        unsafe { Self(_mm256_sub_ps(self.0, b.0)) }
    }
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        unsafe { Self(_mm256_mul_ps(self.0, b.0)) }
    }
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        unsafe { Self(_mm256_div_ps(self.0, b.0)) }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        unsafe { Self(_mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0)) }
    }
    #[inline(always)]
    fn min(self, b: Self) -> Self {
        unsafe { Self(_mm256_min_ps(self.0, b.0)) }
    }
    #[inline(always)]
    fn max(self, b: Self) -> Self {
        unsafe { Self(_mm256_max_ps(self.0, b.0)) }
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        unsafe { Self(_mm256_fmadd_ps(self.0, b.0, c.0)) }
    }
    #[inline(always)]
    fn neg_mul_add(self, b: Self, c: Self) -> Self {
        unsafe { Self(_mm256_fnmadd_ps(self.0, b.0, c.0)) }
    }
    #[inline(always)]
    fn mul_sub(self, b: Self, c: Self) -> Self {
        unsafe { Self(_mm256_fmsub_ps(self.0, b.0, c.0)) }
    }
    #[inline(always)]
    fn mul_sub_loosely(self, b: Self, c: Self) -> Self {
        self.mul_sub(b, c)
    }
    #[inline(always)]
    fn le(self, b: Self) -> u32 {
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, b.0)) as u32 }
    }
    #[inline(always)]
    fn lt(self, b: Self) -> u32 {
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, b.0)) as u32 }
    }
}
