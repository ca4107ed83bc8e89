//! Accessors: arrays of vectors in a view of a buffer, as numbers of any width, with their sparse
//! changes.

use super::buffer::{Buffers, View};
use super::document::Document;
use super::json::{Place, Result};

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn parse(place: &Place, key: &str) -> Result<Self> {
        let code = place.integer(key)?.ok_or_else(|| place.invalid(format!("`{key}` is missing")))?;
        Ok(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return Err(place.invalid_member(key, format!("{code} is not a type of numbers"))),
        })
    }

    /// Its bytes.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// The number that bytes begin with.
    fn float(self, bytes: &[u8], normalized: bool) -> f32 {
        let number = match self {
            Self::I8 => f32::from(bytes[0] as i8),
            Self::U8 => f32::from(bytes[0]),
            Self::I16 => f32::from(i16::from_le_bytes([bytes[0], bytes[1]])),
            Self::U16 => f32::from(u16::from_le_bytes([bytes[0], bytes[1]])),
            Self::U32 => u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]) as f32,
            Self::F32 => return f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
        };
        if !normalized {
            return number;
        }
        match self {
            Self::I8 => (number / 127.0).max(-1.0),
            Self::U8 => number / 255.0,
            Self::I16 => (number / 32767.0).max(-1.0),
            Self::U16 => number / 65535.0,
            Self::U32 | Self::F32 => number,
        }
    }

    /// The integer that bytes begin with.
    fn integer(self, bytes: &[u8]) -> u32 {
        match self {
            Self::U8 => u32::from(bytes[0]),
            Self::U16 => u32::from(u16::from_le_bytes([bytes[0], bytes[1]])),
            _ => u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
        }
    }
}

/// An array of vectors.
pub(super) struct Accessor<'a> {
    place: Place<'a>,
    /// The number of vectors.
    pub count: usize,
    /// Numbers of a vector.
    pub width: usize,
    /// What its numbers are.
    pub component: Component,
    normalized: bool,
    /// Its data, where they are not in a view.
    unpacked: Option<Vec<u8>>,
}

const TYPES: [(&str, usize); 7] =
    [("SCALAR", 1), ("VEC2", 2), ("VEC3", 3), ("VEC4", 4), ("MAT2", 4), ("MAT3", 9), ("MAT4", 16)];

impl<'a> Accessor<'a> {
    /// The accessor that a member of an object refers to; `None` if it is absent.
    pub fn of(document: &Document<'a>, place: &Place, key: &str) -> Result<Option<Self>> {
        let Some(index) = document.index(place, key, "accessors")? else { return Ok(None) };
        Self::parse(
            document
                .item("accessors", index)
                .ok_or_else(|| place.invalid_member(key, "this is no object"))?,
        )
        .map(Some)
    }

    /// Reads the description of an accessor, without its data.
    pub fn parse(place: Place<'a>) -> Result<Self> {
        let count = place.integer("count")?.ok_or_else(|| place.invalid("`count` is missing"))?;
        if count == 0 {
            return Err(place.invalid_member("count", "an accessor has at least one element"));
        }
        let name = place.string("type")?.ok_or_else(|| place.invalid("`type` is missing"))?;
        let Some(&(_, width)) = TYPES.iter().find(|(known, _)| *known == name) else {
            return Err(place.invalid_member("type", format!("`{name}` is not a type of vectors")));
        };
        let component = Component::parse(&place, "componentType")?;
        if name.starts_with("MAT") && component != Component::F32 {
            return Err(place.invalid_member("componentType", "matrices are read as floats only"));
        }
        let normalized = place.boolean("normalized", false)?;
        Ok(Self { count, width, component, normalized, unpacked: None, place })
    }

    /// The same with data that are not in a view, but were unpacked; as many as these are.
    pub fn with_data(self, unpacked: Vec<u8>) -> Self {
        let count = unpacked.len() / (self.width * self.component.size());
        Self { count, unpacked: Some(unpacked), ..self }
    }

    /// The same with integers that stand for numbers in [0, 1] or [−1, 1].
    pub fn with_normalized(self) -> Self {
        Self { normalized: true, ..self }
    }

    /// Whether any of its numbers are in the file; else all are zero.
    pub fn has_data(&self) -> bool {
        self.place.get("bufferView").is_some() || self.place.get("sparse").is_some()
    }

    /// Whether its numbers are floats.
    pub fn is_float(&self) -> bool {
        self.component == Component::F32
    }

    /// Whether its integers stand for numbers in [0, 1] or [−1, 1].
    pub fn is_normalized(&self) -> bool {
        self.normalized
    }

    fn check_width(&self, width: usize) -> Result<()> {
        if self.width == width {
            return Ok(());
        }
        Err(self.place.invalid_member(
            "type",
            format!("vectors of {width} numbers are needed here, not {}", self.width),
        ))
    }

    /// Its vectors as floats.
    pub fn vectors<const N: usize>(&self, buffers: &Buffers) -> Result<Vec<[f32; N]>> {
        self.check_width(N)?;
        let component = self.component;
        let read = |bytes: &[u8]| {
            std::array::from_fn(|i| component.float(&bytes[i * component.size()..], self.normalized))
        };
        let vectors = self.read(buffers, [0.0; N], read)?;
        if let Some(index) =
            vectors.iter().position(|vector: &[f32; N]| !vector.iter().all(|v| v.is_finite()))
        {
            return Err(self.place.invalid(format!("element {index} is not finite")));
        }
        Ok(vectors)
    }

    /// Its numbers, which are integers without a sign.
    pub fn integers<const N: usize>(&self, buffers: &Buffers) -> Result<Vec<[u32; N]>> {
        self.check_width(N)?;
        let component = self.component;
        if !matches!(component, Component::U8 | Component::U16 | Component::U32) || self.normalized {
            return Err(self
                .place
                .invalid_member("componentType", "integers without a sign are needed here"));
        }
        let read = |bytes: &[u8]| std::array::from_fn(|i| component.integer(&bytes[i * component.size()..]));
        self.read(buffers, [0; N], read)
    }

    fn read<T: Copy>(&self, buffers: &Buffers, zero: T, read: impl Fn(&[u8]) -> T) -> Result<Vec<T>> {
        let size = self.width * self.component.size();
        buffers.spend(&self.place, self.count as u64 * size_of::<T>() as u64)?;
        let mut values = match (&self.unpacked, buffers.view(&self.place, "bufferView")?) {
            (Some(unpacked), _) => unpacked.chunks_exact(size).map(&read).collect(),
            (None, Some(view)) => {
                let elements = Elements::new(&self.place, view, self.count, size)?;
                (0..self.count).map(|index| read(elements.get(index))).collect()
            }
            (None, None) => vec![zero; self.count],
        };
        if let Some(sparse) = self.place.object("sparse")? {
            self.change(&sparse, buffers, &mut values, size, read)?;
        }
        Ok(values)
    }

    /// Applies the sparse changes.
    fn change<T>(
        &self,
        sparse: &Place,
        buffers: &Buffers,
        values: &mut [T],
        size: usize,
        read: impl Fn(&[u8]) -> T,
    ) -> Result<()> {
        let count = sparse.integer("count")?.ok_or_else(|| sparse.invalid("`count` is missing"))?;
        if count == 0 || count > self.count {
            let message = format!("{count} elements cannot be changed of {}", self.count);
            return Err(sparse.invalid_member("count", message));
        }
        let (indices, changed) = (sparse.required("indices")?, sparse.required("values")?);
        let component = Component::parse(&indices, "componentType")?;
        if !matches!(component, Component::U8 | Component::U16 | Component::U32) {
            return Err(indices.invalid_member("componentType", "integers without a sign are needed here"));
        }
        let view = |place: &Place| {
            buffers.view(place, "bufferView")?.ok_or_else(|| place.invalid("`bufferView` is missing"))
        };
        let at = Elements::new(&indices, view(&indices)?, count, component.size())?;
        let elements = Elements::new(&changed, view(&changed)?, count, size)?;
        for change in 0..count {
            let index = component.integer(at.get(change)) as usize;
            let Some(value) = values.get_mut(index) else {
                return Err(indices.invalid(format!("there is no element {index} of {}", self.count)));
            };
            *value = read(elements.get(change));
        }
        Ok(())
    }
}

/// Elements of the same size in a view.
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
}

impl<'a> Elements<'a> {
    fn new(place: &Place, view: &'a View, count: usize, size: usize) -> Result<Self> {
        let offset = place.integer("byteOffset")?.unwrap_or(0);
        let stride = view.stride.unwrap_or(size);
        if stride < size {
            return Err(place.invalid(format!("elements of {size} bytes do not fit a stride of {stride}")));
        }
        let bytes = view.bytes();
        let end =
            (count - 1).checked_mul(stride).and_then(|last| last.checked_add(size)?.checked_add(offset));
        match end.filter(|&end| end <= bytes.len()) {
            Some(_) => Ok(Self { bytes: &bytes[offset..], stride, size }),
            None => {
                let message =
                    format!("{count} elements reach beyond the buffer view, which has {} bytes", bytes.len());
                Err(place.invalid(message))
            }
        }
    }

    fn get(&self, index: usize) -> &'a [u8] {
        let start = index * self.stride;
        &self.bytes[start..start + self.size]
    }
}
