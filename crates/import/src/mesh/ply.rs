//! The Stanford polygon format PLY: a text header that names elements and their properties, then
//! their values as text or as binary numbers of either byte order [Turk 1994].
//!
//! Vertices have `x y z`, optionally `nx ny nz`, and texture coordinates as `u v`, `s t`,
//! `texture_u texture_v` or `texture_s texture_t`; faces a list `vertex_indices` or `vertex_index`,
//! and optionally a number `face_indices`. Instead of faces there may be `tristrips`: triangle
//! strips separated by −1. All other properties and elements are skipped.

use math::{Vec2, Vec3};

use super::{Mesh, MeshError, invalid};
use crate::number;

/// Reads a PLY file.
pub fn read_ply(bytes: &[u8]) -> Result<Mesh, MeshError> {
    let (header, body) = header(bytes)?;
    match header.format {
        Encoding::Ascii => read_body(&header, Ascii { text: body }),
        Encoding::LittleEndian => read_body(&header, Binary::<false> { bytes: body }),
        Encoding::BigEndian => read_body(&header, Binary::<true> { bytes: body }),
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

#[derive(Clone, Copy, PartialEq)]
enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn from_name(name: &str) -> Result<Self, MeshError> {
        Ok(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return invalid(format!("there is no property type `{name:.40}`")),
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

enum PropertyKind {
    Scalar(Scalar),
    List { count: Scalar, item: Scalar },
}

struct Property {
    name: String,
    kind: PropertyKind,
}

struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

struct Header {
    format: Encoding,
    elements: Vec<Element>,
}

/// The header of a file, and the bytes after it.
fn header(bytes: &[u8]) -> Result<(Header, &[u8]), MeshError> {
    let mut rest = bytes;
    let mut line = || -> Result<&str, MeshError> {
        let Some(end) = rest.iter().position(|&byte| byte == b'\n') else {
            return invalid("the header has no end");
        };
        let (line, after) = (&rest[..end], &rest[end + 1..]);
        rest = after;
        std::str::from_utf8(line).map(str::trim).or_else(|_| invalid("the header is not text"))
    };
    if line()? != "ply" {
        return invalid("the first line is not `ply`");
    }
    let (mut format, mut elements) = (None, Vec::<Element>::new());
    loop {
        let line = line()?;
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        match (words.as_slice(), elements.last_mut()) {
            ([] | ["comment" | "obj_info", ..], _) => (),
            (["end_header"], _) => break,
            (["format", name, "1.0"], _) => {
                format = Some(match *name {
                    "ascii" => Encoding::Ascii,
                    "binary_little_endian" => Encoding::LittleEndian,
                    "binary_big_endian" => Encoding::BigEndian,
                    _ => return invalid(format!("there is no format `{name:.40}`")),
                });
            }
            (["element", name, count], _) => {
                let Ok(count) = count.parse() else {
                    return invalid(format!("`{count:.40}` is not a count"));
                };
                elements.push(Element { name: (*name).into(), count, properties: Vec::new() });
            }
            (["property", "list", count, item, name], Some(element)) => {
                let kind =
                    PropertyKind::List { count: Scalar::from_name(count)?, item: Scalar::from_name(item)? };
                element.properties.push(Property { name: (*name).into(), kind });
            }
            (["property", kind, name], Some(element)) => {
                let kind = PropertyKind::Scalar(Scalar::from_name(kind)?);
                element.properties.push(Property { name: (*name).into(), kind });
            }
            _ => return invalid(format!("the header has the line `{line:.60}`")),
        }
    }
    match format {
        Some(format) => Ok((Header { format, elements }, rest)),
        None => invalid("the header names no format"),
    }
}

/// The values after the header.
trait Body: Copy {
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
}

#[derive(Clone, Copy)]
struct Binary<'a, const BIG: bool> {
    bytes: &'a [u8],
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

#[derive(Clone, Copy)]
struct Ascii<'a> {
    text: &'a [u8],
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
        match number::double(&text[..end]) {
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

fn read_body<B: Body>(header: &Header, mut body: B) -> Result<Mesh, MeshError> {
    let mut mesh = Mesh::default();
    // Faces that stand before the vertices, which nearly no file has, are read after them.
    let mut early_faces = None;
    for element in &header.elements {
        check_size::<B>(element, body.left())?;
        let has_faces = early_faces.is_some() || !mesh.triangles.is_empty() || !mesh.quads.is_empty();
        match element.name.as_str() {
            "vertex" if mesh.positions.is_empty() => read_vertices(element, &mut body, &mut mesh)?,
            "face" | "tristrips" if !has_faces && mesh.positions.is_empty() => {
                early_faces = Some((element, body));
                skip(element, &mut body)?;
            }
            "face" | "tristrips" if !has_faces => read_faces(element, &mut body, &mut mesh)?,
            _ => skip(element, &mut body)?,
        }
    }
    if let Some((element, mut body)) = early_faces {
        read_faces(element, &mut body, &mut mesh)?;
    }
    if mesh.triangles.is_empty() && mesh.quads.is_empty() {
        return Err(MeshError::Unsupported("it has no faces".into()));
    }
    Ok(mesh)
}

/// Refuses an element that does not fit in the bytes that are left.
fn check_size<B: Body>(element: &Element, left: usize) -> Result<(), MeshError> {
    let row: usize = element
        .properties
        .iter()
        .map(|property| match property.kind {
            PropertyKind::Scalar(scalar) | PropertyKind::List { count: scalar, .. } => B::least_size(scalar),
        })
        .sum();
    if element.count as u128 * row as u128 > left as u128 {
        let text = format!("{} elements of `{:.40}` do not fit in {left} bytes", element.count, element.name);
        return Err(MeshError::Limits(text));
    }
    Ok(())
}

/// The number of items of a list, checked against the bytes that are left.
fn list_length<B: Body>(body: &mut B, count: Scalar, item: Scalar) -> Result<usize, MeshError> {
    let length = body.read(count)?;
    if length < 0.0 || length.fract() != 0.0 {
        return invalid(format!("a list has {length} items"));
    }
    if length * B::least_size(item) as f64 > body.left() as f64 {
        return Err(MeshError::Limits(format!(
            "a list of {length} items cannot lie in {} bytes",
            body.left()
        )));
    }
    Ok(length as usize)
}

fn skip_property<B: Body>(property: &Property, body: &mut B) -> Result<(), MeshError> {
    match property.kind {
        PropertyKind::Scalar(scalar) => _ = body.read(scalar)?,
        PropertyKind::List { count, item } => {
            for _ in 0..list_length(body, count, item)? {
                body.read(item)?;
            }
        }
    }
    Ok(())
}

fn skip<B: Body>(element: &Element, body: &mut B) -> Result<(), MeshError> {
    if element.properties.is_empty() {
        return Ok(());
    }
    for _ in 0..element.count {
        for property in &element.properties {
            skip_property(property, body)?;
        }
    }
    Ok(())
}

fn read_vertices<B: Body>(element: &Element, body: &mut B, mesh: &mut Mesh) -> Result<(), MeshError> {
    /// Where a vertex property goes: position, normal, texture coordinates.
    const SLOTS: [&[&str]; 8] = [
        &["x"],
        &["y"],
        &["z"],
        &["nx"],
        &["ny"],
        &["nz"],
        &["u", "s", "texture_u", "texture_s"],
        &["v", "t", "texture_v", "texture_t"],
    ];
    let slot_of =
        |property: &Property| SLOTS.iter().position(|names| names.contains(&property.name.as_str()));
    let slots: Vec<Option<usize>> = element.properties.iter().map(slot_of).collect();
    let has = |slot: usize| slots.contains(&Some(slot));
    for (property, slot) in element.properties.iter().zip(&slots) {
        if slot.is_some() && matches!(property.kind, PropertyKind::List { .. }) {
            return invalid(format!("the vertex property `{}` is a list", property.name));
        }
    }
    if !(has(0) && has(1) && has(2)) {
        return invalid("the vertices have no properties `x`, `y` and `z`");
    }
    let (has_normals, has_uvs) = (has(3) && has(4) && has(5), has(6) && has(7));
    mesh.positions.reserve_exact(element.count);
    mesh.normals.reserve_exact(if has_normals { element.count } else { 0 });
    mesh.uvs.reserve_exact(if has_uvs { element.count } else { 0 });
    if let Some(layout) = FloatLayout::new(element, &slots, has_normals, has_uvs)
        && let Some(bytes) = element.count.checked_mul(layout.size).and_then(|size| body.take(size))
    {
        return layout.read::<B>(bytes, mesh);
    }
    for _ in 0..element.count {
        let mut values = [0.0_f32; 8];
        for (property, slot) in element.properties.iter().zip(&slots) {
            match (slot, &property.kind) {
                (Some(slot), &PropertyKind::Scalar(scalar)) => values[*slot] = body.read(scalar)? as f32,
                _ => skip_property(property, body)?,
            }
        }
        let [x, y, z, nx, ny, nz, u, v] = values;
        let position = Vec3::new(x, y, z);
        if !position.is_finite() {
            return not_finite();
        }
        mesh.positions.push(position);
        if has_normals {
            mesh.normals.push(Vec3::new(nx, ny, nz));
        }
        if has_uvs {
            mesh.uvs.push(Vec2::new(u, v));
        }
    }
    Ok(())
}

fn not_finite<T>() -> Result<T, MeshError> {
    invalid("a vertex position is not finite")
}

/// Vertices as nearly all binary files have them: rows of one size, in which the coordinates of a
/// position, a normal and texture coordinates are single floats side by side.
struct FloatLayout {
    /// Bytes of a row.
    size: usize,
    /// Where in a row each begins.
    position: usize,
    normal: Option<usize>,
    uv: Option<usize>,
}

impl FloatLayout {
    /// The layout of the vertices' properties, of which `slots` tells what they are.
    fn new(element: &Element, slots: &[Option<usize>], has_normals: bool, has_uvs: bool) -> Option<Self> {
        let (mut size, mut offsets) = (0, [None; 8]);
        for (property, slot) in element.properties.iter().zip(slots) {
            let PropertyKind::Scalar(scalar) = property.kind else { return None };
            if let Some(slot) = slot {
                offsets[*slot] = Some(size).filter(|_| scalar == Scalar::F32);
            }
            size += scalar.size();
        }
        let run = |slots: &[Option<usize>]| {
            let first = slots[0]?;
            slots.iter().enumerate().all(|(i, at)| *at == Some(first + 4 * i)).then_some(first)
        };
        let position = run(&offsets[..3])?;
        let normal = if has_normals { Some(run(&offsets[3..6])?) } else { None };
        let uv = if has_uvs { Some(run(&offsets[6..])?) } else { None };
        Some(Self { size, position, normal, uv })
    }

    fn read<B: Body>(&self, bytes: &[u8], mesh: &mut Mesh) -> Result<(), MeshError> {
        mesh.positions.extend(self.floats::<B, 3>(bytes, self.position).map(Vec3::from));
        if let Some(offset) = self.normal {
            mesh.normals.extend(self.floats::<B, 3>(bytes, offset).map(Vec3::from));
        }
        if let Some(offset) = self.uv {
            mesh.uvs.extend(self.floats::<B, 2>(bytes, offset).map(Vec2::from));
        }
        if mesh.positions.iter().all(|position| position.is_finite()) { Ok(()) } else { not_finite() }
    }

    /// The `N` floats at an offset of each row.
    fn floats<B: Body, const N: usize>(&self, bytes: &[u8], offset: usize) -> impl Iterator<Item = [f32; N]> {
        bytes.chunks_exact(self.size).map(move |row| {
            let values = row[offset..offset + 4 * N].as_chunks().0;
            std::array::from_fn(|i| {
                if B::BIG { f32::from_be_bytes(values[i]) } else { f32::from_le_bytes(values[i]) }
            })
        })
    }
}

fn read_faces<B: Body>(element: &Element, body: &mut B, mesh: &mut Mesh) -> Result<(), MeshError> {
    match element.name.as_str() {
        "tristrips" => read_strips(element, body, mesh),
        _ => read_polygons(element, body, mesh),
    }
}

/// The vertex index of a corner, checked.
fn vertex(corner: f64, mesh: &Mesh) -> Result<u32, MeshError> {
    let vertices = mesh.positions.len();
    match corner >= 0.0 && corner.fract() == 0.0 && corner < vertices as f64 {
        true => Ok(corner as u32),
        false => invalid(format!("a face has vertex index {corner}, but there are {vertices} vertices")),
    }
}

fn read_polygons<B: Body>(element: &Element, body: &mut B, mesh: &mut Mesh) -> Result<(), MeshError> {
    let is_corners =
        |property: &Property| matches!(property.name.as_str(), "vertex_indices" | "vertex_index");
    if !element.properties.iter().any(is_corners) {
        return invalid("the faces have no list property `vertex_indices`");
    }
    // Nearly all meshes are of triangles: their memory is reserved at once, as growing would copy
    // it.
    mesh.triangles.reserve_exact(element.count);
    let all_plain = match &element.properties[..] {
        [
            Property {
                kind: PropertyKind::List { count: Scalar::U8, item: Scalar::I32 | Scalar::U32 }, ..
            },
        ] => {
            // Negative indices are above all others as they are read.
            mesh.positions.len() <= i32::MAX as usize
        }
        _ => false,
    };
    let (mut corners, mut left) = (Vec::new(), element.count);
    loop {
        if all_plain {
            let before = mesh.triangles.len();
            body.take_triangles(left, mesh.positions.len(), &mut mesh.triangles);
            left -= mesh.triangles.len() - before;
        }
        if left == 0 {
            return Ok(());
        }
        left -= 1;
        corners.clear();
        let mut number = None;
        for property in &element.properties {
            match property.kind {
                PropertyKind::List { count, item } if is_corners(property) => {
                    if matches!(count, Scalar::F32 | Scalar::F64) || matches!(item, Scalar::F32 | Scalar::F64)
                    {
                        return invalid("`vertex_indices` of the faces are not integers");
                    }
                    for _ in 0..list_length(body, count, item)? {
                        corners.push(vertex(body.read(item)?, mesh)?);
                    }
                }
                PropertyKind::Scalar(_) if is_corners(property) => {
                    return invalid("`vertex_indices` of the faces is not a list");
                }
                PropertyKind::Scalar(scalar) if property.name == "face_indices" => {
                    number = Some(body.read(scalar)? as i32);
                }
                _ => skip_property(property, body)?,
            }
        }
        mesh.push_face(&corners, number);
    }
}

fn read_strips<B: Body>(element: &Element, body: &mut B, mesh: &mut Mesh) -> Result<(), MeshError> {
    let rows = if element.properties.is_empty() { 0 } else { element.count };
    for property in std::iter::repeat_n(&element.properties, rows).flatten() {
        let PropertyKind::List { count, item } = property.kind else {
            skip_property(property, body)?;
            continue;
        };
        let (mut last, mut length) = ([0_u32; 2], 0_usize);
        for _ in 0..list_length(body, count, item)? {
            let corner = body.read(item)?;
            if corner == -1.0 {
                length = 0;
                continue;
            }
            let corner = vertex(corner, mesh)?;
            if length >= 2 {
                // Every second triangle of a strip has the opposite winding.
                let [a, b] = if length % 2 == 0 { last } else { [last[1], last[0]] };
                mesh.push_face(&[a, b, corner], None);
            }
            last = [last[1], corner];
            length += 1;
        }
    }
    Ok(())
}
