//! Sixteen floats at once, and the vectors of AVX2 with twice the registers. Their comparisons stay
//! vectors: bits from masks take longer.

use super::avx2::{Avx2, Eight, Four};
use super::{Simd, Task, Vector};
use std::arch::x86_64::*;

/// See [`super::InstructionSet::Avx512`].
#[derive(Clone, Copy)]
pub(crate) struct Avx512;

impl Simd for Avx512 {
    type Four = Four;
    type Eight = Eight;
    type Sixteen = Sixteen;

    #[inline(always)]
    fn pick<const BYTE: usize>(from: Eight, places: &[u32; 4]) -> Four {
        Avx2::pick::<BYTE>(from, places)
    }

    #[inline(always)]
    fn prefetch(address: *const u8) {
        // SAFETY: every x86-64 processor has SSE, and this reads nothing.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(address.cast()) }
    }
}

/// Runs a task.
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi1,bmi2,popcnt,lzcnt")]
pub unsafe fn run<T: Task>(task: T) -> T::Output {
    // SAFETY: who calls this has the instructions.
    unsafe { task.run::<Avx512>() }
}

/// Sixteen floats.
#[derive(Clone, Copy)]
pub(crate) struct Sixteen(__m512);

// SAFETY, for every block below: the constructors' callers promised the instructions, and whoever
// has a vector got it from them. Arrays have as many floats as are read or written.
impl Vector<16> for Sixteen {
    #[inline(always)]
    unsafe fn splat(x: f32) -> Self {
        unsafe { Self(_mm512_set1_ps(x)) }
    }
    #[inline(always)]
    unsafe fn load(from: &[f32; 16]) -> Self {
        unsafe { Self(_mm512_loadu_ps(from.as_ptr())) }
    }
    #[inline(always)]
    fn store(self) -> [f32; 16] {
        let mut to = [0.0; 16];
        unsafe { _mm512_storeu_ps(to.as_mut_ptr(), self.0) };
        to
    }
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        unsafe { Self(_mm512_add_ps(self.0, b.0)) }
    }
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        unsafe { Self(_mm512_sub_ps(self.0, b.0)) }
    }
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        unsafe { Self(_mm512_mul_ps(self.0, b.0)) }
    }
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        unsafe { Self(_mm512_div_ps(self.0, b.0)) }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        unsafe { Self(_mm512_abs_ps(self.0)) }
    }
    #[inline(always)]
    fn min(self, b: Self) -> Self {
        unsafe { Self(_mm512_min_ps(self.0, b.0)) }
    }
    #[inline(always)]
    fn max(self, b: Self) -> Self {
        unsafe { Self(_mm512_max_ps(self.0, b.0)) }
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        unsafe { Self(_mm512_fmadd_ps(self.0, b.0, c.0)) }
    }
    #[inline(always)]
    fn neg_mul_add(self, b: Self, c: Self) -> Self {
        unsafe { Self(_mm512_fnmadd_ps(self.0, b.0, c.0)) }
    }
    #[inline(always)]
    fn mul_sub(self, b: Self, c: Self) -> Self {
        unsafe { Self(_mm512_fmsub_ps(self.0, b.0, c.0)) }
    }
    #[inline(always)]
    fn mul_sub_loosely(self, b: Self, c: Self) -> Self {
        self.mul_sub(b, c)
    }
    #[inline(always)]
    fn le(self, b: Self) -> u32 {
        unsafe { _mm512_cmp_ps_mask::<_CMP_LE_OQ>(self.0, b.0) as u32 }
    }
    #[inline(always)]
    fn lt(self, b: Self) -> u32 {
        unsafe { _mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, b.0) as u32 }
    }
}
