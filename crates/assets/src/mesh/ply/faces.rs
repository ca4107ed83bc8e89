//! Faces of PLY files.

use std::collections::HashMap;

use math::Vec2;

use super::header::{Element, Property, PropertyKind, Scalar};
use super::note_unread;
use super::values::Body;
use super::vertices::COLORS;
use crate::mesh::notes::Notes;
use crate::mesh::{Mesh, MeshError, invalid};

/// Reads the faces of vertices that are known.
pub(super) fn read_faces<B: Body>(
    element: &Element,
    body: &mut B,
    mesh: &mut Mesh,
    notes: &mut Notes,
) -> Result<(), MeshError> {
    match element.name.as_str() {
        "tristrips" => {
            note_unread(element, |_| false, notes);
            read_strips(element, body, mesh)
        }
        _ => read_polygons(element, body, mesh, notes),
    }
}

/// The vertex index of a corner, checked.
fn vertex(corner: f64, vertices: usize) -> Result<u32, MeshError> {
    match corner >= 0.0 && corner.fract() == 0.0 && corner < vertices as f64 {
        true => Ok(corner as u32),
        false => invalid(format!("a face has vertex index {corner}, but there are {vertices} vertices")),
    }
}

/// The role of a property of a face.
#[derive(Clone, Copy, PartialEq)]
enum Role {
    Corners,
    /// Texture coordinates of the corners.
    Coordinates,
    /// A channel of the colour.
    Color(usize),
    /// The number of the picture.
    Picture,
    /// The file's own number of the face.
    Number,
    None,
}

impl Role {
    fn of(property: &Property, draws_colors: bool) -> Result<Self, MeshError> {
        let name = property.name.as_str();
        let color = COLORS.iter().position(|names| names.contains(&name)).filter(|_| draws_colors);
        match (name, &property.kind) {
            ("vertex_indices" | "vertex_index", PropertyKind::List { count, item }) => {
                if count.is_integer() && item.is_integer() {
                    return Ok(Self::Corners);
                }
                invalid("`vertex_indices` of the faces are not integers")
            }
            ("vertex_indices" | "vertex_index", PropertyKind::Scalar(_)) => {
                invalid("`vertex_indices` of the faces is not a list")
            }
            ("texcoord", PropertyKind::List { .. }) => Ok(Self::Coordinates),
            ("texnumber", PropertyKind::Scalar(_)) => Ok(Self::Picture),
            ("face_indices", PropertyKind::Scalar(_)) => Ok(Self::Number),
            (_, PropertyKind::Scalar(_)) => Ok(color.map_or(Self::None, Self::Color)),
            _ => Ok(Self::None),
        }
    }
}

fn read_polygons<B: Body>(
    element: &Element,
    body: &mut B,
    mesh: &mut Mesh,
    notes: &mut Notes,
) -> Result<(), MeshError> {
    let vertices = mesh.positions.len();
    let role = |property| Role::of(property, mesh.colors.is_empty());
    let roles = element.properties.iter().map(role).collect::<Result<Vec<_>, _>>()?;
    if !roles.contains(&Role::Corners) {
        return invalid("the faces have no list property `vertex_indices`");
    }
    let has_colors = (0..3).all(|channel| roles.contains(&Role::Color(channel)));
    let is_read = |property: &Property| {
        let at = element.properties.iter().position(|other| other.name == property.name);
        at.is_some_and(|at| match roles[at] {
            Role::None => false,
            Role::Color(channel) => has_colors && channel < 3,
            _ => true,
        })
    };
    note_unread(element, is_read, notes);
    let mut wedges = Wedges::default();
    let has_coordinates = roles.contains(&Role::Coordinates);
    if has_coordinates {
        mesh.uvs = vec![Vec2::ZERO; vertices];
    }
    if has_colors {
        mesh.colors = vec![[1.0; 3]; vertices];
    }
    let splits = has_coordinates || has_colors;
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
            vertices <= i32::MAX as usize
        }
        _ => false,
    };
    let (mut corners, mut coordinates, mut left) = (Vec::new(), Vec::new(), element.count);
    loop {
        if all_plain {
            let before = mesh.triangles.len();
            body.take_triangles(left, vertices, &mut mesh.triangles);
            left -= mesh.triangles.len() - before;
        }
        if left == 0 {
            return Ok(());
        }
        left -= 1;
        corners.clear();
        coordinates.clear();
        let (mut number, mut color) = (None, [1.0_f32; 4]);
        for (property, role) in element.properties.iter().zip(&roles) {
            match (role, &property.kind) {
                (Role::Corners, &PropertyKind::List { count, item }) => {
                    for _ in 0..body.list_length(count, item)? {
                        corners.push(vertex(body.read(item)?, vertices)?);
                    }
                }
                (Role::Coordinates, &PropertyKind::List { count, item }) => {
                    for _ in 0..body.list_length(count, item)? {
                        coordinates.push(body.read(item)? as f32);
                    }
                }
                (Role::Color(channel), &PropertyKind::Scalar(scalar)) => {
                    color[*channel] = (body.read(scalar)? / scalar.one()) as f32;
                }
                (Role::Picture, &PropertyKind::Scalar(scalar)) => {
                    if body.read(scalar)? > 0.0 {
                        notes.add_at("faces", "all have the first picture, whatever their `texnumber`");
                    }
                }
                (Role::Number, &PropertyKind::Scalar(scalar)) => number = Some(body.read(scalar)? as i32),
                (_, kind) => body.skip(kind)?,
            }
        }
        if splits {
            if !coordinates.is_empty() && coordinates.len() != 2 * corners.len() {
                notes.add_at("faces", "a `texcoord` that has not two numbers for each corner is not used");
                coordinates.clear();
            }
            let color = has_colors.then_some([color[0], color[1], color[2]]);
            for (index, corner) in corners.iter_mut().enumerate() {
                let uv = coordinates.as_chunks().0.get(index).map_or(Vec2::ZERO, |&uv| Vec2::from_array(uv));
                *corner = wedges.vertex(mesh, *corner, has_coordinates.then_some(uv), color);
            }
        }
        mesh.push_face(&corners, number);
    }
}

/// Vertices as corners of faces have them that bring texture coordinates or colours of their own.
#[derive(Default)]
struct Wedges {
    known: HashMap<(u32, [u32; 5]), u32>,
    /// Whether some corner has a vertex of the file.
    used: Vec<bool>,
}

impl Wedges {
    fn vertex(&mut self, mesh: &mut Mesh, vertex: u32, uv: Option<Vec2>, color: Option<[f32; 3]>) -> u32 {
        let (Vec2 { x, y }, [r, g, b]) = (uv.unwrap_or_default(), color.unwrap_or_default());
        let key = (vertex, [x, y, r, g, b].map(f32::to_bits));
        *self.known.entry(key).or_insert_with(|| {
            self.used.resize(self.used.len().max(vertex as usize + 1), false);
            let is_used = std::mem::replace(&mut self.used[vertex as usize], true);
            let wedge = if is_used { mesh.copy_vertex(vertex) } else { vertex };
            if let Some(uv) = uv {
                mesh.uvs[wedge as usize] = uv;
            }
            if let Some(color) = color {
                mesh.colors[wedge as usize] = color;
            }
            wedge
        })
    }
}

fn read_strips<B: Body>(element: &Element, body: &mut B, mesh: &mut Mesh) -> Result<(), MeshError> {
    let vertices = mesh.positions.len();
    let rows = if element.properties.is_empty() { 0 } else { element.count };
    for property in std::iter::repeat_n(&element.properties, rows).flatten() {
        let PropertyKind::List { count, item } = property.kind else {
            body.skip(&property.kind)?;
            continue;
        };
        let (mut last, mut length) = ([0_u32; 2], 0_usize);
        for _ in 0..body.list_length(count, item)? {
            let corner = body.read(item)?;
            if corner == -1.0 {
                length = 0;
                continue;
            }
            let corner = vertex(corner, vertices)?;
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
