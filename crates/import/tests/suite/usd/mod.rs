//! Files of USD: made by hand for what each part of the schemas means, and of other authors.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod damaged;
mod files;
mod geometry;
mod instances;
mod lights;
mod materials;

use alhazen_import::import;
use assets::MemoryAssets;
use description::Imported;
use description::{
    Diagnostic, MaterialKind, MeshDesc, OpenPbrDesc, SceneDesc, Severity, ShapeDesc, ShapeKind, SpectrumDesc,
    SpectrumParameter,
};

/// A quadrilateral (±1, ±1, 0) with texture coordinates; more of its properties follow.
pub const QUAD: &str = r#"
    int[] faceVertexCounts = [4]
    int[] faceVertexIndices = [0, 1, 2, 3]
    point3f[] points = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
    texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)] (interpolation = "vertex")
    uniform token subdivisionScheme = "none"
"#;

/// A text of a scene with y up.
pub fn text(prims: &str) -> String {
    format!("#usda 1.0\n(\n    upAxis = \"Y\"\n    timeCodesPerSecond = 10\n)\n{prims}")
}

/// Reads a scene of prims.
pub fn read(prims: &str) -> Imported {
    read_as("a.usda", prims)
}

/// Reads a scene of prims by a path that begins with `a.usda`.
pub fn read_as(path: &str, prims: &str) -> Imported {
    import(path, &MemoryAssets::default().with("a.usda", text(prims)))
}

/// A scene of prims without errors.
pub fn scene(prims: &str) -> SceneDesc {
    without_errors(read(prims))
}

pub fn without_errors(imported: Imported) -> SceneDesc {
    assert!(!imported.has_errors(), "{:#?}", imported.diagnostics);
    imported.desc
}

/// The messages of a scene of a severity.
pub fn messages(prims: &str, severity: Severity) -> Vec<String> {
    let of_severity = |diagnostic: &Diagnostic| diagnostic.severity == severity;
    read(prims).diagnostics.into_iter().filter(of_severity).map(|diagnostic| diagnostic.message).collect()
}

/// The only error of a scene.
pub fn error(prims: &str) -> String {
    let errors = messages(prims, Severity::Error);
    assert_eq!(errors.len(), 1, "{errors:?}");
    errors.into_iter().next().unwrap()
}

/// The warnings of a scene other than those about how much light there is.
pub fn warnings(prims: &str) -> Vec<String> {
    let warnings = messages(prims, Severity::Warning).into_iter();
    warnings.filter(|text| !text.contains("light of a studio") && !text.contains("exposed by")).collect()
}

/// The shapes of a scene, without the ground of a studio.
pub fn shapes(desc: &SceneDesc) -> Vec<&ShapeDesc> {
    let is_ground = |shape: &ShapeDesc| {
        let material = shape.material.map(|material| &desc.materials[material].kind);
        matches!(material, Some(MaterialKind::Diffuse { reflectance: SpectrumParameter::Value(value) })
            if *value == SpectrumDesc::Constant(0.36))
    };
    desc.shapes.iter().map(|(_, shape)| &**shape).filter(|shape| !is_ground(shape)).collect()
}

/// The only shape of a scene.
pub fn shape(desc: &SceneDesc) -> &ShapeDesc {
    let shapes = shapes(desc);
    assert_eq!(shapes.len(), 1, "{shapes:?}");
    shapes[0]
}

/// The triangles of a shape.
pub fn mesh(shape: &ShapeDesc) -> &MeshDesc {
    match &shape.kind {
        ShapeKind::Triangles(mesh) => mesh,
        kind => panic!("{kind:?}"),
    }
}

/// The corners of all triangles of a shape in the world, sorted.
pub fn corners(shape: &ShapeDesc) -> Vec<[i64; 3]> {
    let mesh = mesh(shape);
    let world = shape.world_from_object.start;
    let rounded = |v: f64| (v * 1000.0).round() as i64;
    let point = |&vertex: &u32| world.transform_point3(mesh.positions[vertex as usize].as_dvec3());
    let mut corners: Vec<_> =
        mesh.indices.iter().flatten().map(|vertex| point(vertex).to_array().map(rounded)).collect();
    corners.sort_unstable();
    corners.dedup();
    corners
}

/// A number of a principled surface.
pub fn number(surface: &OpenPbrDesc, name: &str) -> description::FloatParameter {
    let index = OpenPbrDesc::number(name).unwrap();
    surface.numbers[index].clone()
}
