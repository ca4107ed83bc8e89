//! Long arrays in huge pages, which can be freed in parts.
//!
//! The first write to a page faults, which costs about a microsecond: with pages of 4 KiB, a
//! quarter of the build time at [`super::BuildQuality::Fast`]. Traversal then misses the TLB more
//! often. Linux gives huge pages of 2 MiB on request.

#![allow(unsafe_code)]

use std::alloc::{Layout, alloc_zeroed, handle_alloc_error};

/// An empty vector of a capacity, in huge pages.
pub(super) fn with_capacity<T>(capacity: usize) -> Vec<T> {
    let list = Vec::with_capacity(capacity);
    advise(list.as_ptr(), list.capacity(), Advice::MakeHuge);
    list
}

/// A vector of `len` copies of a value, in huge pages.
pub(super) fn filled<T: Clone>(value: T, len: usize) -> Vec<T> {
    let mut list = with_capacity(len);
    list.resize(len, value);
    list
}

/// Types for which all bits zero is a valid value.
///
/// # Safety
/// All bits zero must be a valid value.
pub(super) unsafe trait Zeroable: Copy {}

// SAFETY: any bits are valid integers.
unsafe impl Zeroable for [u32; 2] {}

/// A vector of values whose bits are zero, in huge pages. A page takes no memory until it is first
/// written to.
pub(super) fn zeroed<T: Zeroable>(len: usize) -> Vec<T> {
    let layout = Layout::array::<T>(len).expect("invariant: arrays fit in the address space");
    if layout.size() == 0 {
        return Vec::new();
    }
    // SAFETY: the layout is that of a vector of this capacity, and not empty. All bits zero is a
    // valid `T`.
    let list = unsafe {
        let first = alloc_zeroed(layout);
        if first.is_null() {
            handle_alloc_error(layout);
        }
        Vec::from_raw_parts(first.cast(), len, len)
    };
    advise(list.as_ptr(), len, Advice::MakeHuge);
    list
}

/// Returns the memory of values that are no longer needed to the system; some of them become zero.
/// A short list is not worth the system call and keeps its memory.
pub(super) fn release<T: Zeroable>(list: &mut [T]) {
    const SHORT: usize = 512 << 10;
    if size_of_val(list) >= SHORT {
        advise(list.as_ptr(), list.len(), Advice::Release);
    }
}

/// Advice to Linux about pages.
enum Advice {
    MakeHuge,
    Release,
}

/// Advises Linux about the pages that lie wholly among `len` values.
#[cfg(target_os = "linux")]
fn advise<T>(first: *const T, len: usize, advice: Advice) {
    // Small pages have 64 KiB at most.
    let (page, advice) = match advice {
        Advice::MakeHuge => (2 << 20, libc::MADV_HUGEPAGE),
        Advice::Release => (64 << 10, libc::MADV_DONTNEED),
    };
    let bytes = len * size_of::<T>();
    let before = first.addr().wrapping_neg() % page;
    if bytes < before + page {
        return;
    }
    let first = first.wrapping_byte_add(before).cast_mut().cast();
    // SAFETY: callers own these bytes. Asking for huge pages does not change them, and released
    // bytes may become zero. An error means that the advice is not taken, which is harmless.
    unsafe { libc::madvise(first, (bytes - before) / page * page, advice) };
}

#[cfg(not(target_os = "linux"))]
fn advise<T>(_: *const T, _: usize, _: Advice) {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_are_filled() {
        for len in [0, 1, 1000, 3 << 20] {
            let list = filled([1u8, 2, 3], len);
            assert_eq!(list.len(), len);
            assert!(list.iter().all(|&at| at == [1, 2, 3]));
            assert!(with_capacity::<u64>(len).capacity() >= len);
        }
    }

    #[test]
    fn released_values_are_zero_and_others_are_kept() {
        let mut list = zeroed::<[u32; 2]>(3 << 20);
        assert!(list.iter().all(|&at| at == [0; 2]));
        list.fill([1, 2]);
        let (released, kept) = list.split_at_mut(2 << 20);
        release(released);
        assert!(released.iter().all(|&at| at == [0; 2] || at == [1, 2]));
        assert!(kept.iter().all(|&at| at == [1, 2]));
        #[cfg(target_os = "linux")]
        assert!(released.contains(&[0; 2]));
    }
}
