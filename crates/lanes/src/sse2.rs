//! Four floats at once, which every x86-64 processor can do; fused multiply-adds are made in
//! doubles.

use crate::pair::Pair;
use std::arch::x86_64::*;

instruction_set! {
    Sse2, is_x86_feature_detected ["sse2"];
    F32x4, Pair<F32x4>, Pair<Pair<F32x4>>;
    f32;
}

vector! {
    /// Four floats.
    F32x4(__m128): Vector<4>;
    splat(x) = _mm_set1_ps(x);
    load(from) = _mm_loadu_ps(from);
    store(to, a) = _mm_storeu_ps(to, a);
    add(a, b) = _mm_add_ps(a, b);
    sub(a, b) = _mm_sub_ps(a, b);
    mul(a, b) = _mm_mul_ps(a, b);
    div(a, b) = _mm_div_ps(a, b);
    abs(a) = _mm_andnot_ps(_mm_set1_ps(-0.0), a);
    min(a, b) = _mm_min_ps(a, b);
    max(a, b) = _mm_max_ps(a, b);
    mul_add(a, b, c) = fused(a, b, c);
    neg_mul_add(a, b, c) = fused(_mm_xor_ps(a, _mm_set1_ps(-0.0)), b, c);
    mul_sub(a, b, c) = fused(a, b, _mm_xor_ps(c, _mm_set1_ps(-0.0)));
    relaxed_mul_sub(a, b, c) = _mm_sub_ps(_mm_mul_ps(a, b), c);
    -> u32:
    le(a, b) = _mm_movemask_ps(_mm_cmple_ps(a, b)) as u32;
    lt(a, b) = _mm_movemask_ps(_mm_cmplt_ps(a, b)) as u32;
}

/// a·b + c, rounded once. The product of two floats is exact in doubles. The sum is rounded *to
/// odd* there: where it is inexact, its last bit is set to 1, so that rounding it again to a float
/// gives what rounding the exact sum would ([Boldo 2008]).
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
