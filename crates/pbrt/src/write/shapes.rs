//! Shapes.

use std::collections::BTreeSet;

use description::{CurveDesc, MeshDesc, PatchMeshDesc, SceneDesc, ShapeDesc, ShapeKind, SpheresDesc};
use image::ColorEncoding;
use math::Vec3;

use crate::write::files::Files;
use crate::write::names::Names;
use crate::write::settings::{note_extension, parameters};
use crate::write::statement::Statement;

/// Meshes of more triangles or vertices are written to files.
const MAX_INLINE: usize = 64;

/// A shape without what is in force for it.
pub(crate) fn shape(
    desc: &SceneDesc,
    shape: &ShapeDesc,
    names: &Names,
    files: &mut Files,
    extensions: &mut BTreeSet<String>,
) -> Statement {
    let kind = &shape.kind;
    note_extension("shape", kind, extensions);
    let mut statement = match kind {
        ShapeKind::Triangles(mesh) => triangles(mesh, files),
        _ => Statement::new("Shape", kind.name()),
    }
    .target("shape");
    parameters(&mut statement, shape, names);
    write(&mut statement, kind, desc, names, files);
    if matches!(kind, ShapeKind::Triangles(mesh) if !mesh.later.is_empty()) {
        extensions.insert("shape trianglemesh keyframes".into());
    }
    if shape.single_sided {
        extensions.insert("single-sided shapes".into());
    }
    statement
}

/// The fields that are not declared as parameters.
fn write(to: &mut Statement, kind: &ShapeKind, desc: &SceneDesc, names: &Names, files: &mut Files) {
    match kind {
        ShapeKind::Sphere { radius, z_min, z_max, phi_max: _ } => {
            to.float("zmin", *z_min, -radius);
            to.float("zmax", *z_max, *radius);
        }
        ShapeKind::Spheres(SpheresDesc { centers, radii }) => {
            to.triples("point3", "P", centers);
            to.floats("radius", radii.iter().copied());
        }
        ShapeKind::Implicit { formula, .. } => to.text("f", &formula.value),
        ShapeKind::Solid { operation, operands } => {
            to.text("operation", operation.name());
            to.texts("operands", operands.iter().map(|operand| names.object(operand.value)));
        }
        ShapeKind::Patches(mesh) => patches(to, mesh, desc, files),
        ShapeKind::PlyMesh { triangles, patches, .. } => match files.mesh(triangles, Some(patches)) {
            Ok(name) => to.text("filename", &name),
            Err(problem) => to.fail(problem),
        },
        ShapeKind::Curve(desc) => curve(to, desc),
        ShapeKind::LoopSubdivision { mesh, .. } => {
            to.triples("point3", "P", &mesh.positions);
            to.indices(&mesh.indices);
        }
        // Triangles are written with their head.
        ShapeKind::Triangles(_)
        | ShapeKind::Cylinder { .. }
        | ShapeKind::Cone { .. }
        | ShapeKind::Paraboloid { .. }
        | ShapeKind::Hyperboloid { .. }
        | ShapeKind::Disk { .. }
        | ShapeKind::Plane => (),
    }
}

/// A mesh: in its statement if it is small, else in a file. Files have no tangents and no motion.
fn triangles(mesh: &MeshDesc, files: &mut Files) -> Statement {
    let MeshDesc { indices, positions, normals, tangents, uvs, face_indices, later } = mesh;
    let is_small = indices.len() <= MAX_INLINE && positions.len() <= MAX_INLINE;
    if !is_small && tangents.is_empty() && later.is_empty() {
        let mut statement = Statement::new("Shape", "plymesh");
        match files.mesh(mesh, None) {
            Ok(name) => statement.text("filename", &name),
            Err(problem) => statement.fail(problem),
        }
        return statement;
    }
    let mut to = Statement::new("Shape", "trianglemesh");
    to.integer("keyframes", later.len() as i32 + 1, 1);
    let keys = |first: &[Vec3], at: fn(&description::MeshKey) -> &[Vec3]| -> Vec<Vec3> {
        first.iter().chain(later.iter().flat_map(at)).copied().collect()
    };
    to.triples("point3", "P", &keys(positions, |key| &key.positions));
    to.indices(indices);
    if !normals.is_empty() {
        let stay = later.iter().all(|key| key.normals == *normals);
        let all = if stay { normals.to_vec() } else { keys(normals, |key| &key.normals) };
        to.triples("normal", "N", &all);
    }
    if !tangents.is_empty() {
        to.triples("vector3", "S", tangents);
    }
    to.pairs("uv", uvs);
    if !face_indices.is_empty() {
        to.integers("faceIndices", face_indices.iter().copied());
    }
    to
}

fn patches(to: &mut Statement, mesh: &PatchMeshDesc, desc: &SceneDesc, files: &mut Files) {
    let PatchMeshDesc { indices, positions, normals, uvs, face_indices, emission_image } = mesh;
    to.triples("point3", "P", positions);
    to.indices(indices);
    if !normals.is_empty() {
        to.triples("normal", "N", normals);
    }
    to.pairs("uv", uvs);
    if !face_indices.is_empty() {
        to.integers("faceIndices", face_indices.iter().copied());
    }
    if let Some(image) = emission_image {
        to.text("emissionfilename", &files.image(&desc.images[*image].image, ColorEncoding::Srgb));
    }
}

fn curve(to: &mut Statement, curve: &CurveDesc) {
    to.triples("point3", "P", &curve.control_points);
    if !curve.normals.is_empty() {
        to.triples("normal", "N", &curve.normals);
    }
    let [first, last] = curve.width;
    if first == last {
        to.float("width", first, 1.0);
    } else {
        to.float("width0", first, 1.0);
        to.float("width1", last, 1.0);
    }
}
