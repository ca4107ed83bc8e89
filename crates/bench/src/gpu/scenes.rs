//! The scenes that are rendered, as texts of the pbrt format.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

use alhazen::Job;
use alhazen::assets::MemoryAssets;
use alhazen::description::{Diagnostic, SceneDesc};
use alhazen::import::import;
use alhazen::scene::Scene;
use alhazen_bench::mesh::{BenchMesh, SplitMix64};

use crate::Size;

/// A compiled scene, and its description without geometry.
pub struct Compiled {
    pub scene: Arc<Scene>,
    pub desc: SceneDesc,
}

/// Compiles a text, which may name files among the assets.
pub fn compile(text: &str, assets: MemoryAssets, size: &Size) -> Result<Compiled, String> {
    let path = Path::new("scene.pbrt");
    let mut imported = import(path, &assets.with(path, text));
    imported.desc.film.resolution = size.resolution.map(|side| side as i32);
    let desc = imported.desc.without_geometry();
    let compiled = Job::compile(imported.desc).map_err(|errors| messages(&errors))?;
    Ok(Compiled { scene: compiled.job.session.scene().clone(), desc })
}

/// The messages of diagnostics.
pub fn messages(diagnostics: &[Diagnostic]) -> String {
    diagnostics.iter().map(|it| it.message.as_str()).collect::<Vec<_>>().join("; ")
}

/// Two million triangles: two bodies on a plane under a sky and a lamp.
pub fn triangles() -> (&'static str, MemoryAssets) {
    let text = r#"
Integrator "path" "integer maxdepth" 4
LookAt 2.6 2 5   0 0.1 0   0 1 0
Camera "perspective" "float fov" 38
WorldBegin
LightSource "infinite" "rgb L" [ 0.3 0.35 0.45 ]
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 12 11 9 ]
    Shape "bilinearmesh" "point3 P" [ -1 4 -1  1 4 -1  -1 4 1  1 4 1 ]
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
Shape "bilinearmesh" "point3 P" [ -20 -1.3 -20  20 -1.3 -20  -20 -1.3 20  20 -1.3 20 ]
AttributeBegin
    Translate -1.3 0 0
    Material "diffuse" "rgb reflectance" [ 0.7 0.4 0.3 ]
    Shape "plymesh" "string filename" "blob.ply"
AttributeEnd
AttributeBegin
    Translate 1.3 0 0
    Rotate 130 0 1 0
    Material "diffuse" "rgb reflectance" [ 0.3 0.5 0.7 ]
    Shape "plymesh" "string filename" "blob.ply"
AttributeEnd
"#;
    let blob = BenchMesh::named("blob").map_or_else(Vec::new, |mesh| ply(&mesh));
    (text, MemoryAssets::default().with("blob.ply", blob))
}

/// A mesh as a binary file of the Stanford format.
fn ply(mesh: &BenchMesh) -> Vec<u8> {
    let (vertices, faces) = (mesh.positions.len(), mesh.indices.len());
    let head = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\nproperty float x\n\
         property float y\nproperty float z\nelement face {faces}\n\
         property list uchar int vertex_indices\nend_header\n"
    );
    let mut bytes = head.into_bytes();
    bytes.extend(mesh.positions.iter().flat_map(|p| p.to_array()).flat_map(f32::to_le_bytes));
    for triangle in &*mesh.indices {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|index| index.to_le_bytes()));
    }
    bytes
}

/// A hall with a thousand small lamps of ten colours, and direct light alone.
pub fn lights() -> String {
    let mut text = String::from(
        r#"
Integrator "path" "integer maxdepth" 1
LookAt 0 -7 2   0 0 1.4   0 0 1
Camera "perspective" "float fov" 55
WorldBegin
Material "diffuse" "rgb reflectance" [ 0.6 0.6 0.6 ]
Shape "bilinearmesh" "point3 P" [ -6 -8 0  6 -8 0  -6 6 0  6 6 0 ]
Shape "bilinearmesh" "point3 P" [ -6 6 0  6 6 0  -6 6 4  6 6 4 ]
Shape "bilinearmesh" "point3 P" [ -6 -8 0  -6 6 0  -6 -8 4  -6 6 4 ]
Shape "bilinearmesh" "point3 P" [ 6 6 0  6 -8 0  6 6 4  6 -8 4 ]
"#,
    );
    let random = &mut SplitMix64(11);
    for _ in 0..12 {
        let [x, y, r] = [0; 3].map(|_| random.uniform());
        let (x, y, r) = (10.0 * x - 5.0, 9.0 * y - 4.0, 0.3 + 0.5 * r);
        // Writing to a string cannot fail.
        let _ = writeln!(text, "Shape \"spheres\" \"float radius\" {r} \"point3 P\" [ {x} {y} {r} ]");
    }
    for _ in 0..10 {
        let [red, green, blue] = [0; 3].map(|_| 4.0 + 60.0 * random.uniform());
        let _ = write!(
            text,
            "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [ {red} {green} {blue} ]\n\
             Shape \"spheres\" \"float radius\" 0.02 \"point3 P\" ["
        );
        for _ in 0..100 {
            let [x, y, z] = [0; 3].map(|_| random.uniform());
            let _ = write!(text, " {} {} {}", 11.6 * x - 5.8, 13.6 * y - 7.8, 0.2 + 3.6 * z);
        }
        text += " ]\nAttributeEnd\n";
    }
    text
}
