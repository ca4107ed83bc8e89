//! Operations that need no dispatch: every processor of an architecture has their instructions.

#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::*;

/// Prefetches the cache line at an address, which need not be valid. Nothing happens where there
/// is no such instruction.
#[inline(always)]
pub fn prefetch<T>(address: *const T) {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: every x86-64 processor has SSE, and a prefetch reads nothing.
    unsafe {
        _mm_prefetch::<_MM_HINT_T0>(address.cast())
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = address;
}

/// The index of the first key that equals the one at index `of`.
#[inline(always)]
pub fn first_equal(keys: &[u32; 16], of: usize) -> usize {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: every x86-64 processor has SSE2; the array has as many keys as are read.
    unsafe {
        let key = _mm_set1_epi32(keys[of] as i32);
        let equal = |four: usize| _mm_cmpeq_epi32(_mm_loadu_si128(keys.as_ptr().add(4 * four).cast()), key);
        let halves = [_mm_packs_epi32(equal(0), equal(1)), _mm_packs_epi32(equal(2), equal(3))];
        _mm_movemask_epi8(_mm_packs_epi16(halves[0], halves[1])).trailing_zeros() as usize
    }
    #[cfg(not(target_arch = "x86_64"))]
    keys[..of].iter().position(|&key| key == keys[of]).unwrap_or(of)
}
