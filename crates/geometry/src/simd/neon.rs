//! Four floats at once, with fused multiplication and addition: every 64-bit Arm processor.

use super::pair::Pair;
use super::{Simd, Task, Vector};
use std::arch::aarch64::*;

/// See [`super::InstructionSet::Neon`].
#[derive(Clone, Copy)]
pub(crate) struct Neon;

impl Simd for Neon {
    type Four = Four;
    type Eight = Pair<Four>;
    type Sixteen = Pair<Pair<Four>>;
}

/// Runs a task.
#[target_feature(enable = "neon")]
pub unsafe fn run<T: Task>(task: T) -> T::Output {
    // SAFETY: who calls this has the instructions.
    unsafe { task.run::<Neon>() }
}

/// Four floats.
#[derive(Clone, Copy)]
pub(crate) struct Four(float32x4_t);

/// A bit for each lane of a mask.
#[inline(always)]
fn bits(mask: uint32x4_t) -> u32 {
    const BITS: [u32; 4] = [1, 2, 4, 8];
    // SAFETY: every 64-bit Arm processor has NEON.
    unsafe { vaddvq_u32(vandq_u32(mask, vld1q_u32(BITS.as_ptr()))) }
}

// SAFETY, for every block below: every 64-bit Arm processor has NEON. Arrays have as many floats as
// are read or written.
impl Vector<4> for Four {
    #[inline(always)]
    unsafe fn splat(x: f32) -> Self {
        unsafe { Self(vdupq_n_f32(x)) }
    }
    #[inline(always)]
    unsafe fn load(from: &[f32; 4]) -> Self {
        unsafe { Self(vld1q_f32(from.as_ptr())) }
    }
    #[inline(always)]
    fn store(self) -> [f32; 4] {
        let mut to = [0.0; 4];
        unsafe { vst1q_f32(to.as_mut_ptr(), self.0) };
        to
    }
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        unsafe { Self(vaddq_f32(self.0, b.0)) }
    }
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        unsafe { Self(vsubq_f32(self.0, b.0)) }
    }
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        unsafe { Self(vmulq_f32(self.0, b.0)) }
    }
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        unsafe { Self(vdivq_f32(self.0, b.0)) }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        unsafe { Self(vabsq_f32(self.0)) }
    }
    #[inline(always)]
    fn min(self, b: Self) -> Self {
        unsafe { Self(vbslq_f32(vcltq_f32(self.0, b.0), self.0, b.0)) }
    }
    #[inline(always)]
    fn max(self, b: Self) -> Self {
        unsafe { Self(vbslq_f32(vcgtq_f32(self.0, b.0), self.0, b.0)) }
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        unsafe { Self(vfmaq_f32(c.0, self.0, b.0)) }
    }
    #[inline(always)]
    fn neg_mul_add(self, b: Self, c: Self) -> Self {
        unsafe { Self(vfmsq_f32(c.0, self.0, b.0)) }
    }
    #[inline(always)]
    fn mul_sub(self, b: Self, c: Self) -> Self {
        unsafe { Self(vfmaq_f32(vnegq_f32(c.0), self.0, b.0)) }
    }
    #[inline(always)]
    fn mul_sub_loosely(self, b: Self, c: Self) -> Self {
        self.mul_sub(b, c)
    }
    #[inline(always)]
    fn le(self, b: Self) -> u32 {
        unsafe { bits(vcleq_f32(self.0, b.0)) }
    }
    #[inline(always)]
    fn lt(self, b: Self) -> u32 {
        unsafe { bits(vcltq_f32(self.0, b.0)) }
    }
}
