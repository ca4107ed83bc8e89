//! Fallible allocation of pixels.

use crate::ImageError;

/// An empty array with a capacity of `count` values; refused where there is no memory for them.
pub(crate) fn reserved<T>(count: usize) -> Result<Vec<T>, ImageError> {
    let mut values = Vec::new();
    values.try_reserve_exact(count).map_err(|_| no_memory(count.saturating_mul(size_of::<T>())))?;
    Ok(values)
}

/// An array of `count` equal values; refused where there is no memory for it.
pub(crate) fn filled<T: Clone>(count: usize, value: T) -> Result<Vec<T>, ImageError> {
    let mut values = reserved(count)?;
    values.resize(count, value);
    Ok(values)
}

/// The first `count` of these values as an array; refused where there is no memory for it.
pub(crate) fn collected<T>(count: usize, values: impl Iterator<Item = T>) -> Result<Vec<T>, ImageError> {
    let mut array = reserved(count)?;
    array.extend(values.take(count));
    Ok(array)
}

/// Refused where `bytes` bytes cannot be allocated now. To be checked before allocations whose
/// failure would abort the program.
pub fn require_memory(bytes: usize) -> Result<(), ImageError> {
    let mut memory = Vec::<u8>::new();
    let reserved = memory.try_reserve_exact(bytes);
    // The optimiser removes allocations that nothing uses, with their failure.
    std::hint::black_box(&memory);
    reserved.map_err(|_| ImageError::Limits(format!("no memory for {bytes} bytes")))
}

fn no_memory(bytes: usize) -> ImageError {
    ImageError::Limits(format!("no memory for {bytes} bytes of pixels"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_that_is_not_there_is_an_error() {
        const COUNT: usize = isize::MAX as usize / 16;
        // Arrays that nothing uses are not allocated in release builds.
        let used = |array: Vec<f32>| drop(std::hint::black_box(array));
        for refused in [
            reserved::<f32>(COUNT).map(used),
            filled(COUNT, 0.0_f32).map(used),
            collected(COUNT, std::iter::repeat(0.0_f32)).map(used),
            reserved::<f32>(usize::MAX).map(used),
            require_memory(COUNT),
        ] {
            assert!(matches!(refused, Err(ImageError::Limits(_))), "{refused:?}");
        }
        assert_eq!(collected(2, 0..9).unwrap(), [0, 1]);
        assert_eq!(filled(2, 7).unwrap(), [7, 7]);
    }
}
