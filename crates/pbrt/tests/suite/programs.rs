//! Descriptions that programs make: what the importer never gives.

use std::sync::Arc;

use alhazen_pbrt::{ExportError, export, export_camera};
use assets::MemoryAssets;
use description::{
    AreaLightDesc, CameraDesc, CameraKind, CoatedConductorDesc, ColorSpaceDesc, ConductorDesc, ImageDesc,
    ImageTextureDesc, InfiniteRadiance, LightDesc, LightKind, MaterialDesc, MaterialKind, MeshDesc,
    ObjectDesc, RoughnessDesc, SceneDesc, ShapeDesc, ShapeKind, SpectrumDesc, TextureDesc, TextureKind,
    TransformDesc, UvImageDesc, WrapMode,
};
use image::{ColorEncoding, Image, Pixels};
use math::{DMat4, DVec3, Vec3};

use crate::plain::difference;
use crate::{read, round_trip};

fn check(desc: &SceneDesc) -> String {
    let (exported, again) = round_trip(desc);
    assert_eq!(difference(desc, &again), None, "{}", exported.text);
    exported.text
}

fn sphere() -> ShapeDesc {
    ShapeKind::Sphere { radius: 1.0, z_min: -1.0, z_max: 1.0, phi_max: 360.0 }.into()
}

/// Why a description cannot be written.
fn problem(desc: &SceneDesc) -> String {
    match export(desc, "files", &mut |_, _| Ok(())) {
        Err(ExportError::Unsupported(problem)) => problem,
        other => panic!("{other:?}"),
    }
}

#[test]
fn constants_are_kept() {
    let mut desc = SceneDesc::default();
    let material = desc.materials.push(MaterialKind::Diffuse { reflectance: 0.65.into() }.into());
    let radiance = InfiniteRadiance::Constant(SpectrumDesc::Constant(2.5));
    desc.lights.push(LightKind::Infinite { radiance, illuminance: Some(3.0), portal: None }.into());
    let light = AreaLightDesc { group: Some("glow".into()), ..AreaLightDesc::new(0.1.into()) };
    let area_light = Some(desc.area_lights.push(light));
    desc.shapes.push(ShapeDesc { material: Some(material), area_light, ..sphere() });
    check(&desc);
}

/// The white of a colour space is the default of lights alone.
#[test]
fn white_surfaces_are_written() {
    let mut desc = SceneDesc::default();
    let white = SpectrumDesc::Illuminant(ColorSpaceDesc::Srgb);
    desc.materials.push(MaterialKind::Diffuse { reflectance: white.into() }.into());
    let (exported, _) = round_trip(&desc);
    assert!(exported.text.contains(r#""spectrum reflectance" "stdillum-D65""#), "{}", exported.text);
}

/// Parameters of a light keep their values beside an image.
#[test]
fn parameters_beside_images_of_skies_are_kept() {
    let mut desc = SceneDesc::default();
    let image = Image::from_fn(4, 4, ["R", "G", "B"], |x, y| [x as f32, y as f32, 1.0]);
    let image = desc.images.push(ImageDesc { name: "sky".into(), image: Arc::new(image) });
    let portal = Some([Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y]);
    for (illuminance, portal) in [(Some(3.0), portal), (None, portal), (Some(2.0), None)] {
        let radiance = InfiniteRadiance::Image(image);
        desc.lights.push(LightKind::Infinite { radiance, illuminance, portal }.into());
    }
    check(&desc);
}

#[test]
fn single_sided_shapes_are_an_extension() {
    let mut desc = SceneDesc::default();
    desc.shapes.push(sphere());
    desc.shapes.push(ShapeDesc { single_sided: true, ..sphere() });
    let (exported, again) = round_trip(&desc);
    assert_eq!(difference(&desc, &again), None, "{}", exported.text);
    assert_eq!(again.shapes.iter().map(|(_, shape)| shape.single_sided).collect::<Vec<_>>(), [false, true]);
    assert_eq!(exported.extensions, ["single-sided shapes"]);
}

#[test]
fn images_are_kept_with_their_codes_and_values() {
    let codes: Vec<u8> = (0..=255).collect();
    let mut desc = SceneDesc::default();
    let mut images = Vec::new();
    for encoding in [ColorEncoding::Srgb, ColorEncoding::Linear, ColorEncoding::Gamma(1.7)] {
        for (channels, width) in [(&["Y"][..], 16), (&["Y", "A"], 8), (&["R", "G", "B", "A"], 4)] {
            let pixels = Pixels::U8(codes.clone(), encoding);
            images.push(Image::new(width, 16, channels.iter().copied(), pixels).unwrap());
        }
    }
    images.push(Image::from_fn(3, 2, ["R", "G", "B"], |x, y| [x as f32 / 3.0, y as f32, 1e-20]));
    images.push(Image::from_fn(3, 2, ["R", "G", "B"], |x, y| [x as f32, y as f32, 7.0]).to_f16());
    for image in images {
        let image = desc.images.push(ImageDesc { name: "any".into(), image: Arc::new(image) });
        let kind = TextureKind::Image(ImageTextureDesc { scale: 0.5, ..ImageTextureDesc::new(image) });
        let texture = desc.spectrum_textures.push(TextureDesc::new(kind));
        let kind = MaterialKind::Diffuse { reflectance: texture.into() };
        // Normal maps are read as linear, lights as sRGB, whatever the codes are.
        desc.materials.push(MaterialDesc {
            normal_map: Some(UvImageDesc::new(image, WrapMode::Repeat)),
            ..kind.into()
        });
        desc.lights.push(LightDesc::from(LightKind::Projection {
            image: Some(image),
            power: None,
            fov: 45.0,
        }));
    }
    let text = check(&desc);
    assert!(text.contains(r#""string encoding" "gamma 1.7""#), "{text}");
}

#[test]
fn large_meshes_are_files_that_instances_share() {
    let positions: Arc<[Vec3]> = (0..300).map(|i| Vec3::new(i as f32 / 3.0, (i * i) as f32, -0.0)).collect();
    let indices = (0..298).map(|i| [i, i + 1, i + 2]).collect();
    let mesh = MeshDesc { indices, positions: positions.clone(), normals: positions, ..MeshDesc::default() };
    let mut desc = SceneDesc::default();
    for x in 0..3 {
        let world_from_object = TransformDesc::translation(f64::from(x) / 3.0, 0.0, 0.0);
        desc.shapes.push(ShapeDesc { world_from_object, ..ShapeKind::Triangles(mesh.clone()).into() });
    }
    let text = check(&desc);
    assert_eq!(text.matches("files/mesh-1.ply").count(), 3);
    assert!(!text.contains("mesh-2"));
}

#[test]
fn names_become_unique() {
    let mut desc = SceneDesc::default();
    for name in ["", "red", "red", "material-0"] {
        let kind = MaterialKind::Diffuse { reflectance: SpectrumDesc::rgb(0.5, 0.25, 0.125).into() };
        let material = desc.materials.push(MaterialDesc { name: name.into(), ..kind.into() });
        desc.shapes.push(ShapeDesc { material: Some(material), ..sphere() });
    }
    for _ in 0..2 {
        desc.objects.push(ObjectDesc::default());
    }
    let (exported, again) = round_trip(&desc);
    let names: Vec<_> = again.materials.iter().map(|(_, material)| material.name.as_str()).collect();
    assert_eq!(names, ["material-0-2", "red", "red-2", "material-0"], "{}", exported.text);
}

#[test]
fn what_the_format_cannot_express_is_an_error() {
    let mut desc = SceneDesc::default();
    let rough = |remap| RoughnessDesc { remap, ..RoughnessDesc::isotropic(0.3) };
    let conductor = ConductorDesc { roughness: rough(true), ..ConductorDesc::default() };
    let coated = CoatedConductorDesc { conductor, roughness: rough(false), ..CoatedConductorDesc::default() };
    desc.materials.push(MaterialKind::CoatedConductor(coated).into());
    assert!(problem(&desc).contains("`remaproughness` differs"), "{}", problem(&desc));

    let mut desc = SceneDesc::default();
    for end in [1.0, 2.0] {
        let moved = TransformDesc::translation(1.0, 0.0, 0.0);
        let moving = TransformDesc { end: moved.end, times: [0.0, end], ..TransformDesc::default() };
        desc.shapes.push(ShapeDesc { world_from_object: moving, ..sphere() });
    }
    assert!(problem(&desc).contains("from 0 to 1 and from 0 to 2"), "{}", problem(&desc));

    let mut desc = SceneDesc::default();
    desc.shapes.push(ShapeDesc { alpha: Some(f32::NAN.into()), ..sphere() });
    assert!(problem(&desc).contains("`alpha` cannot be NaN"), "{}", problem(&desc));
}

#[test]
fn a_camera_alone_is_read_back_where_it_was() {
    let turn = DMat4::from_rotation_x(0.3) * DMat4::from_rotation_y(-1.2);
    let place = turn * DMat4::from_translation(DVec3::new(300.0, -20.0, 7.5));
    let mirror = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let stretch = DMat4::from_scale(DVec3::new(1.0, 2.0, 1.0));
    for (matrix, statement) in [
        (DMat4::IDENTITY, "LookAt 0 0 0  0 0 1  0 1 0\n"),
        (place, "LookAt -300 20 -7.5  "),
        (mirror * place, "Scale -1 1 1\nLookAt -300 20 -7.5  "),
        (stretch * place, "Transform ["),
    ] {
        let kind =
            CameraKind::Perspective { screen: Default::default(), lens: Default::default(), fov: 40.0 };
        let camera_from_world = TransformDesc::fixed(matrix);
        let text = export_camera(&CameraDesc { kind, camera_from_world, ..CameraDesc::default() }).unwrap();
        assert!(
            text.starts_with(statement) && text.contains("Camera \"perspective\" \"float fov\" 40"),
            "{text}"
        );
        let scene = format!("{text}WorldBegin\nShape \"sphere\"\n");
        let read = read(&MemoryAssets::default().with("scene.pbrt", scene.as_bytes()));
        let error = (read.camera.camera_from_world.start - matrix).to_cols_array();
        assert!(error.iter().all(|e| e.abs() < 1e-4), "{text}: {error:?}");
        assert!(matches!(read.camera.kind, CameraKind::Perspective { fov: 40.0, .. }));
    }
}

#[test]
fn a_file_that_cannot_be_written_ends_the_export() {
    let mut desc = SceneDesc::default();
    for size in [2, 3] {
        let image = Arc::new(Image::from_fn(size, size, ["R", "G", "B"], |_, _| [1.0; 3]));
        let image = desc.images.push(ImageDesc { name: "any".into(), image });
        desc.lights.push(LightKind::Projection { image: Some(image), power: None, fov: 45.0 }.into());
    }
    let mut calls = 0;
    let result = export(&desc, "files", &mut |_, _| {
        calls += 1;
        Err(std::io::Error::other("the disk is full"))
    });
    assert_eq!(result.unwrap_err().to_string(), "cannot write image-1.exr: the disk is full");
    assert_eq!(calls, 1);
}
