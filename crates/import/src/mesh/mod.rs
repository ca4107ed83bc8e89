//! A mesh file as a scene of its own, with its materials, in a [`studio`].

mod material;

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use description::{ImageDesc, Imported, SceneDesc, ShapeDesc, SourceMap, TransformDesc};
use math::{DMat4, Point2};

use assets::mesh::{Format, Map, Obj, ObjMaterial, read_materials, read_obj_parts, read_textured};
use assets::{AssetSource, Mesh, MeshError, read_stl, read_unpacked, resolve};

use crate::log::{Fault, Log};
use crate::primitives::{self, Look, Primitive, Vertices};
use crate::studio;

use material::{Paint, Surfaces};

/// Materials by their names, with the files that they are of.
type Library = HashMap<String, (ObjMaterial, PathBuf)>;

/// A mesh file, and the files beside it.
struct Source<'a> {
    path: &'a Path,
    format: Format,
    assets: &'a dyn AssetSource,
}

/// Reads a mesh file as a scene.
pub(crate) fn read(path: &Path, format: Format, assets: &dyn AssetSource) -> Imported {
    let (mut desc, mut log) = (SceneDesc::default(), Log::default());
    let name = path.to_string_lossy();
    let mut materials = Library::new();
    let parts = read_unpacked(assets, path).map_err(|error| error.to_string());
    let parts = parts
        .and_then(|bytes| parts_of(&bytes, format, path, &mut materials).map_err(|error| error.to_string()));
    match parts {
        Ok(obj) => {
            let source = Source { path, format, assets };
            add_materials(&obj, &source, &mut materials, &mut log);
            fill(&mut desc, obj, &source, &materials, &mut log);
        }
        Err(message) => {
            let message = format!("cannot read the mesh `{name}`: {message}");
            log.fault(Fault::new("unreadable-mesh", "", message));
        }
    }
    Imported { desc, sources: SourceMap::default(), diagnostics: log.finish() }
}

/// The meshes of a file; a PLY file may name a picture, which becomes a material.
fn parts_of(bytes: &[u8], format: Format, path: &Path, materials: &mut Library) -> Result<Obj, MeshError> {
    let whole = |name: String, mut mesh: Mesh| {
        let warnings = std::mem::take(&mut mesh.warnings);
        Obj { parts: vec![(name, mesh)], warnings, ..Obj::default() }
    };
    match format {
        Format::Obj => read_obj_parts(bytes),
        Format::Stl => Ok(whole(String::new(), read_stl(bytes)?)),
        Format::Ply => {
            let (mesh, texture) = read_textured(bytes)?;
            if let Some(file) = &texture {
                let diffuse_map = Some(Map::new(file));
                let material = ObjMaterial { name: file.clone(), diffuse_map, ..ObjMaterial::default() };
                materials.insert(file.clone(), (material, path.to_owned()));
            }
            Ok(whole(texture.unwrap_or_default(), mesh))
        }
    }
}

/// Adds the materials of the files that an object names.
fn add_materials(obj: &Obj, source: &Source, materials: &mut Library, log: &mut Log) {
    let Source { path, assets, .. } = *source;
    for library in obj.libraries.iter().flat_map(|line| libraries(line, path, assets)) {
        match read_unpacked(assets, &library) {
            Ok(bytes) => {
                let (known, warnings) = read_materials(&bytes);
                for text in warnings {
                    log.warn("not-drawn", format!("`{}`", library.display()), text);
                }
                let known = known.into_iter();
                materials.extend(known.map(|known| (known.name.clone(), (known, library.clone()))));
            }
            Err(error) => {
                let message = format!("cannot read the materials `{}`: {error}", library.display());
                log.warn("unreadable-file", "", message);
            }
        }
    }
}

fn fill(desc: &mut SceneDesc, obj: Obj, source: &Source, materials: &Library, log: &mut Log) {
    let world_from_mesh = match source.format {
        Format::Ply | Format::Obj => DMat4::IDENTITY,
        // An object made layer by layer has z up, and its front towards −y.
        Format::Stl => DMat4::from_rotation_x(-std::f64::consts::FRAC_PI_2),
    };
    for text in obj.warnings {
        log.warn("not-drawn", "", text);
    }
    let mut surfaces = Surfaces::new(desc, log, source.assets, source.path);
    for (name, mesh) in obj.parts {
        // A comment may follow the name.
        let material = materials.get(&name).or_else(|| materials.get(name.split(" #").next()?.trim_end()));
        if material.is_none() && !name.is_empty() {
            let message = format!("there is no material `{name}`; its faces are drawn without it");
            surfaces.log.warn("unknown-reference", "", message);
        }
        for shape in shapes(mesh, material, &mut surfaces) {
            let world_from_object = TransformDesc::fixed(world_from_mesh);
            surfaces.desc.shapes.push(ShapeDesc { world_from_object, ..shape });
        }
    }
    studio::furnish(desc);
}

/// The files that a line names: one, whose name may have spaces, or several.
fn libraries(line: &str, path: &Path, assets: &dyn AssetSource) -> Vec<PathBuf> {
    let place = |name: &str| resolve(assets, &name.replace('\\', "/"), &path.to_string_lossy(), "");
    let whole = place(line);
    let words: Vec<&str> = line.split_whitespace().collect();
    let is_name = |word: &&&str| word.to_ascii_lowercase().ends_with(".mtl");
    if assets.exists(&whole) || words.iter().filter(is_name).count() < 2 {
        return vec![whole];
    }
    // A name ends where a word ends as they all do.
    let names = words.split_inclusive(|word| is_name(&word));
    names.map(|words| place(&words.join(" "))).collect()
}

/// The shapes of the faces of one material.
fn shapes(
    mut mesh: Mesh,
    material: Option<&(ObjMaterial, PathBuf)>,
    surfaces: &mut Surfaces,
) -> Vec<ShapeDesc> {
    let grey = (ObjMaterial::default(), PathBuf::new());
    let (described, library) = material.unwrap_or(&grey);
    if described.has_maps() && mesh.uvs.is_empty() {
        let message = "there are no texture coordinates (`vt`) for its pictures: each face has the same ones";
        surfaces.log.warn("not-drawn", format!("material `{}`", described.name), message);
    }
    let colors = std::mem::take(&mut mesh.colors);
    let first = colors.first().copied();
    let is_even = colors.iter().all(|color| Some(*color) == first);
    let (mut paint, mut primitive) = (first.filter(|_| is_even).map_or(Paint::None, Paint::Even), None);
    if !is_even && described.has_maps() {
        let message = "colours of vertices are not drawn on surfaces with pictures";
        surfaces.log.warn("not-drawn", format!("material `{}`", described.name), message);
    } else if !is_even {
        let triangles = Primitive { colors, ..primitive_of(&mesh) };
        let factor = described.diffuse.unwrap_or([1.0; 3]);
        let (unwrapped, picture) = primitives::unwrapped(&triangles, factor);
        let image = ImageDesc { name: "colours of vertices".into(), image: picture.into() };
        paint = Paint::Image(surfaces.desc.images.push(image));
        primitive = Some(unwrapped);
    }
    if material.is_none() && matches!(paint, Paint::None) {
        return vec![ShapeDesc::from(mesh.into_shape())];
    }
    let both = surfaces.both(described, library, paint);
    let has_normals = surfaces.desc.materials[both[0].material].normal_map.is_some();
    if !has_normals && described.emission_map.is_none() && primitive.is_none() {
        let [surface, _] = both;
        return vec![ShapeDesc {
            material: Some(surface.material),
            area_light: surface.area_light,
            alpha: surface.alpha,
            ..ShapeDesc::from(mesh.into_shape())
        }];
    }
    let mut start = primitive.unwrap_or_else(|| primitive_of(&mesh));
    let parts = vec![(std::mem::take(&mut start.triangles), both)];
    let look = Look { has_normals, is_stretched: false, parts };
    look.shapes(&Vertices { start, end: None }, surfaces.desc)
}

/// The triangles of a mesh, and its quadrilaterals as two each.
fn primitive_of(mesh: &Mesh) -> Primitive {
    let halves = mesh.quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    Primitive {
        triangles: mesh.triangles.iter().copied().chain(halves).collect(),
        positions: mesh.positions.clone(),
        normals: mesh.normals.clone(),
        uvs: mesh.uvs.iter().map(|uv| Point2::new(uv.x, 1.0 - uv.y)).collect(),
        ..Primitive::default()
    }
}
