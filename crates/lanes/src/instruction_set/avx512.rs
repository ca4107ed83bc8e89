//! Sixteen floats at once, and the vectors of AVX2 with twice the registers. Comparisons of the
//! latter stay vectors: bits from mask registers take longer.

use super::avx2::{self, F32x4, F32x8, row};
use std::arch::x86_64::*;
use std::mem::transmute;

instruction_set! {
    Avx512, is_x86_feature_detected [
        "avx512f" "avx512vl" "avx512dq" "avx512bw" "avx2" "fma" "bmi1" "bmi2" "popcnt" "lzcnt"
    ];
    F32x4, F32x8, F32x16;
    F32x16;

    #[inline(always)]
    fn permute<const BYTE: usize>(from: F32x8, indices: &[u32; 4]) -> F32x4 {
        avx2::permute::<BYTE>(from, indices)
    }

    #[inline(always)]
    fn permute_both<const BYTE: usize>(from: [F32x8; 2], indices: [&[u32; 4]; 2]) -> F32x8 {
        // SAFETY: `from` is the proof of the instruction set; arrays have as many indices as are
        // read.
        unsafe {
            let low = transmute::<[u32; 4], __m128i>(*indices[0]);
            let high = transmute::<[u32; 4], __m128i>(*indices[1]);
            // One permutation of both vectors, where the bit of 8 tells which.
            let high = _mm_or_si128(high, _mm_set1_epi32(0x0808_0808));
            let both = _mm256_inserti128_si256::<1>(_mm256_castsi128_si256(low), high);
            let both = _mm256_srl_epi32(both, _mm_cvtsi32_si128(8 * BYTE as i32));
            F32x8(_mm256_permutex2var_ps(from[0].0, both, from[1].0))
        }
    }
}

vector! {
    /// Sixteen floats.
    F32x16(__m512): Vector<16>;
    splat(x) = _mm512_set1_ps(x);
    lane(a, lane) = _mm512_cvtss_f32(_mm512_permutexvar_ps(_mm512_set1_epi32(lane as i32), a));
    add(a, b) = _mm512_add_ps(a, b);
    sub(a, b) = _mm512_sub_ps(a, b);
    mul(a, b) = _mm512_mul_ps(a, b);
    div(a, b) = _mm512_div_ps(a, b);
    abs(a) = _mm512_abs_ps(a);
    min(a, b) = _mm512_min_ps(a, b);
    max(a, b) = _mm512_max_ps(a, b);
    min_int(a, b) = _mm512_castsi512_ps(_mm512_min_epi32(_mm512_castps_si512(a), _mm512_castps_si512(b)));
    min_uint(a, b) = _mm512_castsi512_ps(_mm512_min_epu32(_mm512_castps_si512(a), _mm512_castps_si512(b)));
    max_int(a, b) = _mm512_castsi512_ps(_mm512_max_epi32(_mm512_castps_si512(a), _mm512_castps_si512(b)));
    max_uint(a, b) = _mm512_castsi512_ps(_mm512_max_epu32(_mm512_castps_si512(a), _mm512_castps_si512(b)));
    mul_add(a, b, c) = _mm512_fmadd_ps(a, b, c);
    neg_mul_add(a, b, c) = _mm512_fnmadd_ps(a, b, c);
    mul_sub(a, b, c) = _mm512_fmsub_ps(a, b, c);
    -> u32:
    le(a, b) = _mm512_cmp_ps_mask::<_CMP_LE_OQ>(a, b) as u32;
    lt(a, b) = _mm512_cmp_ps_mask::<_CMP_LT_OQ>(a, b) as u32;
}

real! {
    F32x16, U32x16, Mask16: 16;
    select(mask, a, b) = _mm512_mask_blend_ps(mask, b, a);
    from_bits(bits) = _mm512_castsi512_ps(bits);
    sqrt(a) = _mm512_sqrt_ps(a);
    floor(a) = _mm512_roundscale_ps::<{ _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC }>(a);
    -> Mask:
    lt(a, b) = _mm512_cmp_ps_mask::<_CMP_LT_OQ>(a, b);
    le(a, b) = _mm512_cmp_ps_mask::<_CMP_LE_OQ>(a, b);
    eq(a, b) = _mm512_cmp_ps_mask::<_CMP_EQ_OQ>(a, b);
    -> Int:
    to_bits(a) = _mm512_castps_si512(a);
    to_int(a) = _mm512_cvttps_epi32(a);
    -> Self, if there is an instruction:
    gather(table, indices) = _mm512_i32gather_ps::<4>(indices, table);
    -> [Self; 4], by shuffles:
    gather_rows::<K>(table, indices) = gather_rows::<K>(table, &indices);
    transpose(columns) = transpose(columns);
    -> (), if there is an instruction:
    scatter(value, mask, table, indices) = _mm512_mask_i32scatter_ps::<4>(table, mask, indices, value);
}

int! {
    /// Sixteen integers.
    U32x16(__m512i), F32x16, Mask16: 16;
    splat(x) = _mm512_set1_epi32(x);
    select(mask, a, b) = _mm512_mask_blend_epi32(mask, b, a);
    mul_wide(a, b) = mul_wide(a, b);
    shl(a, bits) = _mm512_sll_epi32(a, _mm_cvtsi32_si128(bits));
    shr(a, bits) = _mm512_srl_epi32(a, _mm_cvtsi32_si128(bits));
    to_real(a) = _mm512_cvtepi32_ps(a);
    wrapping_add(a, b) = _mm512_add_epi32(a, b);
    wrapping_sub(a, b) = _mm512_sub_epi32(a, b);
    wrapping_mul(a, b) = _mm512_mullo_epi32(a, b);
    -> Mask:
    eq(a, b) = _mm512_cmpeq_epi32_mask(a, b);
    lt(a, b) = _mm512_cmplt_epu32_mask(a, b);
    -> Self, as operators:
    BitAnd::bitand(a, b) = _mm512_and_si512(a, b);
    BitOr::bitor(a, b) = _mm512_or_si512(a, b);
    BitXor::bitxor(a, b) = _mm512_xor_si512(a, b);
    -> Self, if there is an instruction:
    gather(table, indices) = _mm512_i32gather_epi32::<4>(indices, table.cast());
    gather_bytes(table, indices) = _mm512_i32gather_epi32::<1>(indices, table.cast());
    gather_halves(table, indices) = _mm512_i32gather_epi32::<2>(indices, table.cast());
    compress(a, mask) = _mm512_maskz_compress_epi32(mask, a);
    -> (), if there is an instruction:
    scatter(value, mask, table, indices) =
        _mm512_mask_i32scatter_epi32::<4>(table.cast(), mask, indices, value);
}

mask! {
    /// Sixteen bools, a bit each.
    Mask16(__mmask16): 16;
    splat(x) = if x { u16::MAX } else { 0 };
    from_bits(bits) = bits;
    bits(a) = a.into();
    -> Self, as operators:
    BitAnd::bitand(a, b) = a & b;
    BitOr::bitor(a, b) = a | b;
    BitXor::bitxor(a, b) = a ^ b;
}

/// `K` floats from each index on, in columns, and after them others.
#[inline(always)]
unsafe fn gather_rows<const K: usize>(table: *const f32, indices: &[u32; 16]) -> [__m512; 4] {
    // SAFETY: only an operation of the vectors above calls it.
    unsafe {
        // Quarter i of vector j has the row of lane 4 i + j.
        let mut rows = [_mm512_setzero_ps(); 4];
        let mut j = 0;
        while j < 4 {
            let first = _mm512_castps128_ps512(row::<K>(table.add(indices[j] as usize)));
            let second = row::<K>(table.add(indices[4 + j] as usize));
            let third = row::<K>(table.add(indices[8 + j] as usize));
            let fourth = row::<K>(table.add(indices[12 + j] as usize));
            let low = _mm512_mask_broadcast_f32x4(first, 0x00f0, second);
            let most = _mm512_mask_broadcast_f32x4(low, 0x0f00, third);
            rows[j] = _mm512_mask_broadcast_f32x4(most, 0xf000, fourth);
            j += 1;
        }
        transpose(rows)
    }
}

/// Transposes the matrices of four by four floats, whose rows are four lanes of each vector.
#[inline(always)]
unsafe fn transpose([a, b, c, d]: [__m512; 4]) -> [__m512; 4] {
    // SAFETY: as above.
    unsafe {
        let low = [_mm512_unpacklo_ps(a, b), _mm512_unpacklo_ps(c, d)];
        let high = [_mm512_unpackhi_ps(a, b), _mm512_unpackhi_ps(c, d)];
        [
            _mm512_shuffle_ps::<0x44>(low[0], low[1]),
            _mm512_shuffle_ps::<0xee>(low[0], low[1]),
            _mm512_shuffle_ps::<0x44>(high[0], high[1]),
            _mm512_shuffle_ps::<0xee>(high[0], high[1]),
        ]
    }
}

/// The halves of the products, of which an instruction makes every second.
#[inline(always)]
unsafe fn mul_wide(a: __m512i, b: __m512i) -> (__m512i, __m512i) {
    // SAFETY: only an operation of the vectors above calls it.
    unsafe {
        let even = _mm512_mul_epu32(a, b);
        let odd = _mm512_mul_epu32(_mm512_srli_epi64::<32>(a), _mm512_srli_epi64::<32>(b));
        let low = _mm512_mask_blend_epi32(0xaaaa, even, _mm512_slli_epi64::<32>(odd));
        (low, _mm512_mask_blend_epi32(0xaaaa, _mm512_srli_epi64::<32>(even), odd))
    }
}
