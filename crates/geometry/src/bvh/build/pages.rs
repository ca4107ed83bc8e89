//! Long arrays in huge pages.
//!
//! The first write to a page faults, which costs about a microsecond: with pages of 4 KiB, a
//! quarter of the build time at [`super::BuildQuality::Fast`]. Traversal then misses the TLB more
//! often. Linux gives huge pages of 2 MiB on request.

#![allow(unsafe_code)]

/// An empty vector of a capacity, in huge pages.
pub(super) fn with_capacity<T>(capacity: usize) -> Vec<T> {
    let list = Vec::with_capacity(capacity);
    #[cfg(target_os = "linux")]
    request_huge_pages(&list);
    list
}

/// A vector of `len` copies of a value, in huge pages.
pub(super) fn filled<T: Clone>(value: T, len: usize) -> Vec<T> {
    let mut list = with_capacity(len);
    list.resize(len, value);
    list
}

/// Requests huge pages where whole ones lie in the vector's capacity, so that no more memory is
/// used.
#[cfg(target_os = "linux")]
fn request_huge_pages<T>(list: &Vec<T>) {
    const PAGE: usize = 2 << 20;
    let bytes = list.capacity() * size_of::<T>();
    let before = list.as_ptr().addr().wrapping_neg() % PAGE;
    if bytes < before + PAGE {
        return;
    }
    let first = list.as_ptr().wrapping_byte_add(before).cast_mut().cast();
    // SAFETY: these bytes belong to the vector, and the advice does not change them. An error means
    // that the system gives small pages, which is fine.
    unsafe { libc::madvise(first, (bytes - before) / PAGE * PAGE, libc::MADV_HUGEPAGE) };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_hold_what_they_are_filled_with() {
        for len in [0, 1, 1000, 3 << 20] {
            let list = filled([1u8, 2, 3], len);
            assert_eq!(list.len(), len);
            assert!(list.iter().all(|&at| at == [1, 2, 3]));
            assert!(with_capacity::<u64>(len).capacity() >= len);
        }
    }
}
