//! Four floats at once, with fused multiply-add: every 64-bit Arm processor.

use crate::pair::Pair;
use std::arch::aarch64::*;
use std::arch::is_aarch64_feature_detected;

instruction_set! {
    Neon, is_aarch64_feature_detected ["neon"];
    F32x4, Pair<F32x4>, Pair<Pair<F32x4>>;
    f32;
}

/// A bit for each lane of a mask.
#[inline(always)]
unsafe fn bits(mask: uint32x4_t) -> u32 {
    const BITS: [u32; 4] = [1, 2, 4, 8];
    // SAFETY: masks are made by NEON alone; the array has as many elements as are read.
    unsafe { vaddvq_u32(vandq_u32(mask, vld1q_u32(BITS.as_ptr()))) }
}

vector! {
    /// Four floats.
    F32x4(float32x4_t): Vector<4>;
    splat(x) = vdupq_n_f32(x);
    load(from) = vld1q_f32(from);
    store(to, a) = vst1q_f32(to, a);
    add(a, b) = vaddq_f32(a, b);
    sub(a, b) = vsubq_f32(a, b);
    mul(a, b) = vmulq_f32(a, b);
    div(a, b) = vdivq_f32(a, b);
    abs(a) = vabsq_f32(a);
    min(a, b) = vbslq_f32(vcltq_f32(a, b), a, b);
    max(a, b) = vbslq_f32(vcgtq_f32(a, b), a, b);
    mul_add(a, b, c) = vfmaq_f32(c, a, b);
    neg_mul_add(a, b, c) = vfmsq_f32(c, a, b);
    mul_sub(a, b, c) = vfmaq_f32(vnegq_f32(c), a, b);
    -> u32:
    le(a, b) = bits(vcleq_f32(a, b));
    lt(a, b) = bits(vcltq_f32(a, b));
}
