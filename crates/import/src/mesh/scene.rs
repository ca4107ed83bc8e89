//! A mesh file as a scene of its own, with its materials, in a [`studio`].

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use description::{
    AreaLightDesc, CoatedDiffuseDesc, ConductorDesc, ConductorReflectance, Diagnostic, Handle,
    ImageTextureDesc, MaterialDesc, MaterialKind, RoughnessDesc, SceneDesc, ShapeDesc, ShapeKind, SourceMap,
    Span, SpectrumDesc, SpectrumParameter, TextureDesc, TextureKind, TransformDesc,
};
use math::{DMat4, DVec3};

use super::{Format, Mesh, Obj, ObjMaterial, read_materials, read_obj_parts, studio};
use crate::Imported;
use crate::assets::{AssetSource, read_unpacked, resolve};
use crate::images;
use crate::report::Report;

/// Reads a mesh file as a scene.
pub(crate) fn read(path: &Path, format: Format, assets: &dyn AssetSource) -> Imported {
    let (mut desc, mut report) = (SceneDesc::default(), Report::default());
    let name = path.to_string_lossy();
    let parts = read_unpacked(assets, path).map_err(|error| error.to_string()).and_then(|bytes| {
        let parts = match format {
            Format::Obj => read_obj_parts(&bytes),
            Format::Ply | Format::Stl => format
                .read(&bytes)
                .map(|mesh| Obj { libraries: Vec::new(), parts: vec![(String::new(), mesh)] }),
        };
        parts.map_err(|error| error.to_string())
    });
    match parts {
        Ok(obj) => fill(&mut desc, obj, format, (path, assets), &mut report),
        Err(message) => {
            report.error("unreadable-mesh", format!("cannot read the mesh `{name}`: {message}"), Span::NONE)
        }
    }
    Imported { desc, sources: SourceMap::default(), diagnostics: report.finish() }
}

fn fill(
    desc: &mut SceneDesc,
    obj: Obj,
    format: Format,
    (path, assets): (&Path, &dyn AssetSource),
    report: &mut Report,
) {
    let world_from_mesh = match format {
        Format::Ply | Format::Obj => DMat4::IDENTITY,
        // What is made layer by layer has z up.
        Format::Stl => DMat4::from_rotation_x(-std::f64::consts::FRAC_PI_2),
    };
    let mut materials = HashMap::new();
    for library in &obj.libraries {
        let path = resolve(assets, library, &path.to_string_lossy(), "");
        match read_unpacked(assets, &path) {
            Ok(bytes) => {
                materials.extend(
                    read_materials(&bytes).into_iter().map(|material| (material.name.clone(), material)),
                );
            }
            Err(error) => {
                let message = format!("cannot read the materials `{}`: {error}", path.display());
                report.warning("unreadable-file", message, Span::NONE);
            }
        }
    }
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for (name, mesh) in obj.parts {
        for position in &mesh.positions {
            let position = world_from_mesh.transform_point3(position.as_dvec3());
            (low, high) = (low.min(position), high.max(position));
        }
        let mut shape = ShapeDesc::from(shape_kind(mesh));
        shape.world_from_object = TransformDesc::fixed(world_from_mesh);
        if let Some(material) = materials.get(&name) {
            shape.material = Some(add_material(desc, material, path, assets, report));
            shape.area_light = material
                .emission
                .filter(|rgb| rgb.iter().any(|&value| value > 0.0))
                .map(|[r, g, b]| desc.area_lights.push(AreaLightDesc::new(SpectrumDesc::rgb(r, g, b))));
        } else if !name.is_empty() {
            let message = format!("there is no material `{name}`; its faces are drawn grey");
            report.push(Diagnostic::warning("unknown-reference", message, Span::NONE));
        }
        desc.shapes.push(shape);
    }
    studio::furnish(desc, low, high);
}

/// The shape of a mesh. Quadrilaterals become bilinear patches, whose corners go in rows.
pub(crate) fn shape_kind(mesh: Mesh) -> ShapeKind {
    let positions: Arc<[_]> = mesh.positions.into();
    let normals: Arc<[_]> = mesh.normals.into();
    let uvs: Arc<[_]> = mesh.uvs.into();
    ShapeKind::PlyMesh {
        triangles: description::MeshDesc {
            indices: mesh.triangles.into(),
            positions: positions.clone(),
            normals: normals.clone(),
            tangents: Arc::default(),
            uvs: uvs.clone(),
            face_indices: mesh.triangle_faces.into(),
            later: Vec::new(),
        },
        patches: description::PatchMeshDesc {
            indices: mesh.quads.into_iter().map(|[a, b, c, d]| [a, b, d, c]).collect(),
            positions,
            normals,
            uvs,
            face_indices: mesh.quad_faces.into(),
            emission_image: None,
        },
        displacement: None,
        edge_length: 1.0,
    }
}

fn add_material(
    desc: &mut SceneDesc,
    material: &ObjMaterial,
    path: &Path,
    assets: &dyn AssetSource,
    report: &mut Report,
) -> Handle<MaterialDesc> {
    let color = |rgb: Option<[f32; 3]>| rgb.map(|[r, g, b]| SpectrumDesc::rgb(r, g, b));
    let mut reflectance: SpectrumParameter = color(material.diffuse).unwrap_or(0.5.into()).into();
    if let Some(map) = &material.diffuse_map {
        let path = resolve(assets, map, &path.to_string_lossy(), "");
        match images::decode(assets, &path, None) {
            Ok(image) => {
                let image =
                    desc.images.push(description::ImageDesc { name: map.clone(), image: Arc::new(image) });
                let kind = TextureKind::Image(ImageTextureDesc::new(image));
                reflectance = desc.spectrum_textures.push(TextureDesc::new(kind)).into();
            }
            Err(message) => {
                let message = format!("cannot read the image `{}`: {message}", path.display());
                report.warning("unreadable-image", message, Span::NONE);
            }
        }
    }
    let dark = material.diffuse.is_some_and(|rgb| rgb.iter().all(|&value| value < 1e-3));
    let shines = material.specular.is_some_and(|rgb| rgb.iter().any(|&value| value > 0.0));
    let clear = material.opacity.is_some_and(|opacity| opacity < 0.5) || material.illumination == Some(7);
    // The Phong exponent of a lobe as wide as a microfacet distribution's is 2/α² − 2.
    let alpha = (2.0 / (material.shininess.unwrap_or(0.0).max(0.0) + 2.0)).sqrt();
    let roughness = RoughnessDesc { u: alpha.into(), v: alpha.into(), remap: false };
    let kind = if clear {
        let eta = material.index_of_refraction.filter(|&eta| eta > 1.0).unwrap_or(1.5);
        MaterialKind::Dielectric { eta: eta.into(), roughness: RoughnessDesc::default() }
    } else if dark && shines && material.diffuse_map.is_none() {
        let reflectance =
            ConductorReflectance::Reflectance(color(material.specular).unwrap_or(0.5.into()).into());
        MaterialKind::Conductor(ConductorDesc { reflectance, roughness })
    } else if shines {
        MaterialKind::CoatedDiffuse(CoatedDiffuseDesc {
            reflectance,
            roughness,
            ..CoatedDiffuseDesc::default()
        })
    } else {
        MaterialKind::Diffuse { reflectance }
    };
    desc.materials.push(MaterialDesc { name: material.name.clone(), ..kind.into() })
}
