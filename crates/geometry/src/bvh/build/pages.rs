//! Room for long arrays, in large pages of memory.
//!
//! Memory is handed out by the page when it is first written to, and each page costs about a
//! microsecond: in pages of 4 KiB a quarter of the time in which a tree is built in a hurry, and
//! later more entries of the page table than a processor remembers when rays go through the tree.
//! Linux gives pages of 2 MiB to who asks for them.

#![allow(unsafe_code)]

/// An empty vector with room for so many.
pub(super) fn room<T>(capacity: usize) -> Vec<T> {
    let list = Vec::with_capacity(capacity);
    #[cfg(target_os = "linux")]
    ask_for_large_pages(&list);
    list
}

/// So many of one value.
pub(super) fn filled<T: Clone>(value: T, len: usize) -> Vec<T> {
    let mut list = room(len);
    list.resize(len, value);
    list
}

/// Asks for large pages where whole ones lie in the vector's room, so that none takes memory that
/// is not asked for already.
#[cfg(target_os = "linux")]
fn ask_for_large_pages<T>(list: &Vec<T>) {
    const PAGE: usize = 2 << 20;
    let bytes = list.capacity() * size_of::<T>();
    let before = list.as_ptr().addr().wrapping_neg() % PAGE;
    if bytes < before + PAGE {
        return;
    }
    let first = list.as_ptr().wrapping_byte_add(before).cast_mut().cast();
    // SAFETY: these bytes belong to the vector, and the advice changes nothing in them. A system
    // that cannot follow it, which is what an error would tell, gives small pages.
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
            assert!(room::<u64>(len).capacity() >= len);
        }
    }
}
