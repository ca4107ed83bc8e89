//! The Stanford polygon format PLY: a text header that names elements and their properties, then
//! their values as text or as binary numbers of either byte order [Turk 1994].
//!
//! Vertices have `x y z`, optionally `nx ny nz`, texture coordinates as `u v`, `s t`,
//! `texture_u texture_v` or `texture_s texture_t`, and colours as `red green blue`,
//! `diffuse_red …` or `r g b`; faces a list `vertex_indices` or `vertex_index`, and optionally a
//! list `texcoord` for their corners, a colour, and a number `face_indices`. Instead of faces there
//! may be `tristrips`: triangle strips separated by −1. The comment `TextureFile` names a picture.
//! Other elements, and other properties of how a surface looks, are named in a warning; the rest is
//! skipped.

mod faces;
mod header;
mod values;
mod vertices;

use math::{Vec2, Vec3};

use super::notes::Notes;
use super::{Mesh, MeshError, decode_colors};
use faces::read_faces;
use header::{Element, Encoding, Header, Property, PropertyKind};
use values::{Ascii, Binary, Body};
use vertices::read_vertices;

/// Reads a PLY file.
pub fn read_ply(bytes: &[u8]) -> Result<Mesh, MeshError> {
    read_textured(bytes).map(|(mesh, _)| mesh)
}

/// Reads a PLY file, and the name of its picture, if it has one.
pub fn read_textured(bytes: &[u8]) -> Result<(Mesh, Option<String>), MeshError> {
    let (header, body) = header::read(bytes)?;
    let mut notes = Notes::default();
    let mesh = match header.format {
        Encoding::Ascii => read_body(&header, Ascii { text: body }, &mut notes),
        Encoding::LittleEndian => read_body(&header, Binary::<false> { bytes: body }, &mut notes),
        Encoding::BigEndian => read_body(&header, Binary::<true> { bytes: body }, &mut notes),
    };
    let mut mesh = mesh?;
    let mut textures = header.textures.into_iter();
    let texture = textures.next();
    if textures.next().is_some() {
        notes.add_at("header", "only the first of several pictures (`TextureFile`) is drawn");
    }
    mesh.warnings = notes.into_texts();
    Ok((mesh, texture))
}

fn read_body<B: Body>(header: &Header, mut body: B, notes: &mut Notes) -> Result<Mesh, MeshError> {
    let mut mesh = Mesh::default();
    // Faces that stand before the vertices, which nearly no file has, are read after them.
    let mut early_faces = None;
    for element in &header.elements {
        check_size::<B>(element, body.left())?;
        let has_faces = early_faces.is_some() || !mesh.triangles.is_empty() || !mesh.quads.is_empty();
        match element.name.as_str() {
            "vertex" if mesh.positions.is_empty() => read_vertices(element, &mut body, &mut mesh, notes)?,
            "face" | "tristrips" if !has_faces && mesh.positions.is_empty() => {
                early_faces = Some((element, body));
                skip(element, &mut body)?;
            }
            "face" | "tristrips" if !has_faces => read_faces(element, &mut body, &mut mesh, notes)?,
            name => {
                if element.count > 0 {
                    notes.add_at("header", format!("elements `{name:.40}` are not read"));
                }
                skip(element, &mut body)?;
            }
        }
    }
    if let Some((element, mut body)) = early_faces {
        read_faces(element, &mut body, &mut mesh, notes)?;
    }
    if mesh.triangles.is_empty() && mesh.quads.is_empty() {
        return Err(MeshError::Unsupported("it has no faces".into()));
    }
    if decode_colors(&mut mesh.colors) {
        notes.add_at("vertices", "colours beyond 1 are taken as codes up to 255");
    }
    let mut is_finite = true;
    for normal in mesh.normals.iter_mut().filter(|normal| !normal.is_finite()) {
        (*normal, is_finite) = (Vec3::ZERO, false);
    }
    for uv in mesh.uvs.iter_mut().filter(|uv| !uv.is_finite()) {
        (*uv, is_finite) = (Vec2::ZERO, false);
    }
    if !is_finite {
        notes.add_at("vertices", "normals and texture coordinates that are not finite are read as 0");
    }
    Ok(mesh)
}

/// Names the properties of an element that are not read and say how it looks.
fn note_unread(element: &Element, is_read: impl Fn(&Property) -> bool, notes: &mut Notes) {
    const LOOKS: [&str; 9] =
        ["red", "green", "blue", "alpha", "color", "texcoord", "texnumber", "texture", "material"];
    for property in &element.properties {
        let name = property.name.to_ascii_lowercase();
        if !is_read(property) && LOOKS.iter().any(|part| name.contains(part)) {
            let text = format!("the property `{:.40}` of `{:.40}` is not read", property.name, element.name);
            notes.add_at("header", text);
        }
    }
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

fn skip<B: Body>(element: &Element, body: &mut B) -> Result<(), MeshError> {
    if element.properties.is_empty() {
        return Ok(());
    }
    for _ in 0..element.count {
        for property in &element.properties {
            body.skip(&property.kind)?;
        }
    }
    Ok(())
}
