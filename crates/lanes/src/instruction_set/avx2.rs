//! Eight floats at once, with fused multiply-add.

use crate::pair::Pair;
use std::arch::x86_64::*;
use std::mem::transmute;

instruction_set! {
    Avx2, is_x86_feature_detected ["avx2" "fma" "bmi1" "bmi2" "popcnt" "lzcnt"];
    F32x4, F32x8, Pair<F32x8>;
    F32x8;

    #[inline(always)]
    fn permute<const BYTE: usize>(from: F32x8, indices: &[u32; 4]) -> F32x4 {
        permute::<BYTE>(from, indices)
    }

    #[inline(always)]
    fn permute_both<const BYTE: usize>(from: [F32x8; 2], indices: [&[u32; 4]; 2]) -> F32x8 {
        let half = |i: usize| permute::<BYTE>(from[i], indices[i]);
        // SAFETY: `from` is the proof of the instruction set.
        unsafe { F32x8(_mm256_insertf128_ps::<1>(_mm256_castps128_ps256(half(0).0), half(1).0)) }
    }
}

/// See [`crate::Simd::permute`].
#[inline(always)]
pub fn permute<const BYTE: usize>(from: F32x8, indices: &[u32; 4]) -> F32x4 {
    // SAFETY: `from` is the proof of the instruction set; the array has as many indices as are
    // read.
    unsafe {
        let indices = transmute::<[u32; 4], __m128i>(*indices);
        let indices = _mm_srl_epi32(indices, _mm_cvtsi32_si128(8 * BYTE as i32));
        let permuted = _mm256_permutevar8x32_ps(from.0, _mm256_castsi128_si256(indices));
        F32x4(_mm256_castps256_ps128(permuted))
    }
}

vector! {
    /// Four floats.
    F32x4(__m128): Vector<4>;
    splat(x) = _mm_set1_ps(x);
    lane(a, lane) = _mm_cvtss_f32(_mm_permutevar_ps(a, _mm_cvtsi32_si128(lane as i32)));
    add(a, b) = _mm_add_ps(a, b);
    sub(a, b) = _mm_sub_ps(a, b);
    mul(a, b) = _mm_mul_ps(a, b);
    div(a, b) = _mm_div_ps(a, b);
    abs(a) = _mm_andnot_ps(_mm_set1_ps(-0.0), a);
    min(a, b) = _mm_min_ps(a, b);
    max(a, b) = _mm_max_ps(a, b);
    min_int(a, b) = _mm_castsi128_ps(_mm_min_epi32(_mm_castps_si128(a), _mm_castps_si128(b)));
    min_uint(a, b) = _mm_castsi128_ps(_mm_min_epu32(_mm_castps_si128(a), _mm_castps_si128(b)));
    max_int(a, b) = _mm_castsi128_ps(_mm_max_epi32(_mm_castps_si128(a), _mm_castps_si128(b)));
    max_uint(a, b) = _mm_castsi128_ps(_mm_max_epu32(_mm_castps_si128(a), _mm_castps_si128(b)));
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
    lane(a, lane) = _mm256_cvtss_f32(_mm256_permutevar8x32_ps(a, _mm256_set1_epi32(lane as i32)));
    add(a, b) = _mm256_add_ps(a, b);
    sub(a, b) = _mm256_sub_ps(a, b);
    mul(a, b) = _mm256_mul_ps(a, b);
    div(a, b) = _mm256_div_ps(a, b);
    abs(a) = _mm256_andnot_ps(_mm256_set1_ps(-0.0), a);
    min(a, b) = _mm256_min_ps(a, b);
    max(a, b) = _mm256_max_ps(a, b);
    min_int(a, b) = _mm256_castsi256_ps(_mm256_min_epi32(_mm256_castps_si256(a), _mm256_castps_si256(b)));
    min_uint(a, b) = _mm256_castsi256_ps(_mm256_min_epu32(_mm256_castps_si256(a), _mm256_castps_si256(b)));
    max_int(a, b) = _mm256_castsi256_ps(_mm256_max_epi32(_mm256_castps_si256(a), _mm256_castps_si256(b)));
    max_uint(a, b) = _mm256_castsi256_ps(_mm256_max_epu32(_mm256_castps_si256(a), _mm256_castps_si256(b)));
    mul_add(a, b, c) = _mm256_fmadd_ps(a, b, c);
    neg_mul_add(a, b, c) = _mm256_fnmadd_ps(a, b, c);
    mul_sub(a, b, c) = _mm256_fmsub_ps(a, b, c);
    -> u32:
    le(a, b) = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b)) as u32;
    lt(a, b) = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(a, b)) as u32;
}

real! {
    F32x8, U32x8, Mask8: 8;
    select(mask, a, b) = _mm256_blendv_ps(b, a, _mm256_castsi256_ps(mask));
    from_bits(bits) = _mm256_castsi256_ps(bits);
    sqrt(a) = _mm256_sqrt_ps(a);
    floor(a) = _mm256_floor_ps(a);
    -> Mask:
    lt(a, b) = _mm256_castps_si256(_mm256_cmp_ps::<_CMP_LT_OQ>(a, b));
    le(a, b) = _mm256_castps_si256(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b));
    eq(a, b) = _mm256_castps_si256(_mm256_cmp_ps::<_CMP_EQ_OQ>(a, b));
    -> Int:
    to_bits(a) = _mm256_castps_si256(a);
    to_int(a) = _mm256_cvttps_epi32(a);
    -> Self, if there is an instruction:
    gather(table, indices) = _mm256_i32gather_ps::<4>(table, indices);
    -> [Self; 4], by shuffles:
    gather_rows::<K>(table, indices) = gather_rows::<K>(table, &indices);
    transpose(columns) = transpose(columns);
}

int! {
    /// Eight integers.
    U32x8(__m256i), F32x8, Mask8: 8;
    splat(x) = _mm256_set1_epi32(x);
    select(mask, a, b) = _mm256_blendv_epi8(b, a, mask);
    mul_wide(a, b) = mul_wide(a, b);
    shl(a, bits) = _mm256_sll_epi32(a, _mm_cvtsi32_si128(bits));
    shr(a, bits) = _mm256_srl_epi32(a, _mm_cvtsi32_si128(bits));
    to_real(a) = _mm256_cvtepi32_ps(a);
    wrapping_add(a, b) = _mm256_add_epi32(a, b);
    wrapping_sub(a, b) = _mm256_sub_epi32(a, b);
    wrapping_mul(a, b) = _mm256_mullo_epi32(a, b);
    -> Mask:
    eq(a, b) = _mm256_cmpeq_epi32(a, b);
    lt(a, b) = _mm256_cmpgt_epi32(flip_sign(b), flip_sign(a));
    -> Self, as operators:
    BitAnd::bitand(a, b) = _mm256_and_si256(a, b);
    BitOr::bitor(a, b) = _mm256_or_si256(a, b);
    BitXor::bitxor(a, b) = _mm256_xor_si256(a, b);
    -> Self, if there is an instruction:
    gather(table, indices) = _mm256_i32gather_epi32::<4>(table.cast(), indices);
    gather_bytes(table, indices) = _mm256_i32gather_epi32::<1>(table.cast(), indices);
    gather_halves(table, indices) = _mm256_i32gather_epi32::<2>(table.cast(), indices);
    compress(a, mask) = _mm256_permutevar8x32_epi32(a, true_lanes(mask));
}

mask! {
    /// Eight bools: all bits of a lane are set or clear.
    Mask8(__m256i): 8;
    splat(x) = _mm256_set1_epi32(-i32::from(x));
    from_bits(bits) = _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(bits), lane_bits()), lane_bits());
    bits(a) = _mm256_movemask_ps(_mm256_castsi256_ps(a)) as u32;
    -> Self, as operators:
    BitAnd::bitand(a, b) = _mm256_and_si256(a, b);
    BitOr::bitor(a, b) = _mm256_or_si256(a, b);
    BitXor::bitxor(a, b) = _mm256_xor_si256(a, b);
}

// SAFETY of what follows: only operations of the vectors above call it.

/// `K` floats from each index on, in columns, and after them others.
#[inline(always)]
unsafe fn gather_rows<const K: usize>(table: *const f32, indices: &[u32; 16]) -> [__m256; 4] {
    unsafe {
        // Half i of vector j has the row of lane 4 i + j.
        let mut rows = [_mm256_setzero_ps(); 4];
        let mut j = 0;
        while j < 4 {
            let low = _mm256_castps128_ps256(row::<K>(table.add(indices[j] as usize)));
            rows[j] = _mm256_insertf128_ps::<1>(low, row::<K>(table.add(indices[4 + j] as usize)));
            j += 1;
        }
        transpose(rows)
    }
}

/// The first `K` of four floats; no others are read.
#[inline(always)]
pub unsafe fn row<const K: usize>(from: *const f32) -> __m128 {
    unsafe {
        match K {
            4 => transmute::<[f32; 4], __m128>(*from.cast()),
            3 => _mm_maskload_ps(from, _mm_setr_epi32(-1, -1, -1, 0)),
            2 => _mm_castpd_ps(_mm_load_sd(from.cast())),
            _ => _mm_load_ss(from),
        }
    }
}

/// Transposes the matrices of four by four floats, whose rows are four lanes of each vector.
#[inline(always)]
unsafe fn transpose([a, b, c, d]: [__m256; 4]) -> [__m256; 4] {
    unsafe {
        let low = [_mm256_unpacklo_ps(a, b), _mm256_unpacklo_ps(c, d)];
        let high = [_mm256_unpackhi_ps(a, b), _mm256_unpackhi_ps(c, d)];
        [
            _mm256_shuffle_ps::<0x44>(low[0], low[1]),
            _mm256_shuffle_ps::<0xee>(low[0], low[1]),
            _mm256_shuffle_ps::<0x44>(high[0], high[1]),
            _mm256_shuffle_ps::<0xee>(high[0], high[1]),
        ]
    }
}

/// A bit for each lane.
#[inline(always)]
unsafe fn lane_bits() -> __m256i {
    unsafe { _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128) }
}

/// Comparisons are of signed integers: exchanges the lower half of all integers with the upper.
#[inline(always)]
unsafe fn flip_sign(a: __m256i) -> __m256i {
    unsafe { _mm256_xor_si256(a, _mm256_set1_epi32(i32::MIN)) }
}

/// The halves of the products, of which an instruction makes every second.
#[inline(always)]
unsafe fn mul_wide(a: __m256i, b: __m256i) -> (__m256i, __m256i) {
    unsafe {
        let even = _mm256_mul_epu32(a, b);
        let odd = _mm256_mul_epu32(_mm256_srli_epi64::<32>(a), _mm256_srli_epi64::<32>(b));
        let low = _mm256_blend_epi32::<0xaa>(even, _mm256_slli_epi64::<32>(odd));
        (low, _mm256_blend_epi32::<0xaa>(_mm256_srli_epi64::<32>(even), odd))
    }
}

/// The indices of the lanes that are true.
#[inline(always)]
unsafe fn true_lanes(mask: __m256i) -> __m256i {
    /// For each eight bits the indices of those that are set, a byte each.
    const TRUE_LANES: [u64; 256] = {
        let mut table = [0; 256];
        let mut index = 0_usize;
        while index < 8 * 256 {
            let (bits, lane) = (index / 8, index % 8);
            if bits >> lane & 1 == 1 {
                let before = (bits & ((1 << lane) - 1)).count_ones();
                table[bits] |= (lane as u64) << (8 * before);
            }
            index += 1;
        }
        table
    };
    unsafe {
        let bits = _mm256_movemask_ps(_mm256_castsi256_ps(mask)) as u8;
        _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(TRUE_LANES[usize::from(bits)] as i64))
    }
}
