//! Vertices of PLY files.

use math::{Vec2, Vec3};

use super::header::{Element, Property, PropertyKind, Scalar};
use super::note_unread;
use super::values::Body;
use crate::mesh::notes::Notes;
use crate::mesh::{Mesh, MeshError, invalid};

/// Names of red, green, blue and opacity.
pub(super) const COLORS: [&[&str]; 4] = [
    &["red", "diffuse_red", "r"],
    &["green", "diffuse_green", "g"],
    &["blue", "diffuse_blue", "b"],
    &["alpha", "diffuse_alpha", "a"],
];

/// Where a vertex property goes: position, normal, texture coordinates, colour.
const SLOTS: [&[&str]; 12] = [
    &["x"],
    &["y"],
    &["z"],
    &["nx"],
    &["ny"],
    &["nz"],
    &["u", "s", "texture_u", "texture_s"],
    &["v", "t", "texture_v", "texture_t"],
    COLORS[0],
    COLORS[1],
    COLORS[2],
    COLORS[3],
];
/// The first of the slots of colours.
const COLOR: usize = 8;

/// Reads the vertices. Colours are codes in [0, 1].
pub(super) fn read_vertices<B: Body>(
    element: &Element,
    body: &mut B,
    mesh: &mut Mesh,
    notes: &mut Notes,
) -> Result<(), MeshError> {
    let slot_of = |property: &Property| {
        let slot = SLOTS.iter().position(|names| names.contains(&property.name.as_str()))?;
        Some(slot).filter(|&slot| slot < COLOR || matches!(property.kind, PropertyKind::Scalar(_)))
    };
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
    let has_colors = has(COLOR) && has(COLOR + 1) && has(COLOR + 2);
    note_unread(element, |property| slot_of(property).is_some_and(|slot| slot < COLOR || has_colors), notes);
    mesh.positions.reserve_exact(element.count);
    mesh.normals.reserve_exact(if has_normals { element.count } else { 0 });
    mesh.uvs.reserve_exact(if has_uvs { element.count } else { 0 });
    mesh.colors.reserve_exact(if has_colors { element.count } else { 0 });
    if !has_colors
        && let Some(layout) = FloatLayout::new(element, &slots, has_normals, has_uvs)
        && let Some(bytes) = element.count.checked_mul(layout.size).and_then(|size| body.take(size))
    {
        return layout.read::<B>(bytes, mesh);
    }
    let mut is_opaque = true;
    for _ in 0..element.count {
        let mut values = [0.0_f32; SLOTS.len()];
        values[COLOR + 3] = 1.0;
        for (property, slot) in element.properties.iter().zip(&slots) {
            match (slot, &property.kind) {
                (Some(slot), &PropertyKind::Scalar(scalar)) => {
                    let one = if *slot < COLOR { 1.0 } else { scalar.one() };
                    values[*slot] = (body.read(scalar)? / one) as f32;
                }
                _ => body.skip(&property.kind)?,
            }
        }
        let [x, y, z, nx, ny, nz, u, v, red, green, blue, alpha] = values;
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
        if has_colors {
            mesh.colors.push([red, green, blue]);
            is_opaque &= alpha >= 1.0;
        }
    }
    if !is_opaque {
        notes.add_at("vertices", "their opacity is not drawn");
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
        let (mut size, mut offsets) = (0, [None; SLOTS.len()]);
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
        let uv = if has_uvs { Some(run(&offsets[6..8])?) } else { None };
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
