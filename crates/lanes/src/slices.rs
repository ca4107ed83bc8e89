//! What vectors read and write of slices.

#[cfg(target_arch = "x86_64")]
use crate::{Int, MAX_LANES, Mask};

/// The first `N` elements of a slice.
#[inline(always)]
pub fn lanes<T, const N: usize>(from: &[T]) -> &[T; N] {
    from.first_chunk().expect("an element for each lane")
}

/// The first `N` elements of a slice.
#[inline(always)]
pub fn lanes_mut<T, const N: usize>(to: &mut [T]) -> &mut [T; N] {
    to.first_chunk_mut().expect("an element for each lane")
}

/// Whether all indices lie in a table of that length, and below 2³¹: the instructions take them as
/// signed integers.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub fn are_inside(length: usize, indices: impl Int) -> bool {
    indices.lt(Int::splat(length.min(1 << 31) as u32)).all()
}

/// The elements at the first `N` indices, read one by one.
#[cfg(target_arch = "x86_64")]
#[cold]
#[inline(never)]
pub fn gather_each<T: Copy, const N: usize>(table: &[T], indices: &[u32]) -> [T; N] {
    std::array::from_fn(|lane| table[indices[lane] as usize])
}

/// `K` numbers from each index on, read one by one.
#[cfg(target_arch = "x86_64")]
#[cold]
#[inline(never)]
pub fn gather_rows_each<const K: usize>(table: &[f32], indices: &[u32]) -> [[f32; MAX_LANES]; K] {
    let mut columns = [[0.0; MAX_LANES]; K];
    for (lane, &index) in indices.iter().enumerate() {
        let row = &table[index as usize..][..K];
        columns.iter_mut().zip(row).for_each(|(column, &number)| column[lane] = number);
    }
    columns
}

/// Four bytes from each index on, read one by one.
#[cfg(target_arch = "x86_64")]
#[cold]
#[inline(never)]
pub fn gather_bytes(table: &[u8], indices: &[u32]) -> [u32; MAX_LANES] {
    crate::real::gather_bytes(table, indices)
}
