//! Sixteen floats at once, and the vectors of AVX2 with twice the registers. Comparisons of the
//! latter stay vectors: bits from mask registers take longer.

use crate::avx2::{self, F32x4, F32x8};
use std::arch::x86_64::*;

instruction_set! {
    Avx512, is_x86_feature_detected [
        "avx512f" "avx512vl" "avx512dq" "avx512bw" "avx2" "fma" "bmi1" "bmi2" "popcnt" "lzcnt"
    ];
    F32x4, F32x8, F32x16;
    f32;

    #[inline(always)]
    fn permute<const BYTE: usize>(from: F32x8, indices: &[u32; 4]) -> F32x4 {
        avx2::permute::<BYTE>(from, indices)
    }
}

vector! {
    /// Sixteen floats.
    F32x16(__m512): Vector<16>;
    splat(x) = _mm512_set1_ps(x);
    load(from) = _mm512_loadu_ps(from);
    store(to, a) = _mm512_storeu_ps(to, a);
    add(a, b) = _mm512_add_ps(a, b);
    sub(a, b) = _mm512_sub_ps(a, b);
    mul(a, b) = _mm512_mul_ps(a, b);
    div(a, b) = _mm512_div_ps(a, b);
    abs(a) = _mm512_abs_ps(a);
    min(a, b) = _mm512_min_ps(a, b);
    max(a, b) = _mm512_max_ps(a, b);
    mul_add(a, b, c) = _mm512_fmadd_ps(a, b, c);
    neg_mul_add(a, b, c) = _mm512_fnmadd_ps(a, b, c);
    mul_sub(a, b, c) = _mm512_fmsub_ps(a, b, c);
    -> u32:
    le(a, b) = _mm512_cmp_ps_mask::<_CMP_LE_OQ>(a, b) as u32;
    lt(a, b) = _mm512_cmp_ps_mask::<_CMP_LT_OQ>(a, b) as u32;
}
