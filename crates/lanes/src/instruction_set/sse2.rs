//! Four floats at once, which every x86-64 processor can do; fused multiply-adds are made in
//! doubles.

use crate::each::Each;
use crate::pair::Pair;
use std::arch::x86_64::*;

instruction_set! {
    Sse2, is_x86_feature_detected ["sse2"];
    F32x4, Pair<F32x4>, Pair<Pair<F32x4>>;
    F32x4;
}

vector! {
    /// Four floats.
    F32x4(__m128): Vector<4>;
    splat(x) = _mm_set1_ps(x);
    lane(a, lane) = std::mem::transmute::<__m128, [f32; 4]>(a)[lane];
    add(a, b) = _mm_add_ps(a, b);
    sub(a, b) = _mm_sub_ps(a, b);
    mul(a, b) = _mm_mul_ps(a, b);
    div(a, b) = _mm_div_ps(a, b);
    abs(a) = _mm_andnot_ps(_mm_set1_ps(-0.0), a);
    min(a, b) = _mm_min_ps(a, b);
    max(a, b) = _mm_max_ps(a, b);
    min_int(a, b) = blend(_mm_cmplt_epi32(_mm_castps_si128(a), _mm_castps_si128(b)), a, b);
    min_uint(a, b) = blend(_mm_cmplt_epi32(flipped(a), flipped(b)), a, b);
    max_int(a, b) = blend(_mm_cmpgt_epi32(_mm_castps_si128(a), _mm_castps_si128(b)), a, b);
    max_uint(a, b) = blend(_mm_cmpgt_epi32(flipped(a), flipped(b)), a, b);
    mul_add(a, b, c) = fused(a, b, c);
    neg_mul_add(a, b, c) = fused(_mm_xor_ps(a, _mm_set1_ps(-0.0)), b, c);
    mul_sub(a, b, c) = fused(a, b, _mm_xor_ps(c, _mm_set1_ps(-0.0)));
    relaxed_mul_sub(a, b, c) = _mm_sub_ps(_mm_mul_ps(a, b), c);
    -> u32:
    le(a, b) = _mm_movemask_ps(_mm_cmple_ps(a, b)) as u32;
    lt(a, b) = _mm_movemask_ps(_mm_cmplt_ps(a, b)) as u32;
}

real! {
    F32x4, U32x4, Mask4: 4;
    select(mask, a, b) = blend(mask, a, b);
    from_bits(bits) = _mm_castsi128_ps(bits);
    sqrt(a) = _mm_sqrt_ps(a);
    floor(a) = floor(a);
    -> Mask:
    lt(a, b) = _mm_castps_si128(_mm_cmplt_ps(a, b));
    le(a, b) = _mm_castps_si128(_mm_cmple_ps(a, b));
    eq(a, b) = _mm_castps_si128(_mm_cmpeq_ps(a, b));
    -> Int:
    to_bits(a) = _mm_castps_si128(a);
    to_int(a) = _mm_cvttps_epi32(a);
}

int! {
    /// Four integers.
    U32x4(__m128i), F32x4, Mask4: 4;
    splat(x) = _mm_set1_epi32(x);
    select(mask, a, b) = _mm_or_si128(_mm_and_si128(mask, a), _mm_andnot_si128(mask, b));
    mul_wide(a, b) = mul_wide(a, b);
    shl(a, bits) = _mm_sll_epi32(a, _mm_cvtsi32_si128(bits));
    shr(a, bits) = _mm_srl_epi32(a, _mm_cvtsi32_si128(bits));
    to_real(a) = _mm_cvtepi32_ps(a);
    wrapping_add(a, b) = _mm_add_epi32(a, b);
    wrapping_sub(a, b) = _mm_sub_epi32(a, b);
    wrapping_mul(a, b) = mul_wide(a, b).0;
    -> Mask:
    eq(a, b) = _mm_cmpeq_epi32(a, b);
    lt(a, b) = _mm_cmplt_epi32(flip_sign(a), flip_sign(b));
    -> Self, as operators:
    BitAnd::bitand(a, b) = _mm_and_si128(a, b);
    BitOr::bitor(a, b) = _mm_or_si128(a, b);
    BitXor::bitxor(a, b) = _mm_xor_si128(a, b);
}

mask! {
    /// Four bools: all bits of a lane are set or clear.
    Mask4(__m128i): 4;
    splat(x) = _mm_set1_epi32(-i32::from(x));
    from_bits(bits) = _mm_cmpeq_epi32(_mm_and_si128(_mm_set1_epi32(bits), lane_bits()), lane_bits());
    bits(a) = _mm_movemask_ps(_mm_castsi128_ps(a)) as u32;
    -> Self, as operators:
    BitAnd::bitand(a, b) = _mm_and_si128(a, b);
    BitOr::bitor(a, b) = _mm_or_si128(a, b);
    BitXor::bitxor(a, b) = _mm_xor_si128(a, b);
}

// SAFETY of what follows: every x86-64 processor has SSE2.

/// A bit for each lane.
#[inline(always)]
unsafe fn lane_bits() -> __m128i {
    unsafe { _mm_setr_epi32(1, 2, 4, 8) }
}

/// Comparisons are of signed integers: exchanges the lower half of all integers with the upper.
#[inline(always)]
unsafe fn flip_sign(a: __m128i) -> __m128i {
    unsafe { _mm_xor_si128(a, _mm_set1_epi32(i32::MIN)) }
}

/// The bits of floats, ordered as signed integers like the unsigned ones they are.
#[inline(always)]
unsafe fn flipped(a: __m128) -> __m128i {
    unsafe { flip_sign(_mm_castps_si128(a)) }
}

/// `a` where the mask is true, else `b`.
#[inline(always)]
unsafe fn blend(mask: __m128i, a: __m128, b: __m128) -> __m128 {
    unsafe {
        let mask = _mm_castsi128_ps(mask);
        _mm_or_ps(_mm_and_ps(mask, a), _mm_andnot_ps(mask, b))
    }
}

/// The halves of the products, of which an instruction makes every second.
#[inline(always)]
unsafe fn mul_wide(a: __m128i, b: __m128i) -> (__m128i, __m128i) {
    unsafe {
        let even = _mm_mul_epu32(a, b);
        let odd = _mm_mul_epu32(_mm_srli_epi64::<32>(a), _mm_srli_epi64::<32>(b));
        // Of each the two low halves, then the two high ones.
        let [even, odd] = [even, odd].each(|products| _mm_shuffle_epi32::<0b11_01_10_00>(products));
        (_mm_unpacklo_epi32(even, odd), _mm_unpackhi_epi32(even, odd))
    }
}

/// The greatest integer that is at most `a`: `a` itself from 2²³ on, and where it is NaN; else the
/// integer next to it towards zero, or one less. The sign is that of `a`, for the sake of −0.
#[inline(always)]
unsafe fn floor(a: __m128) -> __m128 {
    unsafe {
        let sign = _mm_and_ps(a, _mm_set1_ps(-0.0));
        let truncated = _mm_cvtepi32_ps(_mm_cvttps_epi32(a));
        let above = _mm_and_ps(_mm_cmplt_ps(a, truncated), _mm_set1_ps(1.0));
        let rounded = _mm_or_ps(_mm_sub_ps(truncated, above), sign);
        let has_fraction = _mm_cmplt_ps(_mm_xor_ps(a, sign), _mm_set1_ps(8_388_608.0));
        blend(_mm_castps_si128(has_fraction), rounded, a)
    }
}

/// a·b + c, rounded once. The product of two floats is exact in doubles. The sum is rounded *to
/// odd* there: where it is inexact, its last bit is set to 1, so that rounding it again to a float
/// gives what rounding the exact sum would ([Boldo 2008]).
#[inline(always)]
unsafe fn fused(a: __m128, b: __m128, c: __m128) -> __m128 {
    // SAFETY: every x86-64 processor has SSE2.
    unsafe {
        let low = fused_doubles(_mm_cvtps_pd(a), _mm_cvtps_pd(b), _mm_cvtps_pd(c));
        let [a, b, c] = [a, b, c].each(|v| _mm_cvtps_pd(_mm_movehl_ps(v, v)));
        _mm_movelh_ps(low, fused_doubles(a, b, c))
    }
}

#[inline(always)]
unsafe fn fused_doubles(a: __m128d, b: __m128d, c: __m128d) -> __m128 {
    // SAFETY: every x86-64 processor has SSE2.
    unsafe {
        let product = _mm_mul_pd(a, b);
        let sum = _mm_add_pd(product, c);
        // The rounding error of the sum (Knuth's two-sum).
        let c_part = _mm_sub_pd(sum, product);
        let product_part = _mm_sub_pd(sum, c_part);
        let lost = _mm_add_pd(_mm_sub_pd(product, product_part), _mm_sub_pd(c, c_part));
        // An inexact sum with an even last bit moves one unit towards the exact sum. As an integer
        // it grows where sum and error have the same sign, and shrinks otherwise.
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
