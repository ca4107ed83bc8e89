//! The effect of every directive on the description.

use assets::MemoryAssets;
use description::Imported;
use description::{
    CameraKind, ColorSpaceDesc, FilmKind, GBufferSpace, Handle, ImageChannel, IntegratorDesc, LightKind,
    MaterialKind, MediumKind, OpenPbrDesc, Parameter, PathDesc, SamplerKind, SceneDesc, ShapeKind,
    SpectrumDesc, TextureKind, TransformDesc,
};
use math::{DMat4, DVec3, Vec3};

fn read_with(assets: MemoryAssets, text: &str) -> Imported {
    let imported = alhazen_pbrt::read("scene.pbrt", &assets.with("scene.pbrt", text));
    assert!(!imported.has_errors(), "{text}\n{:#?}", imported.diagnostics);
    imported
}

/// Includes, meshes, images and spectra are looked for beside the first file, then in the current
/// folder, and at last beside the file that names them.
#[test]
fn files_are_looked_for_where_pbrt_does() {
    const QUAD: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
        property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
        0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
    let part = r#"Include "camera.pbrt" Shape "plymesh" "string filename" "a.ply"
        Texture "t" "spectrum" "imagemap" "string filename" "a.pfm"
        LightSource "point" "spectrum I" "a.spd""#;
    let pixel = [b"Pf\n1 1\n-1\n".as_slice(), &1.0_f32.to_le_bytes()].concat();
    let files: [(&str, Vec<u8>); 4] = [
        ("camera.pbrt", b"Shape \"sphere\"".to_vec()),
        ("a.ply", QUAD.into()),
        ("a.pfm", pixel),
        ("a.spd", b"400 1 700 1".to_vec()),
    ];
    // Of two places where the files are, the first is right; in the second they are damaged.
    for places in [["s/", ""], ["s/", "s/parts/"], ["", "s/parts/"], ["s/parts/", "elsewhere/"]] {
        let assets = MemoryAssets::default()
            .with("s/scene.pbrt", "WorldBegin Include \"parts/list.pbrt\"")
            .with("s/parts/list.pbrt", part);
        let assets = files.iter().fold(assets, |assets, (name, content)| {
            let [right, wrong] = places.map(|folder| format!("{folder}{name}"));
            assets.with(right, content.clone()).with(wrong, "wrong")
        });
        let imported = alhazen_pbrt::read("s/scene.pbrt", &assets);
        assert!(!imported.has_errors(), "{places:?}\n{:#?}", imported.diagnostics);
        assert_eq!(imported.desc.shapes.len(), 2);
    }
    // Where a file is missing, all places are told.
    let assets = MemoryAssets::default().with("s/scene.pbrt", "Include \"x/none.pbrt\" WorldBegin");
    let message = alhazen_pbrt::read("s/scene.pbrt", &assets).diagnostics[0].message.clone();
    let expected =
        "cannot read `s/x/none.pbrt`: no such file; nor is there `x/none.pbrt` in the current folder";
    assert!(message.starts_with(expected), "{message}");
}

fn read(text: &str) -> SceneDesc {
    read_with(MemoryAssets::default(), text).desc
}

fn world(text: &str) -> SceneDesc {
    read(&format!("WorldBegin {text}"))
}

/// The transform of the first shape.
fn transform(text: &str) -> TransformDesc {
    world(&format!("{text} Shape \"sphere\""))
        .shapes
        .iter()
        .next()
        .expect("there is a shape")
        .1
        .world_from_object
}

fn assert_near(a: DMat4, b: DMat4) {
    assert!(a.abs_diff_eq(b, 1e-12), "{a}\n{b}");
}

#[test]
fn settings_before_the_world() {
    let desc = read(
        r#"Option "seed" 7 Option "forcediffuse" true Option "displacementedgescale" 2 ColorSpace "rec2020"
        Film "spectral" "integer nbuckets" 8 "float iso" 200 "integer pixelbounds" [1 5 2 6] Sampler "stratified" "integer xsamples" 2
        PixelFilter "mitchell" "float B" .5 Integrator "path" "integer maxdepth" 9 "string lightsampler" "power"
        Accelerator "kdtree" "integer maxprims" 3 Camera "orthographic" "float screenwindow" [-2 2 -1 1] WorldBegin"#,
    );
    assert_eq!(
        (desc.options.seed, desc.options.force_diffuse, desc.options.displacement_edge_scale),
        (7, true, 2.0)
    );
    assert!(matches!(desc.film.kind, FilmKind::Spectral { buckets: 8, .. }));
    assert_eq!((desc.film.color_space, desc.film.sensor.iso), (ColorSpaceDesc::Rec2020, 200.0));
    assert_eq!(desc.film.pixel_bounds, Some([1, 5, 2, 6]));
    assert_eq!(desc.sampler.kind, SamplerKind::Stratified { strata: [2, 4], jitter: true });
    assert_eq!(desc.sampler.kind.samples_per_pixel(), 8);
    assert!(matches!(*desc.filter, description::FilterDesc::Mitchell { b: 0.5, .. }));
    assert!(matches!(*desc.integrator, IntegratorDesc::Path(PathDesc { max_depth: 9, .. })));
    assert!(matches!(*desc.accelerator, description::AcceleratorDesc::KdTree { max_prims: 3, .. }));
    assert!(
        matches!(&desc.camera.kind, CameraKind::Orthographic { screen, .. } if screen.window == Some([-2.0, 2.0, -1.0, 1.0]))
    );
}

#[test]
fn layers_of_the_film() {
    let film = |text: &str| read(&format!("{text} WorldBegin")).film.value;
    let rgb = film(r#"Film "rgb" "string layers" [ "depth" "object-id" ]"#);
    assert_eq!(rgb.kind, FilmKind::Rgb);
    assert_eq!(rgb.layers.iter().map(|name| &*name.value).collect::<Vec<_>>(), ["depth", "object-id"]);
    let gbuffer = film(r#"Film "gbuffer""#);
    assert_eq!(gbuffer.kind, FilmKind::GBuffer { space: GBufferSpace::Camera });
    let gbuffer = film(r#"Film "gbuffer" "string coordinatesystem" "world""#);
    assert_eq!(gbuffer.kind, FilmKind::GBuffer { space: GBufferSpace::World });
}

#[test]
fn the_quality_of_the_tree() {
    use description::BuildQualityDesc::{Balanced, Fast, High};
    for (parameters, quality) in [
        ("", Balanced),
        (r#""string splitmethod" "hlbvh""#, Fast),
        (r#""string splitmethod" "middle""#, Balanced),
        (r#""string splitmethod" "hlbvh" "string quality" "high""#, High),
        (r#""string quality" "fast""#, Fast),
    ] {
        let desc = read(&format!(r#"Accelerator "bvh" {parameters} WorldBegin"#));
        assert_eq!(desc.accelerator.quality(), quality, "{parameters}");
    }
    for (parameters, quality) in [("", Balanced), (r#""string quality" "high""#, High)] {
        let desc = read(&format!(r#"Accelerator "kdtree" {parameters} WorldBegin"#));
        assert_eq!(desc.accelerator.quality(), quality, "{parameters}");
    }
}

#[test]
fn omitted_statements_have_the_defaults_of_the_format() {
    let desc = read("WorldBegin");
    assert_eq!((desc.film.resolution, desc.sampler.kind.samples_per_pixel()), ([1280, 720], 16));
    assert_eq!(*desc.filter, description::FilterDesc::Gaussian { radius: [1.5, 1.5], sigma: 0.5 });
    assert!(matches!(*desc.integrator, IntegratorDesc::VolPath(PathDesc { max_depth: 5, .. })));
}

#[test]
fn transforms_compose_from_the_right() {
    let (t, s) =
        (DMat4::from_translation(DVec3::new(1.0, 2.0, 3.0)), DMat4::from_scale(DVec3::new(2.0, 3.0, 4.0)));
    let r = DMat4::from_axis_angle(DVec3::Z, 30_f64.to_radians());
    let found = transform("Translate 1 2 3 Scale 2 3 4 Rotate 30 0 0 1");
    assert_near(found.start, t * s * r);
    assert!(!found.is_animated());
    assert_near(transform("Scale 2 3 4 Identity Translate 1 2 3").start, t);
    let columns = "[2 0 0 0 0 3 0 0 0 0 4 0 1 2 3 1]";
    assert_near(transform(&format!("Scale 9 9 9 Transform {columns}")).start, t * s);
    assert_near(transform(&format!("Scale 2 3 4 ConcatTransform {columns}")).start, s * t * s);
}

#[test]
fn look_at_puts_the_target_before_the_camera() {
    let desc = read("LookAt 1 2 3 4 2 3 0 0 1 Camera \"perspective\" \"float fov\" 50 WorldBegin");
    let camera = desc.camera.camera_from_world.start;
    assert!(camera.transform_point3(DVec3::new(1.0, 2.0, 3.0)).length() < 1e-12);
    assert!(
        (camera.transform_point3(DVec3::new(4.0, 2.0, 3.0)) - DVec3::new(0.0, 0.0, 3.0)).length() < 1e-12
    );
    assert!(camera.transform_vector3(DVec3::Z).y > 0.99);
    // x to the right in a left-handed space: up × forwards.
    assert!((camera.transform_vector3(DVec3::Z.cross(DVec3::X)) - DVec3::X).length() < 1e-12);
}

#[test]
fn coordinate_systems_are_remembered() {
    let here = transform("Translate 1 2 3 CoordinateSystem \"here\" Identity CoordSysTransform \"here\"");
    assert_near(here.start, DMat4::from_translation(DVec3::new(1.0, 2.0, 3.0)));
    let desc = read(
        "Translate 0 0 5 Camera \"perspective\" WorldBegin CoordSysTransform \"camera\" Shape \"sphere\"
        CoordSysTransform \"world\" Shape \"disk\"",
    );
    let transforms: Vec<_> = desc.shapes.iter().map(|(_, shape)| shape.world_from_object.start).collect();
    assert_near(transforms[0], DMat4::from_translation(DVec3::new(0.0, 0.0, -5.0)));
    assert_near(transforms[1], DMat4::IDENTITY);
}

#[test]
fn transforms_may_move() {
    let desc = read(
        "TransformTimes 1 3 ActiveTransform EndTime Translate 0 0 1 ActiveTransform All Camera \"perspective\"
        WorldBegin ActiveTransform StartTime Translate 1 0 0 ActiveTransform EndTime Translate 2 0 0 Shape \"sphere\"
        AttributeBegin ActiveTransform All Translate 0 1 0 AttributeEnd LightSource \"point\"",
    );
    assert!(desc.camera.camera_from_world.is_animated());
    let shape = desc.shapes.iter().next().unwrap().1.world_from_object;
    assert_near(shape.start, DMat4::from_translation(DVec3::X));
    assert_near(shape.end, DMat4::from_translation(2.0 * DVec3::X));
    assert_eq!(shape.times, [1.0, 3.0]);
    assert_eq!(desc.lights.iter().next().unwrap().1.world_from_light, shape);
}

#[test]
fn blocks_restore_the_graphics_state() {
    let desc = world(
        r#"Material "diffuse" AttributeBegin Translate 1 0 0 ReverseOrientation Material "conductor"
        AreaLightSource "diffuse" "rgb L" [1 2 3] Shape "sphere" AttributeEnd Shape "disk""#,
    );
    let shapes: Vec<_> = desc.shapes.iter().map(|(_, shape)| shape).collect();
    let material = |i: usize| &desc.materials[shapes[i].material.unwrap()].kind;
    assert!(
        matches!(material(0), MaterialKind::Conductor(_))
            && matches!(material(1), MaterialKind::Diffuse { .. })
    );
    assert!(shapes[0].reverse_orientation && !shapes[1].reverse_orientation);
    assert!(shapes[0].area_light.is_some() && shapes[1].area_light.is_none());
    assert_eq!(desc.area_lights[shapes[0].area_light.unwrap()].radiance, SpectrumDesc::rgb(1.0, 2.0, 3.0));
    assert_near(shapes[1].world_from_object.start, DMat4::IDENTITY);
}

#[test]
fn attributes_are_defaults_that_statements_override() {
    let desc = world(
        r#"Attribute "shape" "float radius" 3 "float alpha" .5 AttributeBegin Attribute "shape" "float radius" 4 Shape "sphere"
        AttributeEnd Shape "sphere" Shape "sphere" "float radius" 5 Attribute "light" "float scale" 2 LightSource "point"
        Attribute "texture" "float uscale" 8 Texture "t" "float" "checkerboard" Texture "u" "float" "constant""#,
    );
    let radii: Vec<_> = desc
        .shapes
        .iter()
        .map(|(_, shape)| match shape.kind {
            ShapeKind::Sphere { radius, .. } => radius,
            _ => 0.0,
        })
        .collect();
    assert_eq!(radii, [4.0, 3.0, 5.0]);
    assert!(desc.shapes.iter().all(|(_, shape)| shape.alpha == Some(0.5.into())));
    assert_eq!(desc.lights.iter().next().unwrap().1.scale, 2.0);
}

#[test]
fn names_may_be_used_before_they_are_defined() {
    let desc = world(
        r#"NamedMaterial "m" MediumInterface "fog" "" Shape "sphere" ObjectInstance "o"
        MakeNamedMaterial "m" "string type" "mix" "string materials" ["a" "b"] "float amount" .25
        MakeNamedMaterial "a" "string type" "diffuse" "texture reflectance" "t" MakeNamedMaterial "b" "string type" "interface"
        Texture "t" "spectrum" "constant" "rgb value" [1 0 0] MakeNamedMedium "fog" "string type" "homogeneous" "float g" .5
        ObjectBegin "o" Translate 1 0 0 Shape "disk" ObjectEnd"#,
    );
    let shape = desc.shapes.iter().next().unwrap().1;
    let MaterialKind::Mix { materials, amount } = &desc.materials[shape.material.unwrap()].kind else {
        panic!()
    };
    assert_eq!((desc.materials[materials[1]].name.as_str(), amount), ("b", &0.25.into()));
    let MaterialKind::Diffuse { reflectance: Parameter::Texture(texture) } =
        &desc.materials[materials[0]].kind
    else {
        panic!()
    };
    assert!(matches!(
        desc.spectrum_textures[*texture].kind,
        TextureKind::Constant { value: SpectrumDesc::Rgb { .. } }
    ));
    let interface = shape.medium_interface.unwrap();
    assert!(interface.outside.is_none());
    let fog = &desc.media[interface.inside.unwrap()];
    assert!(matches!(fog.kind, MediumKind::Homogeneous { .. }) && fog.g == 0.5);
    let instance = desc.instances.iter().next().unwrap().1;
    assert_eq!(desc.objects[instance.object].shapes.len(), 1);
}

#[test]
fn objects_and_instances_have_their_own_transforms() {
    let desc = world(
        "Translate 1 0 0 ObjectBegin \"o\" Translate 0 1 0 Shape \"sphere\" ObjectEnd Translate 0 0 1 ObjectInstance \"o\"",
    );
    let instance = desc.instances.iter().next().unwrap().1;
    let shape = desc.objects[instance.object].shapes.iter().next().unwrap().1;
    assert_near(shape.world_from_object.start, DMat4::from_translation(DVec3::new(1.0, 1.0, 0.0)));
    assert_near(instance.world_from_object.start, DMat4::from_translation(DVec3::new(1.0, 0.0, 1.0)));
}

#[test]
fn objects_may_contain_instances_of_later_objects() {
    let desc = world(
        "ObjectBegin \"a\" Translate 1 0 0 ObjectInstance \"b\" ObjectInstance \"b\" ObjectEnd
        ObjectBegin \"b\" Shape \"sphere\" ObjectEnd ObjectInstance \"a\"",
    );
    assert_eq!(desc.instances.len(), 1);
    let a = &desc.objects[desc.instances.iter().next().unwrap().1.object];
    assert_eq!((a.shapes.len(), a.instances.len()), (0, 2));
    let inner = a.instances.iter().next().unwrap().1;
    assert_eq!(desc.objects[inner.object].name, "b");
    assert_near(inner.world_from_object.start, DMat4::from_translation(DVec3::X));
}

#[test]
fn points_of_a_mesh_are_divided_among_keyframes() {
    let desc = world(
        "Shape \"trianglemesh\" \"integer keyframes\" 2 \"point3 P\" [0 0 0 1 0 0 0 1 0 0 0 1 1 0 1 0 1 1] \"normal N\" [0 0 1 0 0 1 0 0 1]",
    );
    let ShapeKind::Triangles(mesh) = &desc.shapes.iter().next().unwrap().1.kind else { panic!() };
    assert_eq!((mesh.indices.len(), mesh.positions.len(), mesh.later.len()), (1, 3, 1));
    assert_eq!(mesh.later[0].positions[2], math::Vec3::new(0.0, 1.0, 1.0));
    assert_eq!(mesh.later[0].normals, mesh.normals);
}

#[test]
fn include_shares_the_state_and_import_does_not() {
    let assets = || {
        MemoryAssets::default()
            .with(
                "parts/a.pbrt",
                "Translate 1 0 0\r\nInclude \"b.pbrt\" # latin-1: \r\nTexture \"t\" \"float\" \"constant\"",
            )
            .with("parts/b.pbrt", b"Shape \"sphere\" # caf\xe9".as_slice())
    };
    for (directive, expected) in [("Include", DVec3::X), ("Import", DVec3::ZERO)] {
        let text = format!("WorldBegin {directive} \"parts/a.pbrt\" Shape \"disk\" \"texture alpha\" \"t\"");
        let desc = read_with(assets(), &text).desc;
        let transforms: Vec<_> = desc.shapes.iter().map(|(_, shape)| shape.world_from_object.start).collect();
        assert_near(transforms[0], DMat4::from_translation(DVec3::X));
        assert_near(transforms[1], DMat4::from_translation(expected));
    }
}

#[test]
fn spectra_are_given_in_five_ways() {
    let text = r#"WorldBegin ColorSpace "dci-p3" LightSource "point" "rgb I" [1 2 3] LightSource "point" "blackbody I" 5000
        LightSource "point" "spectrum I" "stdillum-D65" LightSource "point" "spectrum I" [400 1 700 2]
        LightSource "point" "spectrum I" "a.spd" LightSource "point""#;
    let desc = read_with(MemoryAssets::default().with("a.spd", "# comment\n400 1\n700 2\n"), text).desc;
    let samples = SpectrumDesc::Samples([(400.0, 1.0), (700.0, 2.0)].into());
    let expected = [
        SpectrumDesc::Rgb { rgb: [1.0, 2.0, 3.0], space: ColorSpaceDesc::DciP3 },
        SpectrumDesc::Blackbody(5000.0),
        SpectrumDesc::Named("stdillum-D65".into()),
        samples.clone(),
        samples,
        SpectrumDesc::Illuminant(ColorSpaceDesc::DciP3),
    ];
    for ((_, light), expected) in desc.lights.iter().zip(expected) {
        assert!(matches!(&light.kind, LightKind::Point { intensity, .. } if *intensity == expected));
    }
}

#[test]
fn meshes_are_read_from_files_and_from_the_text() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nproperty float s\n\
        property float t\nelement face 2\nproperty list uchar int vertex_indices\nproperty int face_indices\nend_header\n\
        0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n2 2 0 1 1\n4 0 1 2 3 7\n3 0 1 4 8\n";
    let text = r#"WorldBegin Shape "plymesh" "string filename" "a.ply"
        Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "normal N" [0 0 1 0 0 1 0 0 1]
        Shape "bilinearmesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 0]"#;
    let desc = read_with(MemoryAssets::default().with("a.ply", ply), text).desc;
    let shapes: Vec<_> = desc.shapes.iter().map(|(_, shape)| &shape.kind).collect();
    let ShapeKind::PlyMesh { triangles, patches, .. } = shapes[0] else { panic!() };
    assert_eq!((&triangles.indices[..], &triangles.face_indices[..]), (&[[0, 1, 4]][..], &[8][..]));
    assert_eq!((&patches.indices[..], &patches.face_indices[..]), (&[[0, 1, 3, 2]][..], &[7][..]));
    assert_eq!((patches.uvs.len(), patches.positions[4]), (5, Vec3::new(2.0, 2.0, 0.0)));
    assert!(
        matches!(shapes[1], ShapeKind::Triangles(mesh) if mesh.indices[..] == [[0, 1, 2]] && mesh.normals.len() == 3)
    );
    assert!(matches!(shapes[2], ShapeKind::Patches(mesh) if mesh.indices[..] == [[0, 1, 2, 3]]));
}

#[test]
fn every_parameter_has_its_span() {
    let imported = read_with(MemoryAssets::default(), "WorldBegin Shape \"sphere\" \"float radius\" 2");
    let (handle, _) = imported.desc.shapes.iter().next().unwrap();
    let origin = imported.desc.shapes.origin(handle);
    assert_eq!(imported.sources.snippet(origin.span), "Shape \"sphere\" \"float radius\" 2");
    assert_eq!(imported.sources.snippet(origin.parameter("radius")), "\"float radius\" 2");
}

#[test]
fn an_index_of_refraction_is_a_number_or_any_spectrum() {
    let index = |eta: &str| {
        let desc = world(&format!("Material \"dielectric\" {eta} Shape \"sphere\""));
        let (_, material) = desc.materials.iter().next().expect("there is a material");
        match &material.kind {
            MaterialKind::Dielectric { eta, .. } => eta.clone(),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(index(""), SpectrumDesc::Constant(1.5));
    assert_eq!(index("\"float eta\" 1.3"), SpectrumDesc::Constant(1.3));
    assert_eq!(index("\"spectrum eta\" \"glass-BK7\""), SpectrumDesc::Named("glass-BK7".into()));
    assert_eq!(index("\"rgb eta\" [1.3 1.4 1.5]"), SpectrumDesc::rgb(1.3, 1.4, 1.5));
}

#[test]
fn principled_materials_have_the_parameters_of_the_specification() {
    let openpbr = |parameters: &str| {
        let imported = read_with(
            MemoryAssets::default(),
            &format!("WorldBegin Material \"openpbr\" {parameters} Shape \"sphere\""),
        );
        let (_, material) = imported.desc.materials.iter().next().expect("there is a material");
        let MaterialKind::OpenPbr(desc) = &material.kind else { panic!("{:?}", material.kind) };
        let messages: Vec<String> = imported.diagnostics.iter().map(|found| found.message.clone()).collect();
        (OpenPbrDesc::clone(desc), messages)
    };
    let defaults = OpenPbrDesc::default();
    let (plain, messages) = openpbr("");
    assert_eq!((&plain.numbers, &plain.colors, messages.len()), (&defaults.numbers, &defaults.colors, 0));
    for (i, number) in OpenPbrDesc::NUMBERS.iter().enumerate() {
        let (given, messages) = openpbr(&format!("\"float {}\" 0.625", number.field.name));
        assert_eq!((&given.numbers[i], messages.len()), (&0.625.into(), 0), "{}", number.field.name);
    }
    for (i, (field, _)) in OpenPbrDesc::COLORS.iter().enumerate() {
        let (given, messages) = openpbr(&format!("\"rgb {}\" [0.1 0.2 0.3]", field.name));
        assert_eq!(given.colors[i], SpectrumDesc::rgb(0.1, 0.2, 0.3).into(), "{}", field.name);
        assert!(messages.is_empty(), "{messages:?}");
    }
    let (glowing, _) = openpbr("\"float emission_luminance\" 40 \"rgb emission_color\" [1 0.5 0]");
    assert_eq!(glowing.emission_luminance, 40.0);
    assert_eq!(glowing.emission_color, SpectrumDesc::rgb(1.0, 0.5, 0.0));
    assert!(openpbr("\"bool geometry_thin_walled\" true").0.thin_walled && !plain.thin_walled);
    let (below, messages) =
        openpbr("\"float subsurface_weight\" 1 \"rgb subsurface_radius_scale\" [0.1 0.2 0.3]");
    assert_eq!((below.subsurface_radius_scale, messages.len()), (SpectrumDesc::rgb(0.1, 0.2, 0.3).into(), 0));
}

#[test]
fn the_corners_of_a_crop_window_may_be_in_any_order() {
    let desc = read(r#"Film "rgb" "float cropwindow" [0.75 0.25 0 1] WorldBegin"#);
    assert_eq!(desc.film.crop_window, Some([0.25, 0.75, 0.0, 1.0]));
}

#[test]
fn a_texture_of_numbers_may_name_a_channel() {
    let assets = || MemoryAssets::default().with("a.pfm", "Pf\n1 1\n-1\n\0\0\0\0");
    for (channel, expected) in [
        ("", None),
        (r#""string channel" "r""#, Some(ImageChannel::Red)),
        (r#""string channel" "g""#, Some(ImageChannel::Green)),
        (r#""string channel" "b""#, Some(ImageChannel::Blue)),
        (r#""string channel" "a""#, Some(ImageChannel::Alpha)),
    ] {
        let text =
            format!(r#"WorldBegin Texture "t" "float" "imagemap" "string filename" "a.pfm" {channel}"#);
        let desc = read_with(assets(), &text).desc;
        let TextureKind::Image(image) = &desc.float_textures[Handle::new(0)].kind else { panic!() };
        assert_eq!(image.channel, expected);
    }
}
