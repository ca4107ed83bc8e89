//! Shapes.

use std::collections::BTreeSet;

use description::{
    CurveBasis, CurveDesc, CurveProfile, MeshDesc, PatchMeshDesc, SceneDesc, ShapeDesc, ShapeKind,
    SolidOperation, SpheresDesc,
};
use image::ColorEncoding;
use math::Vec3;

use crate::write::files::Files;
use crate::write::names::Names;
use crate::write::statement::Statement;

/// Meshes of more triangles or vertices are written to files.
const LARGEST_INLINE: usize = 64;

/// What a shape of pbrt-v4 may have that is not in the format.
fn extension(kind: &ShapeKind) -> Option<&'static str> {
    match kind {
        ShapeKind::Cone { .. }
        | ShapeKind::Paraboloid { .. }
        | ShapeKind::Hyperboloid { .. }
        | ShapeKind::Plane
        | ShapeKind::Spheres(_)
        | ShapeKind::Implicit { .. }
        | ShapeKind::Solid { .. } => Some(kind.name()),
        ShapeKind::Triangles(mesh) => (!mesh.later.is_empty()).then_some("trianglemesh keyframes"),
        ShapeKind::Sphere { .. }
        | ShapeKind::Cylinder { .. }
        | ShapeKind::Disk { .. }
        | ShapeKind::Patches(_)
        | ShapeKind::PlyMesh { .. }
        | ShapeKind::Curve(_)
        | ShapeKind::LoopSubdivision { .. } => None,
    }
}

/// A shape without what is in force for it.
pub(crate) fn shape(
    desc: &SceneDesc,
    shape: &ShapeDesc,
    names: &Names,
    files: &mut Files,
    extensions: &mut BTreeSet<String>,
) -> Statement {
    let kind = &shape.kind;
    extensions.extend(extension(kind).map(|name| format!("shape {name}")));
    let mut statement = match kind {
        ShapeKind::Triangles(mesh) => triangles(mesh, files),
        _ => Statement::new("Shape", kind.name()),
    }
    .target("shape");
    write(&mut statement, kind, desc, names, files);
    statement.optional_float_parameter("alpha", shape.alpha.as_ref(), names);
    statement.flag("singlesided", shape.single_sided, false);
    if shape.single_sided {
        extensions.insert("single-sided shapes".into());
    }
    statement
}

fn write(to: &mut Statement, kind: &ShapeKind, desc: &SceneDesc, names: &Names, files: &mut Files) {
    match kind {
        ShapeKind::Sphere { radius, z_min, z_max, phi_max } => {
            to.float("radius", *radius, 1.0);
            range(to, [*z_min, *z_max], [-radius, *radius]);
            to.float("phimax", *phi_max, 360.0);
        }
        ShapeKind::Cylinder { radius, z_min, z_max, phi_max } => {
            to.float("radius", *radius, 1.0);
            range(to, [*z_min, *z_max], [-1.0, 1.0]);
            to.float("phimax", *phi_max, 360.0);
        }
        ShapeKind::Cone { radius, height, phi_max } => {
            to.float("radius", *radius, 1.0);
            to.float("height", *height, 1.0);
            to.float("phimax", *phi_max, 360.0);
        }
        ShapeKind::Paraboloid { radius, z_min, z_max, phi_max } => {
            to.float("radius", *radius, 1.0);
            range(to, [*z_min, *z_max], [0.0, 1.0]);
            to.float("phimax", *phi_max, 360.0);
        }
        ShapeKind::Hyperboloid { ends: [p1, p2], phi_max } => {
            to.triple("point3", "p1", *p1, Vec3::ZERO);
            to.triple("point3", "p2", *p2, Vec3::ONE);
            to.float("phimax", *phi_max, 360.0);
        }
        ShapeKind::Disk { height, radius, inner_radius, phi_max } => {
            to.float("height", *height, 0.0);
            to.float("radius", *radius, 1.0);
            to.float("innerradius", *inner_radius, 0.0);
            to.float("phimax", *phi_max, 360.0);
        }
        ShapeKind::Plane => (),
        ShapeKind::Spheres(SpheresDesc { centers, radii }) => {
            to.triples("point3", "P", centers);
            to.floats("radius", radii.iter().copied());
        }
        ShapeKind::Implicit { formula, bounds } => {
            to.text("f", &formula.value);
            to.triples("point3", "bounds", bounds);
        }
        ShapeKind::Solid { operation, operands } => {
            to.text(
                "operation",
                match operation {
                    SolidOperation::Union => "union",
                    SolidOperation::Intersection => "intersection",
                    SolidOperation::Difference => "difference",
                },
            );
            to.texts("operands", operands.iter().map(|operand| names.object(operand.value)));
        }
        // Written with its head.
        ShapeKind::Triangles(_) => (),
        ShapeKind::Patches(mesh) => patches(to, mesh, desc, files),
        ShapeKind::PlyMesh { triangles, patches, displacement, edge_length } => {
            match files.mesh(triangles, Some(patches)) {
                Ok(name) => to.text("filename", &name),
                Err(problem) => to.fail(problem),
            }
            to.optional_float_parameter("displacement", displacement.as_ref(), names);
            if displacement.is_some() {
                to.float("displacement.edgelength", *edge_length, 1.0);
            }
        }
        ShapeKind::Curve(desc) => curve(to, desc),
        ShapeKind::LoopSubdivision { mesh, levels } => {
            to.triples("point3", "P", &mesh.positions);
            to.indices(&mesh.indices);
            to.integer("levels", *levels, 3);
        }
    }
}

fn range(to: &mut Statement, z: [f32; 2], default: [f32; 2]) {
    to.float("zmin", z[0], default[0]);
    to.float("zmax", z[1], default[1]);
}

/// A mesh: in its statement if it is small, else in a file. Files have no tangents and no motion.
fn triangles(mesh: &MeshDesc, files: &mut Files) -> Statement {
    let MeshDesc { indices, positions, normals, tangents, uvs, face_indices, later } = mesh;
    let is_small = indices.len() <= LARGEST_INLINE && positions.len() <= LARGEST_INLINE;
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
    let CurveDesc { control_points, degree, basis, profile, normals, width, split_depth } = curve;
    let profile = match profile {
        CurveProfile::Flat => "flat",
        CurveProfile::Cylinder => "cylinder",
        CurveProfile::Ribbon => "ribbon",
    };
    to.choice("type", profile, "flat");
    let basis = match basis {
        CurveBasis::Bezier => "bezier",
        CurveBasis::BSpline => "bspline",
    };
    to.choice("basis", basis, "bezier");
    to.integer("degree", *degree, 3);
    to.triples("point3", "P", control_points);
    if !normals.is_empty() {
        to.triples("normal", "N", normals);
    }
    let [first, last] = *width;
    if first == last {
        to.float("width", first, 1.0);
    } else {
        to.float("width0", first, 1.0);
        to.float("width1", last, 1.0);
    }
    to.integer("splitdepth", *split_depth, 3);
}
