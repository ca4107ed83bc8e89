//! Values of PLY files, as text or binary.

use super::header::{PropertyKind, Scalar};
use crate::mesh::{MeshError, invalid};
use crate::number;

/// The values after the header.
pub(super) trait Body: Copy {
    /// Whether binary numbers begin with their highest byte.
    const BIG: bool;

    /// The minimal number of bytes of a value of a type.
    fn least_size(scalar: Scalar) -> usize;

    /// The number of bytes that are left.
    fn left(&self) -> usize;

    /// The next value.
    fn read(&mut self, scalar: Scalar) -> Result<f64, MeshError>;

    /// The next `size` bytes; `None` where values are text, or there are not as many.
    fn take(&mut self, size: usize) -> Option<&[u8]>;

    /// Reads at most `most` faces, while they are triangles of vertices below `vertices`: a count
    /// of one byte and three indices of four. None where values are text.
    fn take_triangles(&mut self, most: usize, vertices: usize, triangles: &mut Vec<[u32; 3]>);

    /// The number of items of a list, checked against the bytes that are left.
    fn list_length(&mut self, count: Scalar, item: Scalar) -> Result<usize, MeshError> {
        let length = self.read(count)?;
        if length < 0.0 || length.fract() != 0.0 {
            return invalid(format!("a list has {length} items"));
        }
        if length * Self::least_size(item) as f64 > self.left() as f64 {
            return Err(MeshError::Limits(format!(
                "a list of {length} items cannot lie in {} bytes",
                self.left()
            )));
        }
        Ok(length as usize)
    }

    /// Passes the value of a property.
    fn skip(&mut self, kind: &PropertyKind) -> Result<(), MeshError> {
        match *kind {
            PropertyKind::Scalar(scalar) => _ = self.read(scalar)?,
            PropertyKind::List { count, item } => {
                for _ in 0..self.list_length(count, item)? {
                    self.read(item)?;
                }
            }
        }
        Ok(())
    }
}

/// Binary values.
#[derive(Clone, Copy)]
pub(super) struct Binary<'a, const BIG: bool> {
    pub bytes: &'a [u8],
}

impl<const BIG: bool> Body for Binary<'_, BIG> {
    const BIG: bool = BIG;

    fn least_size(scalar: Scalar) -> usize {
        scalar.size()
    }

    fn left(&self) -> usize {
        self.bytes.len()
    }

    #[inline]
    fn read(&mut self, scalar: Scalar) -> Result<f64, MeshError> {
        macro_rules! number {
            ($type:ty) => {{
                let Some((bytes, rest)) = self.bytes.split_first_chunk() else { return too_short() };
                self.bytes = rest;
                f64::from(if BIG { <$type>::from_be_bytes(*bytes) } else { <$type>::from_le_bytes(*bytes) })
            }};
        }
        Ok(match scalar {
            Scalar::I8 => number!(i8),
            Scalar::U8 => number!(u8),
            Scalar::I16 => number!(i16),
            Scalar::U16 => number!(u16),
            Scalar::I32 => number!(i32),
            Scalar::U32 => number!(u32),
            Scalar::F32 => number!(f32),
            Scalar::F64 => number!(f64),
        })
    }

    fn take(&mut self, size: usize) -> Option<&[u8]> {
        let (taken, rest) = self.bytes.split_at_checked(size)?;
        self.bytes = rest;
        Some(taken)
    }

    fn take_triangles(&mut self, most: usize, vertices: usize, triangles: &mut Vec<[u32; 3]>) {
        for _ in 0..most {
            let Some((&[3, ref corners @ ..], rest)) = self.bytes.split_first_chunk::<13>() else { return };
            let corners: [[u8; 4]; 3] = std::array::from_fn(|c| std::array::from_fn(|i| corners[4 * c + i]));
            let triangle =
                corners.map(|bytes| if BIG { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) });
            if triangle.iter().any(|&corner| corner as usize >= vertices) {
                return;
            }
            triangles.push(triangle);
            self.bytes = rest;
        }
    }
}

/// Values as text, in which some may be infinite or no numbers.
#[derive(Clone, Copy)]
pub(super) struct Ascii<'a> {
    pub text: &'a [u8],
}

impl Body for Ascii<'_> {
    const BIG: bool = false;

    fn least_size(_: Scalar) -> usize {
        1
    }

    fn left(&self) -> usize {
        self.text.len()
    }

    fn read(&mut self, _: Scalar) -> Result<f64, MeshError> {
        let start = self.text.iter().position(|byte| !byte.is_ascii_whitespace()).unwrap_or(self.text.len());
        let text = &self.text[start..];
        let end = text.iter().position(u8::is_ascii_whitespace).unwrap_or(text.len());
        if end == 0 {
            return too_short();
        }
        self.text = &text[end..];
        match number::lenient(&text[..end]) {
            Some(value) => Ok(value),
            None => invalid(format!("`{:.40}` is not a number", String::from_utf8_lossy(&text[..end]))),
        }
    }

    fn take(&mut self, _: usize) -> Option<&[u8]> {
        None
    }

    fn take_triangles(&mut self, _: usize, _: usize, _: &mut Vec<[u32; 3]>) {}
}

fn too_short<T>() -> Result<T, MeshError> {
    invalid("the file ends before its last value")
}
