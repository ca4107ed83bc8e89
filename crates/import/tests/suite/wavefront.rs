//! OBJ and MTL files as other programs write them.

use alhazen_import::import;
use assets::{MemoryAssets, Mesh, MeshError, read_obj};
use description::Imported;
use description::{
    FloatParameter, ImageChannel, ImageTextureDesc, MappingDesc, MaterialDesc, MaterialKind, OpenPbrDesc,
    SceneDesc, ShapeDesc, ShapeKind, SpectrumDesc, SpectrumParameter, TextureKind, WrapMode,
};
use image::{ColorEncoding, Format, Image, Pixels, WriteOptions, encode, linear_from_srgb};
use math::{Vec2, Vec3};

const SQUARE: &str = "v -1 0 0\nv 1 0 0\nv 1 2 0\nv -1 2 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";

/// A PNG of two pixels.
fn picture(channels: &[&str], pixels: &[u8]) -> Vec<u8> {
    let pixels = Pixels::U8(pixels.into(), ColorEncoding::Srgb);
    let image = Image::new(2, 1, channels.iter().copied(), pixels).expect("two pixels");
    encode(&image, Format::Png, &WriteOptions::default()).expect("a picture")
}

/// A square of the material `m`, with pictures of two pixels.
fn square(mtl: &str) -> Imported {
    let obj = format!("mtllib a.mtl\n{SQUARE}usemtl m\nf 1/1 2/2 3/3 4/4\n");
    let colors = picture(&["R", "G", "B"], &[255, 0, 0, 0, 0, 255]);
    let assets = MemoryAssets::default()
        .with("a.obj", obj)
        .with("a.mtl", format!("newmtl m\n{mtl}"))
        .with("two words.png", colors.clone())
        .with("colors.png", colors)
        .with("white.png", picture(&["R", "G", "B"], &[255; 6]))
        .with("hole.png", picture(&["Y"], &[0, 255]))
        .with("cut.png", picture(&["R", "G", "B", "A"], &[255, 255, 255, 0, 255, 255, 255, 255]))
        .with("normals.png", picture(&["R", "G", "B"], &[128, 128, 255, 200, 100, 230]));
    import("a.obj", &assets)
}

fn messages(imported: &Imported) -> Vec<String> {
    imported.diagnostics.iter().map(|diagnostic| diagnostic.message.clone()).collect()
}

/// The square of a material about which nothing is said.
fn plain(mtl: &str) -> SceneDesc {
    let imported = square(mtl);
    assert!(imported.diagnostics.is_empty(), "{mtl}: {:#?}", imported.diagnostics);
    imported.desc
}

fn first(desc: &SceneDesc) -> (&ShapeDesc, &MaterialDesc) {
    let (_, shape) = desc.shapes.iter().next().expect("a shape");
    (shape, &desc.materials[shape.material.expect("a material")])
}

fn image_of(desc: &SceneDesc, parameter: &SpectrumParameter) -> ImageTextureDesc {
    let SpectrumParameter::Texture(texture) = parameter else { panic!("{parameter:?}") };
    let TextureKind::Image(image) = &desc.spectrum_textures[*texture].kind else { panic!("no image") };
    image.clone()
}

fn number_of(desc: &SceneDesc, parameter: &FloatParameter) -> ImageTextureDesc {
    let FloatParameter::Texture(texture) = parameter else { panic!("{parameter:?}") };
    let TextureKind::Image(image) = &desc.float_textures[*texture].kind else { panic!("no image") };
    image.clone()
}

/// The reflectance of a diffuse material.
fn reflectance(desc: &SceneDesc) -> &SpectrumParameter {
    match &first(desc).1.kind {
        MaterialKind::Diffuse { reflectance } => reflectance,
        kind => panic!("{kind:?}"),
    }
}

/// The two pixels of the picture of a diffuse material, with the factor on them.
fn colors(desc: &SceneDesc) -> [[f32; 3]; 2] {
    let texture = image_of(desc, reflectance(desc));
    let image = &desc.images[texture.image].image;
    [0, 1].map(|x| image.rgb(x, 0).map(|value| value * texture.scale))
}

#[test]
fn byte_order_marks_take_no_line_away() {
    let assets = |mark: &str| {
        MemoryAssets::default()
            .with(
                "a.obj",
                format!("{mark}v -1 0 0\nv 1 0 0\nv 0 2 0\nv 5 0 0\nmtllib a.mtl\nusemtl m\nf 1 2 3"),
            )
            .with("a.mtl", format!("{mark}newmtl m\nKd 0.8 0.1 0.1\n"))
    };
    let expected = SpectrumParameter::from(SpectrumDesc::rgb(0.8, 0.1, 0.1));
    for mark in ["", "\u{feff}"] {
        let imported = import("a.obj", &assets(mark));
        assert!(imported.diagnostics.is_empty(), "{:#?}", imported.diagnostics);
        let (shape, _) = first(&imported.desc);
        let ShapeKind::PlyMesh { triangles, .. } = &shape.kind else { panic!("{:?}", shape.kind) };
        assert_eq!(triangles.positions[0], Vec3::new(-1.0, 0.0, 0.0));
        assert_eq!(*reflectance(&imported.desc), expected);
    }
}

#[test]
fn a_face_without_normals_or_coordinates_keeps_those_of_others() {
    let start = "v -1 0 0\nv 1 0 0\nv 0 2 0\nvt .25 .25\nvn 0.6 0 0.8\nv 1.2 2 0\nf 1/1/1 2/1/1 3/1/1\n";
    let mesh = read_obj(format!("{start}f 2 4 3").as_bytes()).unwrap();
    assert_eq!(mesh.triangles[0], [0, 1, 2]);
    for corner in mesh.triangles[0] {
        assert_eq!(mesh.normals[corner as usize], Vec3::new(0.6, 0.0, 0.8));
        assert_eq!(mesh.uvs[corner as usize], Vec2::new(0.25, 0.25));
    }
    for corner in mesh.triangles[1] {
        assert_eq!((mesh.normals[corner as usize], mesh.uvs[corner as usize]), (Vec3::Z, Vec2::ZERO));
    }
    // As if the normals of the file were not there.
    let flat = read_obj(format!("{}f 2 4 3", start.replace("/1/1", "")).as_bytes()).unwrap();
    assert!(flat.normals.is_empty() && flat.uvs.is_empty() && flat.warnings.is_empty());
    assert_eq!(flat.positions.len(), 4);
    // Corners of one face that differ.
    let mixed = read_obj(format!("{start}f 2/1/1 4 3/1").as_bytes()).unwrap();
    assert_eq!(mixed.normals[mixed.triangles[1][0] as usize], Vec3::Z);
    assert!(mixed.warnings[0].starts_with("line 8: texture coordinates and normals that only some"));
}

#[test]
fn faces_of_a_smoothing_group_share_normals() {
    // Two sides of a roof, and a third face in no group.
    let roof = "v 0 1 0\nv 0 1 1\nv 1 0 0\nv 1 0 1\nv -1 0 0\nv -1 0 1\ns 1\nf 1 2 4 3\nf 2 1 5 6\ns off\nf 3 4 6 5\n";
    let mesh = read_obj(roof.as_bytes()).unwrap();
    let of = |position: [f32; 3], normal: Vec3| {
        let is_it =
            |(p, n): (&Vec3, &Vec3)| *p == Vec3::from_array(position) && (*n - normal).length() < 1e-6;
        mesh.positions.iter().zip(&mesh.normals).filter(|&pair| is_it(pair)).count()
    };
    assert_eq!(
        (of([0.0, 1.0, 0.0], Vec3::Y), of([0.0, 1.0, 1.0], Vec3::Y)),
        (1, 1),
        "smooth along the ridge"
    );
    let slope = Vec3::new(0.5_f32.sqrt(), 0.5_f32.sqrt(), 0.0);
    assert_eq!(of([1.0, 0.0, 0.0], slope), 1);
    assert_eq!(of([1.0, 0.0, 0.0], -Vec3::Y), 1, "the face in no group is flat");
    assert!(read_obj(roof.replace("s 1", "s 0").as_bytes()).unwrap().normals.is_empty());
}

#[test]
fn corners_that_name_nothing_are_flat_and_named() {
    let obj = format!("{SQUARE}vn 0 0 1\nf 1/1/1 2/9/1 3/3/1\nf 1//0 2//0 4//0\n");
    let mesh = read_obj(obj.as_bytes()).unwrap();
    assert_eq!(mesh.triangles.len(), 2);
    assert!(mesh.uvs.is_empty());
    let expected = [
        "line 10, `2/9/1`: a corner whose texture coordinates is not defined before it has none",
        "line 10: texture coordinates and normals that only some corners of a face have are not used",
        "line 11, `1//0`: a corner whose normal is not defined before it has none",
    ];
    assert_eq!(mesh.warnings, expected);
    let error = read_obj(b"v 0 0 0\nv 1 0 0\n\nf 1 2 3").unwrap_err();
    assert_eq!(error, MeshError::Invalid("line 4: a corner has index `3`, but only 2 are defined".into()));
}

#[test]
fn what_is_not_read_is_named_with_its_line() {
    let obj =
        format!("o a\ng b\n{SQUARE}vn nan nan nan\nvp 1 2\np 1\nl 1 2\nf 1//1 2//1 3//1\nlod 3\nvp 1 2\n");
    let mesh = read_obj(obj.as_bytes()).unwrap();
    let expected = [
        "line 11: numbers that are not finite are read as 0",
        "line 12: `vp` is not read",
        "line 13: points and lines are not drawn",
        "line 16: `lod` is not read",
    ];
    assert_eq!(mesh.warnings, expected);
    assert_eq!(mesh.normals[0], Vec3::ZERO);
    let imported = square("Ks 0 0 0\nmap_Ks colors.png\nsharpness 60\nrefl -type sphere a.png\nPcr x\n");
    let expected =
        ["line 3: `map_ks`", "line 4: `sharpness`", "line 5: `refl`", "line 6: `pcr` is no number"];
    for (message, expected) in messages(&imported).iter().zip(expected) {
        assert!(message.starts_with(&format!("`a.mtl`: {expected}")), "{message}");
    }
    assert_eq!(imported.diagnostics.len(), 4);
}

#[test]
fn files_may_have_names_with_spaces() {
    let import = |line: &str, files: &[&str]| {
        let mut assets =
            MemoryAssets::default().with("d/a.obj", format!("{line}\n{SQUARE}usemtl m #1\nf 1 2 3\n"));
        for file in files {
            assets = assets.with(*file, "newmtl m #1\nKd .5 .25 .125\n");
        }
        messages(&import("d/a.obj", &assets))
    };
    for (line, files) in [
        ("mtllib my file.mtl", &["d/my file.mtl"][..]),
        ("mtllib \"my file.mtl\"", &["d/my file.mtl"]),
        ("mtllib a.mtl my file.mtl", &["d/a.mtl", "d/my file.mtl"]),
        ("mtllib sub\\b.mtl", &["d/sub/b.mtl"]),
    ] {
        assert_eq!(import(line, files), Vec::<String>::new(), "{line}");
    }
    let found = import("mtllib my file.mtl", &[]);
    assert!(found[0].starts_with("cannot read the materials `d/my file.mtl`"), "{found:?}");
}

#[test]
fn options_of_maps_change_the_picture() {
    let halves = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    for mtl in ["map_Kd two words.png", "map_Kd -s 1 1 1 two words.png", "map_Kd missing\\two words.png"] {
        assert_eq!(colors(&plain(mtl)), halves, "{mtl}");
    }
    let lookup = |mtl: &str| {
        let desc = plain(mtl);
        image_of(&desc, reflectance(&desc))
    };
    let moved = lookup("map_Kd -s 2 3 1 -o 0.5 0 0 -clamp on colors.png");
    assert_eq!(moved.mapping, MappingDesc::Uv { scale: [2.0, 3.0], delta: [0.5, 0.0] });
    assert_eq!((moved.wrap, lookup("map_Kd colors.png").wrap), (WrapMode::Clamp, WrapMode::Repeat));
    assert_eq!(colors(&plain("map_Kd -mm 0 0.5 colors.png")), [[0.5, 0.0, 0.0], [0.0, 0.0, 0.5]]);
    assert_eq!(colors(&plain("map_Kd -mm 0.25 0.5 colors.png")), [[0.75, 0.25, 0.25], [0.25, 0.25, 0.75]]);
    assert_eq!(colors(&plain("map_Kd -imfchan b colors.png")), [[0.0; 3], [1.0; 3]]);
    let imported = square("map_Kd -t .5 .5 .5 -blendu off colors.png");
    assert_eq!(messages(&imported).len(), 2, "{:#?}", imported.diagnostics);
    assert_eq!(colors(&imported.desc), halves);
}

#[test]
fn a_picture_of_diffuse_reflection_is_multiplied_by_its_colour() {
    let [found, _] = colors(&plain("Kd 0.5 0.25 0.125\nmap_Kd white.png"));
    assert_eq!(found, [0.5, 0.25, 0.125]);
    assert_eq!(colors(&plain("map_Kd white.png\nKd 0.5 0.5 0.5")), [[0.5; 3]; 2]);
    assert_eq!(colors(&plain("map_Kd white.png")), [[1.0; 3]; 2]);
}

#[test]
fn dissolve_is_the_share_that_is_there_on_all_models() {
    for (mtl, share) in [("d 0.3", 0.3), ("d 0.7", 0.7), ("Tr 0.25", 0.75), ("d 0.5\nTr 0.9", 0.5)] {
        for model in ["", "illum 1\n", "illum 2\n"] {
            let desc = plain(&format!("Kd 0.8 0.1 0.1\n{model}{mtl}\n"));
            assert_eq!(first(&desc).0.alpha, Some(share.into()), "{mtl}");
            assert_eq!(*reflectance(&desc), SpectrumDesc::rgb(0.8, 0.1, 0.1).into());
        }
    }
    assert_eq!(first(&plain("d 1\n")).0.alpha, None);
    let halo = square("d -halo 0.3\n");
    assert_eq!((first(&halo.desc).0.alpha.clone(), halo.diagnostics.len()), (Some(0.3.into()), 1));
    let opaque = square("Tr 1\nillum 2\nmap_Kd white.png\n");
    assert_eq!((first(&opaque.desc).0.alpha.clone(), opaque.diagnostics.len()), (None, 1));
}

#[test]
fn a_picture_of_dissolve_cuts_holes() {
    for (mtl, scale, channel) in [
        ("map_d hole.png", 1.0, None),
        ("d 0.5\nmap_d hole.png", 0.5, None),
        ("map_d -imfchan r hole.png", 1.0, Some(ImageChannel::Red)),
        ("map_d cut.png", 1.0, None),
    ] {
        let desc = plain(mtl);
        let alpha = number_of(&desc, first(&desc).0.alpha.as_ref().unwrap());
        assert_eq!((alpha.scale, alpha.channel), (scale, channel), "{mtl}");
        let image = &desc.images[alpha.image].image;
        let share = |x| image.channel(x, 0, image.alpha_index().unwrap_or(0));
        assert_eq!([share(0), share(1)], [0.0, 1.0], "{mtl}");
    }
}

#[test]
fn only_models_of_glass_refract() {
    for model in 0..=10 {
        let desc = plain(&format!("illum {model}\nNi 1.4\nd 0.9\n"));
        let is_glass = matches!(first(&desc).1.kind, MaterialKind::Dielectric { .. });
        assert_eq!(is_glass, [4, 6, 7, 9].contains(&model), "{model}");
        assert_eq!(first(&desc).0.alpha, Some(0.9.into()), "{model}");
    }
    let tinted = plain("illum 7\nNi 1.4\nTf 0.5 1 0.5\n");
    assert!(matches!(first(&tinted).1.kind, MaterialKind::OpenPbr(_)));
}

#[test]
fn parameters_of_principled_surfaces_are_read() {
    let desc =
        plain("Kd 1 0 0\nPr 0.25\nPm 1\nPs 0.125\nPc 0.5\nPcr 0.75\naniso 0.5\nanisor 0\nmap_Pm hole.png\n");
    let MaterialKind::OpenPbr(surface) = &first(&desc).1.kind else { panic!("not principled") };
    let number = |name: &str| {
        let index = OpenPbrDesc::number(name).unwrap();
        surface.numbers[index].clone()
    };
    for (name, value) in [
        ("specular_roughness", 0.25),
        ("fuzz_weight", 0.125),
        ("coat_weight", 0.5),
        ("coat_roughness", 0.75),
        ("specular_roughness_anisotropy", 0.5),
    ] {
        assert_eq!(number(name), value.into(), "{name}");
    }
    let metal = number_of(&desc, &number("base_metalness"));
    assert_eq!((metal.channel, metal.scale), (Some(ImageChannel::Red), 1.0));
    assert_eq!(surface.colors[0], SpectrumDesc::rgb(1.0, 0.0, 0.0).into());
}

#[test]
fn pictures_of_light_and_relief_are_drawn() {
    let lamp = plain("Ke 2 2 2\nmap_Ke colors.png\n");
    let (shape, _) = first(&lamp);
    let light = &lamp.area_lights[shape.area_light.unwrap()];
    assert_eq!(lamp.images[light.image.unwrap().image].image.rgb(1, 0), [0.0, 0.0, 2.0]);
    let placed = plain("Ke 1 1 1\nmap_Ke -s 2 3 1 -o 0.5 0.25 0 -clamp on colors.png\n");
    let image = placed.area_lights[first(&placed).0.area_light.unwrap()].image.unwrap();
    assert_eq!((image.columns, image.wrap), ([[2.0, 0.0], [0.0, 3.0], [0.5, 0.25]], WrapMode::Clamp));
    let bumps = plain("map_Bump -bm 0.5 hole.png\n");
    let height = number_of(&bumps, first(&bumps).1.displacement.as_ref().unwrap());
    assert_eq!((height.scale, first(&bumps).1.normal_map), (0.5, None));
    for statement in ["norm", "map_Bump", "bump"] {
        let relief = plain(&format!("{statement} normals.png\n"));
        let (shape, material) = first(&relief);
        let normals = &relief.images[material.normal_map.unwrap().image].image;
        let expected = [200.0, 100.0, 230.0].map(|code: f32| code / 255.0);
        assert_eq!(normals.rgb(1, 0), expected, "{statement}");
        assert!(material.displacement.is_none());
        assert!(matches!(shape.kind, ShapeKind::Triangles(_)));
    }
}

#[test]
fn colours_of_vertices_are_srgb_codes_that_are_drawn() {
    let scene = |statement: &str, scale: f32| {
        let corners = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.5], [1.0, 1.0, 1.0]];
        let positions = ["-1 -1 0", "1 -1 0", "1 1 0", "-1 1 0"];
        let line = |(position, color): (&str, [f32; 3])| {
            let [r, g, b] = color.map(|value| value * scale);
            format!("v {position} {r} {g} {b}\n")
        };
        let vertices: String = positions.into_iter().zip(corners).map(line).collect();
        let obj = format!("mtllib a.mtl\n{vertices}{statement}\nf 1 2 3\nf 1 3 4\n");
        import("a.obj", &MemoryAssets::default().with("a.obj", obj).with("a.mtl", "newmtl m\nKd .5 1 1\n"))
    };
    let half = linear_from_srgb(0.5);
    for (statement, scale, red, warnings) in
        [("", 1.0, 1.0, 0), ("usemtl m", 1.0, 0.5, 0), ("", 255.0, 1.0, 1)]
    {
        let imported = scene(statement, scale);
        assert_eq!(imported.diagnostics.len(), warnings, "{:#?}", imported.diagnostics);
        let image = image_of(&imported.desc, reflectance(&imported.desc));
        let image = &imported.desc.images[image.image].image;
        let found = [image.rgb(0, 0), image.rgb(1, 0), image.rgb(0, 1)];
        let expected = [[red, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, half]];
        for (found, expected) in found.as_flattened().iter().zip(expected.as_flattened()) {
            assert!((found - expected).abs() < 1e-3, "{found}, not {expected}");
        }
    }
    // The same colour everywhere needs no picture.
    let even = "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n";
    let imported = import("a.obj", &MemoryAssets::default().with("a.obj", even));
    assert_eq!(*reflectance(&imported.desc), SpectrumDesc::rgb(1.0, 0.0, 0.0).into());
    let weights = read_obj(b"v 0 0 0 1\nv 1 0 0 2\nv 0 1 0\nf 1 2 3").unwrap();
    assert_eq!(weights.warnings, ["line 2: weights of vertices are not read"]);
    assert!(weights.colors.is_empty());
    let some = read_obj(b"v 0 0 0\nv 1 0 0 0 0 0\nv 0 1 0\nf 1 2 3").unwrap();
    assert_eq!((some.colors[0], some.warnings.len()), ([1.0; 3], 1));
    let _: Mesh = some;
}
