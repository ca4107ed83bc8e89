//! The vectors of AVX2 with twice the registers. Comparisons stay vectors: bits from masks take longer.

use super::avx2::{Avx2, Eight, Four};
use super::{Simd, Task};
use std::arch::x86_64::*;

/// See [`super::InstructionSet::Avx512`].
#[derive(Clone, Copy)]
pub(crate) struct Avx512;

impl Simd for Avx512 {
    type Four = Four;
    type Eight = Eight;

    #[inline(always)]
    fn pick<const BYTE: usize>(from: Eight, places: &[u32; 4]) -> Four {
        Avx2::pick::<BYTE>(from, places)
    }

    #[inline(always)]
    fn prefetch(address: *const u8) {
        // SAFETY: every x86-64 processor has SSE, and this reads nothing.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(address.cast()) }
    }
}

/// Runs a task.
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi1,bmi2,popcnt,lzcnt")]
pub unsafe fn run<T: Task>(task: T) -> T::Output {
    // SAFETY: who calls this has the instructions.
    unsafe { task.run::<Avx512>() }
}
