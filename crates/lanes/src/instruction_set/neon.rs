//! Four floats at once, with fused multiply-add: every 64-bit Arm processor.

use crate::pair::Pair;
use std::arch::aarch64::*;
use std::arch::is_aarch64_feature_detected;

instruction_set! {
    Neon, is_aarch64_feature_detected ["neon"];
    F32x4, Pair<F32x4>, Pair<Pair<F32x4>>;
    F32x4;
}

/// A bit for each lane.
const BITS: [u32; 4] = [1, 2, 4, 8];

/// A bit for each lane of a mask.
#[inline(always)]
unsafe fn bits(mask: uint32x4_t) -> u32 {
    // SAFETY: masks are made by NEON alone; the array has as many elements as are read.
    unsafe { vaddvq_u32(vandq_u32(mask, vld1q_u32(BITS.as_ptr()))) }
}

vector! {
    /// Four floats.
    F32x4(float32x4_t): Vector<4>;
    splat(x) = vdupq_n_f32(x);
    lane(a, lane) = std::mem::transmute::<float32x4_t, [f32; 4]>(a)[lane];
    add(a, b) = vaddq_f32(a, b);
    sub(a, b) = vsubq_f32(a, b);
    mul(a, b) = vmulq_f32(a, b);
    div(a, b) = vdivq_f32(a, b);
    abs(a) = vabsq_f32(a);
    min(a, b) = vbslq_f32(vcltq_f32(a, b), a, b);
    max(a, b) = vbslq_f32(vcgtq_f32(a, b), a, b);
    min_int(a, b) = vreinterpretq_f32_s32(vminq_s32(vreinterpretq_s32_f32(a), vreinterpretq_s32_f32(b)));
    min_uint(a, b) = vreinterpretq_f32_u32(vminq_u32(vreinterpretq_u32_f32(a), vreinterpretq_u32_f32(b)));
    max_int(a, b) = vreinterpretq_f32_s32(vmaxq_s32(vreinterpretq_s32_f32(a), vreinterpretq_s32_f32(b)));
    max_uint(a, b) = vreinterpretq_f32_u32(vmaxq_u32(vreinterpretq_u32_f32(a), vreinterpretq_u32_f32(b)));
    mul_add(a, b, c) = vfmaq_f32(c, a, b);
    neg_mul_add(a, b, c) = vfmsq_f32(c, a, b);
    mul_sub(a, b, c) = vfmaq_f32(vnegq_f32(c), a, b);
    -> u32:
    le(a, b) = bits(vcleq_f32(a, b));
    lt(a, b) = bits(vcltq_f32(a, b));
}

real! {
    F32x4, U32x4, Mask4: 4;
    select(mask, a, b) = vbslq_f32(mask, a, b);
    from_bits(bits) = vreinterpretq_f32_u32(bits);
    sqrt(a) = vsqrtq_f32(a);
    floor(a) = vrndmq_f32(a);
    -> Mask:
    lt(a, b) = vcltq_f32(a, b);
    le(a, b) = vcleq_f32(a, b);
    eq(a, b) = vceqq_f32(a, b);
    -> Int:
    to_bits(a) = vreinterpretq_u32_f32(a);
    to_int(a) = vreinterpretq_u32_s32(vcvtq_s32_f32(a));
}

int! {
    /// Four integers.
    U32x4(uint32x4_t), F32x4, Mask4: 4;
    splat(x) = vdupq_n_u32(x);
    select(mask, a, b) = vbslq_u32(mask, a, b);
    mul_wide(a, b) = mul_wide(a, b);
    shl(a, bits) = vshlq_u32(a, vdupq_n_s32(bits));
    shr(a, bits) = vshlq_u32(a, vdupq_n_s32(-bits));
    to_real(a) = vcvtq_f32_s32(vreinterpretq_s32_u32(a));
    wrapping_add(a, b) = vaddq_u32(a, b);
    wrapping_sub(a, b) = vsubq_u32(a, b);
    wrapping_mul(a, b) = vmulq_u32(a, b);
    -> Mask:
    eq(a, b) = vceqq_u32(a, b);
    lt(a, b) = vcltq_u32(a, b);
    -> Self, as operators:
    BitAnd::bitand(a, b) = vandq_u32(a, b);
    BitOr::bitor(a, b) = vorrq_u32(a, b);
    BitXor::bitxor(a, b) = veorq_u32(a, b);
}

mask! {
    /// Four bools: all bits of a lane are set or clear.
    Mask4(uint32x4_t): 4;
    splat(x) = vdupq_n_u32(if x { u32::MAX } else { 0 });
    from_bits(bits) = vtstq_u32(vdupq_n_u32(bits), vld1q_u32(BITS.as_ptr()));
    bits(a) = bits(a);
    -> Self, as operators:
    BitAnd::bitand(a, b) = vandq_u32(a, b);
    BitOr::bitor(a, b) = vorrq_u32(a, b);
    BitXor::bitxor(a, b) = veorq_u32(a, b);
}

/// The halves of the products.
#[inline(always)]
unsafe fn mul_wide(a: uint32x4_t, b: uint32x4_t) -> (uint32x4_t, uint32x4_t) {
    // SAFETY: only an operation of the vectors above calls it.
    unsafe {
        let first = vreinterpretq_u32_u64(vmull_u32(vget_low_u32(a), vget_low_u32(b)));
        let second = vreinterpretq_u32_u64(vmull_high_u32(a, b));
        (vuzp1q_u32(first, second), vuzp2q_u32(first, second))
    }
}
