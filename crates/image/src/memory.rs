//! Memory for pixels, which may not be there.

use crate::ImageError;

/// An empty array with room for so many values; refused where there is no memory for them.
pub(crate) fn reserved<T>(count: usize) -> Result<Vec<T>, ImageError> {
    let mut values = Vec::new();
    values.try_reserve_exact(count).map_err(|_| no_memory(count.saturating_mul(size_of::<T>())))?;
    Ok(values)
}

/// An array of so many equal values; refused where there is no memory for it.
pub(crate) fn filled<T: Clone>(count: usize, value: T) -> Result<Vec<T>, ImageError> {
    let mut values = reserved(count)?;
    values.resize(count, value);
    Ok(values)
}

/// These values, so many of them, in an array; refused where there is no memory for it.
pub(crate) fn collected<T>(count: usize, values: impl Iterator<Item = T>) -> Result<Vec<T>, ImageError> {
    let mut array = reserved(count)?;
    array.extend(values.take(count));
    Ok(array)
}

/// Refuses work that takes so many bytes where there is no memory for them now.
pub fn require_memory(bytes: usize) -> Result<(), ImageError> {
    reserved::<u8>(bytes).map(drop)
}

fn no_memory(bytes: usize) -> ImageError {
    ImageError::Limits(format!("no memory for {bytes} bytes of pixels"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_without_memory_is_refused() {
        assert!(require_memory(1 << 20).is_ok());
        assert!(matches!(require_memory(1 << 62), Err(ImageError::Limits(_))));
    }
}
