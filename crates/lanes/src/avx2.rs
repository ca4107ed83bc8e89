//! Eight floats at once, with fused multiply-add.

use crate::pair::Pair;
use std::arch::x86_64::*;

instruction_set! {
    Avx2, is_x86_feature_detected ["avx2" "fma" "bmi1" "bmi2" "popcnt" "lzcnt"];
    F32x4, F32x8, Pair<F32x8>;
    f32;

    #[inline(always)]
    fn permute<const BYTE: usize>(from: F32x8, indices: &[u32; 4]) -> F32x4 {
        permute::<BYTE>(from, indices)
    }
}

/// See [`crate::Simd::permute`].
#[inline(always)]
pub fn permute<const BYTE: usize>(from: F32x8, indices: &[u32; 4]) -> F32x4 {
    // SAFETY: `from` is the proof of the instruction set; the array has as many indices as are
    // read.
    unsafe {
        let indices = _mm_loadu_si128(indices.as_ptr().cast());
        let indices = _mm_srl_epi32(indices, _mm_cvtsi32_si128(8 * BYTE as i32));
        let permuted = _mm256_permutevar8x32_ps(from.0, _mm256_castsi128_si256(indices));
        F32x4(_mm256_castps256_ps128(permuted))
    }
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
    mul_add(a, b, c) = _mm_fmadd_ps(a, b, c);
    neg_mul_add(a, b, c) = _mm_fnmadd_ps(a, b, c);
    mul_sub(a, b, c) = _mm_fmsub_ps(a, b, c);
    -> u32:
    le(a, b) = _mm_movemask_ps(_mm_cmp_ps::<_CMP_LE_OQ>(a, b)) as u32;
    lt(a, b) = _mm_movemask_ps(_mm_cmp_ps::<_CMP_LT_OQ>(a, b)) as u32;
}

vector! {
    /// Eight floats.
    F32x8(__m256): Vector<8>;
    splat(x) = _mm256_set1_ps(x);
    load(from) = _mm256_loadu_ps(from);
    store(to, a) = _mm256_storeu_ps(to, a);
    add(a, b) = _mm256_add_ps(a, b);
    sub(a, b) = _mm256_sub_ps(a, b);
    mul(a, b) = _mm256_mul_ps(a, b);
    div(a, b) = _mm256_div_ps(a, b);
    abs(a) = _mm256_andnot_ps(_mm256_set1_ps(-0.0), a);
    min(a, b) = _mm256_min_ps(a, b);
    max(a, b) = _mm256_max_ps(a, b);
    mul_add(a, b, c) = _mm256_fmadd_ps(a, b, c);
    neg_mul_add(a, b, c) = _mm256_fnmadd_ps(a, b, c);
    mul_sub(a, b, c) = _mm256_fmsub_ps(a, b, c);
    -> u32:
    le(a, b) = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b)) as u32;
    lt(a, b) = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(a, b)) as u32;
}
