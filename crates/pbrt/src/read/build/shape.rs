//! Shapes, objects and instances.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use bytemuck::allocation::try_cast_slice_arc;
use description::{
    Arena, CurveBasis, CurveDesc, CurveProfile, Diagnostic, Handle, InstanceDesc, MeshDesc, MeshKey,
    ObjectDesc, Origin, PatchMeshDesc, SceneDesc, ShapeDesc, ShapeKind, ShapeType, SolidOperation, Spanned,
    SpheresDesc, Stated,
};
use math::Vec3;
use rayon::prelude::*;

use super::reader::Reader;
use super::{Builder, unknown_reference};
use crate::read::parameter::Values;
use crate::read::statement::{InstanceStatement, ShapeStatement, Statements};
use assets::mesh::{Format, triangulate_contours};
use assets::{AssetSource, read_unpacked};

/// Mesh files by path, each read once, with what is said about them; or the reason of the failure.
pub(super) type Meshes = HashMap<PathBuf, Result<(ShapeKind, Vec<String>), String>>;

impl Builder<'_> {
    /// Reads all mesh files that shapes name, in parallel.
    pub(super) fn load_meshes(&mut self, statements: &Statements) {
        let in_objects = statements.objects.iter().flat_map(|object| &object.shapes);
        let shapes = statements.shapes.iter().chain(in_objects).map(|shape| &shape.statement);
        let names = shapes.filter(|statement| statement.kind.value == "plymesh").flat_map(|statement| {
            statement.parameters.iter().chain(statement.defaults.iter()).filter_map(|parameter| {
                match (parameter.name.as_str(), &parameter.values) {
                    ("filename", Values::Strings(names)) => names.first(),
                    _ => None,
                }
            })
        });
        let mut paths: Vec<PathBuf> = names.map(|name| self.path(name)).collect();
        paths.sort_unstable();
        paths.dedup();
        let assets = self.assets;
        self.meshes = paths
            .into_par_iter()
            .map(|path| {
                let mesh = read_mesh(assets, &path);
                (path, mesh)
            })
            .collect();
    }

    /// Builds a shape; one that cannot be read is left out.
    pub(super) fn shape(&mut self, shape: ShapeStatement) -> Option<Stated<ShapeDesc>> {
        let (read, origin) = self.read(shape.statement, read_shape);
        let material = self.material_reference(&shape.material);
        let medium_interface = self.medium_interface(shape.medium_interface.as_ref());
        let desc = ShapeDesc {
            world_from_object: shape.world_from_object,
            reverse_orientation: shape.reverse_orientation,
            material,
            area_light: shape.area_light.map(Handle::new),
            medium_interface,
            ..read?
        };
        Some(Stated::new(desc, origin))
    }

    /// Builds all objects and instances.
    pub(super) fn objects(&mut self, statements: &mut Statements, desc: &mut SceneDesc) {
        for (index, object) in statements.objects.drain(..).enumerate() {
            self.complete_objects = index;
            let Spanned { value: name, span } = object.name;
            let mut built = ObjectDesc { name, ..ObjectDesc::default() };
            for shape in object.shapes {
                if let Some(shape) = self.shape(shape) {
                    built.shapes.push_stated(shape);
                }
            }
            self.instances(object.instances, &mut built.instances);
            desc.objects.push_stated(Stated::new(built, Origin::new(span)));
        }
        let instances = std::mem::take(&mut statements.instances);
        self.instances(instances, &mut desc.instances);
    }

    fn instances(&mut self, statements: Vec<InstanceStatement>, instances: &mut Arena<InstanceDesc>) {
        for instance in statements {
            let Some(&object) = self.objects.get(&instance.object.value) else {
                unknown_reference(&mut self.report, "object", &instance.object, None, &self.objects);
                continue;
            };
            let built = InstanceDesc { object, world_from_object: instance.world_from_object };
            instances.push_stated(Stated::new(built, Origin::new(instance.span)));
        }
    }
}

fn read_mesh(assets: &dyn AssetSource, path: &std::path::Path) -> Result<(ShapeKind, Vec<String>), String> {
    let bytes = read_unpacked(assets, path).map_err(|error| error.to_string())?;
    let format = Format::from_path(path).unwrap_or(Format::Ply);
    let mut mesh = format.read(&bytes).map_err(|error| error.to_string())?;
    // Before arrays are copied to their final place.
    drop(bytes);
    let mut warnings = std::mem::take(&mut mesh.warnings);
    if !mesh.colors.is_empty() {
        warnings.push("colours of its vertices are not drawn: the material is that of the shape".to_owned());
    }
    Ok((mesh.into_shape(), warnings))
}

/// Triangles are also called `polygon`, then with the corners of contours.
const POLYGON: &str = "polygon";

fn read_shape(reader: &mut Reader) -> Option<ShapeDesc> {
    let is_polygon = reader.kind.value == POLYGON;
    let kind = if is_polygon { Some(ShapeType::Triangles) } else { ShapeType::named(&reader.kind.value) };
    let Some(kind) = kind.and_then(ShapeKind::new) else {
        reader.unknown_type("shape", "shape", &[ShapeType::NAMES, &[POLYGON]].concat());
        return None;
    };
    let mut shape = ShapeDesc::from(kind);
    reader.settings(&mut shape);
    match &mut shape.kind {
        ShapeKind::Sphere { radius, z_min, z_max, .. } => {
            *z_min = reader.float("zmin", -*radius);
            *z_max = reader.float("zmax", *radius);
            check_range(reader, [*z_min, *z_max], [-*radius, *radius])?;
        }
        ShapeKind::Cylinder { z_min, z_max, .. } => {
            check_range(reader, [*z_min, *z_max], [f32::NEG_INFINITY, f32::INFINITY])?;
        }
        ShapeKind::Paraboloid { z_min, z_max, .. } => {
            check_range(reader, [*z_min, *z_max], [0.0, f32::INFINITY])?;
        }
        ShapeKind::Hyperboloid { ends, .. } => check_segment(reader, ends)?,
        ShapeKind::Disk { radius, inner_radius, .. } => {
            if !(0.0..*radius).contains(inner_radius) {
                reader.refuse("innerradius", "`innerradius` must be at least 0, and below `radius`");
                return None;
            }
        }
        ShapeKind::Cone { .. } | ShapeKind::Plane => (),
        ShapeKind::Spheres(set) => *set = spheres(reader)?,
        ShapeKind::Implicit { formula, bounds: [min, max] } => {
            *formula = reader.needed("f", Reader::string)?;
            if !(min.cmplt(*max).all() && min.is_finite() && max.is_finite()) {
                let message = "`bounds` are two corners of a box: the lowest and the highest x, y and z";
                reader.refuse("bounds", message);
                return None;
            }
        }
        ShapeKind::Solid { operation, operands } => (*operation, *operands) = solid(reader)?,
        ShapeKind::Triangles(mesh) if is_polygon => *mesh = polygon(reader)?,
        ShapeKind::Triangles(mesh) => *mesh = triangle_mesh(reader, true)?,
        ShapeKind::Patches(mesh) => *mesh = patch_mesh(reader)?,
        ShapeKind::PlyMesh { .. } => mesh_file(reader, &mut shape.kind)?,
        ShapeKind::Curve(desc) => curve(reader, desc)?,
        ShapeKind::LoopSubdivision { mesh, .. } => {
            // The format has one scheme only.
            reader.choice("scheme", (), &[("loop", ())]);
            *mesh = triangle_mesh(reader, false)?;
        }
    }
    Some(shape)
}

/// Checks that a part of a surface whose z lies between `limits` is between `zmin` and `zmax`, in
/// either order.
fn check_range(reader: &mut Reader, z: [f32; 2], limits: [f32; 2]) -> Option<()> {
    let [low, high] = [z[0].min(z[1]), z[0].max(z[1])];
    if low.max(limits[0]) < high.min(limits[1]) {
        return Some(());
    }
    let blamed = if reader.has("zmax") { "zmax" } else { "zmin" };
    reader.refuse(blamed, "no part of the surface lies between `zmin` and `zmax`");
    None
}

/// Checks that a segment sweeps a hyperboloid.
fn check_segment(reader: &mut Reader, ends: &[Vec3; 2]) -> Option<()> {
    let problem = if ends[0].z == ends[1].z {
        "have the same z: use a `disk`, which is what such a line sweeps"
    } else if ends.iter().all(|end| end.x == 0.0 && end.y == 0.0) {
        "both lie on the z axis: such a line sweeps no surface"
    } else {
        return Some(());
    };
    reader.refuse("p2", format!("`p1` and `p2` {problem}"));
    None
}

/// `"string operation"`: `union`, `intersection`, or `difference` (the first without all others).
/// `"string operands"`: names of objects, all shapes of which are one body; they are placed as an
/// instance of the object would be, and their materials are ignored.
fn solid(reader: &mut Reader) -> Option<(SolidOperation, Vec<Spanned<Handle<ObjectDesc>>>)> {
    let operation = reader.needed("operation", Reader::named);
    let names = reader.needed("operands", Reader::strings);
    let (operation, names) = (operation?, names?);
    if names.len() < 2 {
        reader.refuse("operands", "a solid is made of two objects or more");
        return None;
    }
    let operands: Vec<_> = names.iter().filter_map(|name| operand(reader.builder, name)).collect();
    (operands.len() == names.len()).then_some((operation, operands))
}

/// An object that may be a part of a solid here: one that is complete.
fn operand(builder: &mut Builder, name: &Spanned<String>) -> Option<Spanned<Handle<ObjectDesc>>> {
    match builder.objects.get(&name.value) {
        None => {
            unknown_reference(&mut builder.report, "object", name, None, &builder.objects);
            None
        }
        Some(object) if object.index() >= builder.complete_objects => {
            let message = format!("the object `{}` is not complete here", name.value);
            let help = "the operands of a solid in an object must end before that object begins";
            let diagnostic = Diagnostic::error("unknown-reference", message, name.span);
            builder.report.push(diagnostic.with_help(help));
            None
        }
        Some(&object) => Some(Spanned::new(object, name.span)),
    }
}

/// The indices of a mesh, `N` per face; `default` are those of a mesh of one face, which needs
/// none.
fn indices<const N: usize>(
    reader: &mut Reader,
    vertices: usize,
    default: [u32; N],
) -> Option<Arc<[[u32; N]]>> {
    let Some(indices) = reader.integers("indices") else {
        if vertices == N {
            return Some(Arc::from([default]));
        }
        return reader.needed("indices", |_, _| None);
    };
    if !reader.has_rows_of("indices", N) {
        return None;
    }
    if let Some(bad) =
        indices.iter().find(|&&index| usize::try_from(index).map_or(true, |index| index >= vertices))
    {
        reader.refuse("indices", format!("`indices` has {bad}, but there are {vertices} points in `P`"));
        return None;
    }
    if !indices.len().is_multiple_of(N) || indices.is_empty() {
        reader.refuse(
            "indices",
            format!("`indices` has {} numbers, which is not a multiple of {N}", indices.len()),
        );
        return None;
    }
    // None is negative.
    try_cast_slice_arc(indices).ok()
}

/// An array with one value per vertex, or empty.
fn per_vertex<T>(
    reader: &mut Reader,
    name: &'static str,
    vertices: usize,
    values: Option<Arc<[T]>>,
) -> Arc<[T]> {
    let Some(values) = values else { return Arc::from([]) };
    if values.len() != vertices {
        reader.refuse(name, format!("`{name}` has {} values for {vertices} points in `P`", values.len()));
        return Arc::from([]);
    }
    values
}

fn points(reader: &mut Reader) -> Option<Arc<[Vec3]>> {
    reader.needed("P", Reader::points3)
}

fn face_indices(reader: &mut Reader, faces: usize) -> Arc<[i32]> {
    let Some(values) = reader.integers("faceIndices") else { return Arc::from([]) };
    if values.len() != faces {
        let message = format!("`faceIndices` has {} values for {faces} faces", values.len());
        reader.refuse("faceIndices", message);
        return Arc::from([]);
    }
    values
}

fn triangle_mesh(reader: &mut Reader, with_attributes: bool) -> Option<MeshDesc> {
    let positions = points(reader)?;
    if !with_attributes {
        let indices = indices(reader, positions.len(), [0, 1, 2])?;
        return Some(MeshDesc { indices, positions, ..MeshDesc::default() });
    }
    let keys = reader.integer("keyframes", 1, 1..=i32::MAX) as usize;
    let vertices = positions.len() / keys;
    if vertices * keys != positions.len() {
        let message = format!("the {} points in `P` are not a multiple of {keys}", positions.len());
        reader.refuse("keyframes", message);
        return None;
    }
    let indices = indices(reader, vertices, [0, 1, 2])?;
    let (normals, tangents, uvs) = (reader.normals("N"), reader.vectors3("S"), reader.points2("uv"));
    // Normals may stay while vertices move.
    let moving = normals.as_ref().is_some_and(|normals| normals.len() == vertices * keys);
    let normals = per_vertex(reader, "N", if moving { positions.len() } else { vertices }, normals);
    let key = |k: usize| MeshKey {
        positions: positions[k * vertices..][..vertices].into(),
        normals: if moving { normals[k * vertices..][..vertices].into() } else { normals.clone() },
    };
    let later = (1..keys).map(key).collect();
    let MeshKey { positions, normals } = if keys == 1 { MeshKey { positions, normals } } else { key(0) };
    Some(MeshDesc {
        face_indices: face_indices(reader, indices.len()),
        normals,
        tangents: per_vertex(reader, "S", vertices, tangents),
        uvs: per_vertex(reader, "uv", vertices, uvs),
        indices,
        positions,
        later,
    })
}

/// A planar polygon: `contours` counts the points of its outer contour and of each hole.
fn polygon(reader: &mut Reader) -> Option<MeshDesc> {
    let positions = points(reader)?;
    let vertices = positions.len();
    let counts = reader.integers("contours").unwrap_or_else(|| Arc::from([vertices as i32]));
    let lengths: Option<Vec<usize>> = counts.iter().map(|&count| usize::try_from(count).ok()).collect();
    let lengths = lengths.filter(|lengths| {
        !lengths.is_empty()
            && lengths.iter().try_fold(0, |sum: usize, &n| sum.checked_add(n)) == Some(vertices)
    });
    let Some(lengths) = lengths else {
        let message = format!("`contours` must add up to the {vertices} points in `P`");
        reader.refuse(if reader.has("contours") { "contours" } else { "P" }, message);
        return None;
    };
    let indices = match triangulate_contours(&positions, &lengths) {
        Ok(triangles) => triangles.into(),
        Err(error) => {
            reader.refuse("P", format!("`P` is not a valid polygon: {error}"));
            return None;
        }
    };
    let (normals, uvs) = (reader.normals("N"), reader.points2("uv"));
    Some(MeshDesc {
        normals: per_vertex(reader, "N", vertices, normals),
        uvs: per_vertex(reader, "uv", vertices, uvs),
        indices,
        positions,
        ..MeshDesc::default()
    })
}

fn patch_mesh(reader: &mut Reader) -> Option<PatchMeshDesc> {
    let positions = points(reader)?;
    let indices = indices(reader, positions.len(), [0, 1, 2, 3])?;
    let (normals, uvs) = (reader.normals("N"), reader.points2("uv"));
    let vertices = positions.len();
    Some(PatchMeshDesc {
        face_indices: face_indices(reader, indices.len()),
        normals: per_vertex(reader, "N", vertices, normals),
        uvs: per_vertex(reader, "uv", vertices, uvs),
        emission_image: reader.image("emissionfilename", None),
        indices,
        positions,
    })
}

fn spheres(reader: &mut Reader) -> Option<SpheresDesc> {
    let centers = points(reader)?;
    let radii = reader.floats("radius").unwrap_or_else(|| Arc::from([1.0]));
    let refusal = if radii.len() != 1 && radii.len() != centers.len() {
        Some(("radius", format!("`radius` has {} values for {} points in `P`", radii.len(), centers.len())))
    } else if let Some(i) = radii.iter().position(|r| !(*r > 0.0 && r.is_finite())) {
        Some(("radius", format!("`radius` {i} is {}; it must be above zero", radii[i])))
    } else {
        let i = centers.iter().position(|center| !center.is_finite());
        i.map(|i| ("P", format!("point {i} in `P` is not finite")))
    };
    if let Some((name, message)) = refusal {
        reader.refuse(name, message);
        return None;
    }
    Some(SpheresDesc { centers, radii })
}

/// The mesh of a file, in place of an empty one.
fn mesh_file(reader: &mut Reader, kind: &mut ShapeKind) -> Option<()> {
    let edge = reader.optional_float("edgelength");
    if edge.is_some_and(|edge| edge <= 0.0) {
        reader.refuse("edgelength", "`edgelength` must be above zero");
    }
    let file = reader.needed("filename", Reader::string)?;
    let path = reader.builder.path(&file);
    // Only a parameter of the wrong type or count was not loaded; that has been reported.
    let (mut mesh, warnings) = match reader.builder.meshes.get(&path)? {
        Ok(loaded) => loaded.clone(),
        Err(message) => {
            let message = format!("cannot read the mesh `{}`: {message}", path.display());
            reader.builder.report.error("unreadable-mesh", message, file.span);
            return None;
        }
    };
    for text in warnings {
        let message = format!("of the mesh `{}`: {text}", path.display());
        reader.builder.report.warning("not-drawn", message, file.span);
    }
    if let ShapeKind::PlyMesh { displacement: displaced, edge_length: length, .. } = &mut mesh
        && let ShapeKind::PlyMesh { displacement, edge_length, .. } = kind
    {
        (*displaced, *length) = (displacement.take(), edge.unwrap_or(*edge_length));
    }
    *kind = mesh;
    Some(())
}

/// Checks the number of control points, and reads normals and width.
fn curve(reader: &mut Reader, curve: &mut CurveDesc) -> Option<()> {
    let CurveDesc { control_points, degree, basis, profile, normals, width, split_depth: _ } = curve;
    *control_points = points(reader)?;
    let (count, degree) = (control_points.len() as i32, *degree);
    let (fits, segments) = match basis {
        CurveBasis::Bezier => ((count - 1) % degree == 0, (count - 1) / degree),
        CurveBasis::BSpline => (true, count - degree),
    };
    if count <= degree || !fits {
        let message =
            format!("{count} points in `P` do not make a whole number of segments of degree {degree}");
        reader.refuse("P", message);
        return None;
    }
    *normals = reader.normals("N").unwrap_or_default();
    if *profile != CurveProfile::Ribbon && !normals.is_empty() {
        reader.ignored("N", "curves have normals only if they are of type `ribbon`");
        *normals = Arc::default();
    }
    if *profile == CurveProfile::Ribbon && normals.len() as i32 != segments + 1 {
        let message = format!("a ribbon of {segments} segments needs {} normals in `N`", segments + 1);
        reader.refuse("N", message);
        *profile = CurveProfile::Flat;
    }
    let both = reader.float("width", 1.0);
    *width = ["width0", "width1"].map(|name| reader.float(name, both));
    if width.iter().any(|&width| width < 0.0) {
        let name = ["width0", "width1", "width"].into_iter().find(|name| reader.has(name));
        reader.refuse(name.unwrap_or("width"), "the width of a curve cannot be negative");
        return None;
    }
    Some(())
}
