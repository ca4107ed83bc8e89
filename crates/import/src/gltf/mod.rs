//! glTF 2.0: scenes as JSON text with buffers and images beside it, or all in one binary file.
//!
//! A file is read in the order in which its parts depend on each other: the container, the text
//! (`json`, `document`), buffers and accessors, what refers to them (materials, lights, cameras,
//! nodes, skins, animations), and at last the scene, as `scene` puts it together. Every fault names
//! its place as a JSON pointer.

mod accessor;
mod animation;
mod basis;
mod buffer;
mod camera;
mod charts;
mod container;
mod document;
#[cfg_attr(not(feature = "draco"), path = "without_draco.rs")]
mod draco;
mod json;
mod light;
mod material;
mod meshopt;
mod node;
mod pictures;
mod primitive;
mod scene;
mod skin;
mod surface;
mod texture;
mod uri;

use std::path::Path;

use description::SceneDesc;

use crate::log::Log;
use crate::selection::{self, Choice, Selection};
use crate::studio;
use accessor::Accessor;
use animation::Animation;
use assets::AssetSource;
use buffer::Buffers;
use camera::Camera;
use description::Imported;
use document::Document;
use json::{Place, Result};
use light::Light;
use material::Material;
use node::Nodes;
use pictures::Pictures;
#[cfg(feature = "usd")]
pub(crate) use pictures::mirrored;
use scene::{Assembly, Drawn, Pose};
use skin::Skin;

/// Whether a path names a file of this format: by its extension, or by its first bytes.
pub(crate) fn is_named_by(path: &Path, assets: &dyn AssetSource) -> bool {
    match Selection::extension(path, assets).as_str() {
        "gltf" | "glb" => true,
        "pbrt" | "gz" => false,
        _ if path == Path::new("-") => false,
        _ => assets.read(&Selection::of(path, assets).0).is_ok_and(|bytes| container::is_binary(&bytes)),
    }
}

/// Reads a file as a scene.
pub(crate) fn read(path: &Path, assets: &dyn AssetSource) -> Imported {
    selection::read(path, assets, |desc, (path, bytes), selection, log| {
        fill(desc, path, bytes, selection, assets, log)
    })
}

fn fill(
    desc: &mut SceneDesc,
    path: &Path,
    bytes: Vec<u8>,
    selection: &Selection,
    assets: &dyn AssetSource,
    log: &mut Log,
) -> Result<()> {
    let says_binary = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("glb"));
    let container::Container { root, bytes: binary } = container::read(&bytes, says_binary)?;
    drop(bytes);
    let document = Document::new(&root, log)?;
    let buffers = Buffers::read(&document, binary, path, assets, log);
    for accessor in document.items("accessors") {
        log.keep(Accessor::parse(accessor));
    }
    texture::check(&document, log);
    let mut materials = all(&document, "materials", log, |place| Material::parse(&document, place));
    materials.push(Some(Material::unnamed(&document)));
    let cameras = all(&document, "cameras", log, Camera::parse);
    let skins = all(&document, "skins", log, |place| Skin::parse(&document, &buffers, place));
    let animations = all(&document, "animations", log, |place| Animation::parse(&document, &buffers, place));
    let lights: Vec<_> =
        light::places(&document)?.iter().map(|place| log.keep(Light::parse(place))).collect();
    let nodes = Nodes::read(&document, log);
    let scenes = all(&document, "scenes", log, |place| node::scene_roots(place, &document, &nodes));
    let roots = match node::scene_index(&document, selection.scene)? {
        Some(index) => scenes[index].clone().unwrap_or_default(),
        None => nodes.roots(),
    };
    let poses = poses(&document, nodes, &animations, selection)?;
    let drawn = Drawn {
        nodes: poses[0].nodes.below(&roots),
        variant: variant(&document, selection)?,
        poses,
        document,
        buffers: &buffers,
        materials: &materials,
        lights: &lights,
        skins: &skins,
    };
    let mut wanted = Vec::new();
    for mesh in drawn.meshes() {
        for place in log.keep(primitive::places(&document, mesh)).unwrap_or_default() {
            let index = log.keep(drawn.material(&place));
            let material = index.and_then(|index| materials.get(index)?.as_ref());
            let textures = material.iter().flat_map(|material| material.textures());
            wanted.extend(textures.map(|(texture, encoding)| (texture.image, encoding)));
        }
    }
    for (index, image) in document.items("images").enumerate() {
        if !wanted.iter().any(|&(used, _)| used == index) {
            log.keep(pictures::check(&image, &buffers, path, assets));
        }
    }
    let mut pictures = Pictures::decode(&document, &buffers, &wanted, path, assets, log);
    let mut assembly = Assembly::new(&drawn, desc, &mut pictures, log);
    assembly.add_all();
    let bounds = assembly.bounds;
    let camera = camera::chosen(&drawn, &cameras, selection)?;
    studio::complete(desc, camera, bounds, &[], log);
    Ok(())
}

/// The elements of an array; `None` for those with faults, which are reported.
fn all<T>(
    document: &Document,
    array: &str,
    log: &mut Log,
    mut parse: impl FnMut(&Place) -> Result<T>,
) -> Vec<Option<T>> {
    let items = (0..document.count(array)).map(|index| document.item(array, index));
    items.map(|place| place.and_then(|place| log.keep(parse(&place)))).collect()
}

/// The nodes as the shutter opens and closes.
fn poses(
    document: &Document,
    nodes: Nodes,
    animations: &[Option<Animation>],
    selection: &Selection,
) -> Result<[Pose; 2]> {
    let name = |index| document.item("animations", index)?.string("name").ok().flatten();
    let names: Vec<_> = (0..animations.len()).map(|index| name(index).unwrap_or_default()).collect();
    let index = match &selection.animation {
        Some(choice) => choice.index("animation", &names)?,
        None => 0,
    };
    let pose = |seconds: f64| {
        let mut nodes = nodes.clone();
        if let (Some(time), Some(Some(animation))) = (selection.time, animations.get(index)) {
            animation.apply(&mut nodes, time + seconds);
        }
        Pose { world: nodes.world(), nodes }
    };
    Ok([pose(0.0), pose(selection.shutter)])
}

/// The index of the chosen variant of materials.
fn variant(document: &Document, selection: &Selection) -> Result<Option<usize>> {
    let variants = match document.root().extension("KHR_materials_variants")? {
        Some(extension) => extension.array("variants")?,
        None => Vec::new(),
    };
    let mut names = Vec::new();
    for variant in &variants {
        names.push(variant.string("name")?.ok_or_else(|| variant.invalid("`name` is missing"))?);
    }
    selection.variant.as_ref().map(|choice: &Choice| choice.index("variant", &names)).transpose()
}
