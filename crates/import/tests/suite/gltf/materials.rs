//! Materials and their extensions as principled surfaces.

use super::{File, mesh};
use description::{
    CoefficientsDesc, EdgeMode, FloatParameter, ImageChannel, ImageTextureDesc, MappingDesc, MaterialKind,
    MediumKind, OpenPbrDesc, Parameter, SceneDesc, Severity, SpectrumDesc, SpectrumParameter, TextureFilter,
    TextureKind, UvImageDesc, WrapMode,
};
use serde_json::{Value, json};

fn surface(desc: &SceneDesc) -> &OpenPbrDesc {
    let (_, shape) = desc.shapes.iter().next().expect("a shape");
    match &desc.materials[shape.material.expect("a material")].kind {
        MaterialKind::OpenPbr(surface) => surface,
        kind => panic!("{kind:?}"),
    }
}

fn parameter<'a>(desc: &'a SceneDesc, name: &str) -> &'a FloatParameter {
    let index = OpenPbrDesc::number(name);
    &surface(desc).numbers[index.expect("a name")]
}

fn number(desc: &SceneDesc, name: &str) -> f32 {
    *parameter(desc, name).value().expect("a constant")
}

fn color(desc: &SceneDesc, name: &str) -> [f32; 3] {
    let index = OpenPbrDesc::color(name);
    match &surface(desc).colors[index.expect("a name")] {
        SpectrumParameter::Value(SpectrumDesc::Rgb { rgb, .. }) => *rgb,
        SpectrumParameter::Value(SpectrumDesc::Constant(value)) => [*value; 3],
        other => panic!("{other:?}"),
    }
}

fn texture<'a>(desc: &'a SceneDesc, parameter: &FloatParameter) -> &'a ImageTextureDesc {
    match parameter {
        Parameter::Texture(handle) => match &desc.float_textures[*handle].kind {
            TextureKind::Image(image) => image,
            kind => panic!("{kind:?}"),
        },
        Parameter::Value(value) => panic!("{value}"),
    }
}

/// A material with an extension and smooth, white plastic.
fn extended(name: &str, extension: Value) -> Value {
    json!({
        "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
        "extensions": {name: extension},
    })
}

#[test]
fn metal_and_plastic() {
    let desc = File::quad(json!({"pbrMetallicRoughness": {
        "baseColorFactor": [0.2, 0.4, 0.6, 1], "metallicFactor": 0.25, "roughnessFactor": 0.5,
    }}))
    .scene();
    assert_eq!(color(&desc, "base_color"), [0.2, 0.4, 0.6]);
    assert_eq!(number(&desc, "base_metalness"), 0.25);
    assert_eq!(number(&desc, "specular_roughness"), 0.5);
    assert_eq!(number(&desc, "specular_ior"), 1.5);
    // The material of surfaces without one.
    let mut file = File::quad(json!({}));
    file.json["meshes"][0]["primitives"][0].as_object_mut().unwrap().remove("material");
    let desc = file.scene();
    assert_eq!((number(&desc, "base_metalness"), number(&desc, "specular_roughness")), (1.0, 1.0));
}

#[test]
fn textures_have_channels_factors_and_encodings() {
    let file = File::quad(json!({
        "pbrMetallicRoughness": {
            "baseColorTexture": {"index": 0},
            "metallicRoughnessTexture": {"index": 0},
            "metallicFactor": 0.5,
        },
    }))
    .textured(&[[255, 188, 0, 255], [0, 0, 0, 51]]);
    let desc = file.scene();
    let metalness = texture(&desc, parameter(&desc, "base_metalness"));
    assert_eq!((metalness.channel, metalness.scale), (Some(ImageChannel::Blue), 0.5));
    let roughness = texture(&desc, parameter(&desc, "specular_roughness"));
    assert_eq!((roughness.channel, roughness.scale), (Some(ImageChannel::Green), 1.0));
    // Numbers are as they are, colours are sRGB.
    let green = desc.images[roughness.image].image.rgb(0, 0)[1];
    assert!((green - 188.0 / 255.0).abs() < 1e-6, "{green}");
    let Parameter::Texture(base) = &surface(&desc).colors[0] else { panic!("no texture") };
    let TextureKind::Image(base) = &desc.spectrum_textures[*base].kind else { panic!("no image") };
    let green = desc.images[base.image].image.rgb(0, 0)[1];
    assert!((green - 0.5029).abs() < 1e-3, "{green}");
}

#[test]
fn a_factor_of_a_color_tints_its_texture() {
    let file = File::quad(json!({"pbrMetallicRoughness": {
        "baseColorTexture": {"index": 0}, "baseColorFactor": [0.5, 1, 0.25, 1],
    }}))
    .textured(&[[255, 255, 255, 255]]);
    let desc = file.scene();
    let Parameter::Texture(base) = &surface(&desc).colors[0] else { panic!("no texture") };
    let TextureKind::Image(base) = &desc.spectrum_textures[*base].kind else { panic!("no image") };
    assert_eq!(desc.images[base.image].image.rgb(0, 0), [0.5, 1.0, 0.25]);
}

#[test]
fn samplers_and_transforms_place_textures() {
    let mut file = File::quad(json!({"pbrMetallicRoughness": {
        "metallicRoughnessTexture": {"index": 0, "extensions": {"KHR_texture_transform": {
            "offset": [0.1, 0.2], "scale": [2, 4],
        }}},
    }}))
    .textured(&[[255; 4], [0; 4]]);
    let mapping =
        |file: &File| texture(&file.scene(), parameter(&file.scene(), "specular_roughness")).mapping;
    // (u, v) with v up is (u, 1 − v) in the file.
    let MappingDesc::Uv { scale, delta } = mapping(&file) else { panic!("turned") };
    assert_eq!(scale, [2.0, 4.0]);
    assert!((delta[0] - 0.1).abs() < 1e-6 && (delta[1] - (1.0 - 4.2)).abs() < 1e-6, "{delta:?}");
    let info = &mut file.json["materials"][0]["pbrMetallicRoughness"]["metallicRoughnessTexture"];
    info["extensions"]["KHR_texture_transform"] = json!({"rotation": std::f64::consts::FRAC_PI_2});
    // A quarter turn counter-clockwise where v is down: (u, v) becomes (v, −u).
    let MappingDesc::Affine { columns } = mapping(&file) else { panic!("not turned") };
    for (found, expected) in columns.as_flattened().iter().zip([0.0, 1.0, -1.0, 0.0, 1.0, 1.0]) {
        assert!((found - expected).abs() < 1e-6, "{columns:?}");
    }
    // What is mirrored becomes an image of twice the width, in which the right half is the mirror.
    let info = &mut file.json["materials"][0]["pbrMetallicRoughness"]["metallicRoughnessTexture"];
    info.as_object_mut().unwrap().remove("extensions");
    file.json["samplers"] = json!([{"wrapS": 33648, "magFilter": 9728}]);
    file.json["textures"][0]["sampler"] = json!(0);
    let desc = file.scene();
    let roughness = texture(&desc, parameter(&desc, "specular_roughness"));
    assert_eq!(roughness.mapping, MappingDesc::Uv { scale: [0.5, 1.0], delta: [0.0, 0.0] });
    assert_eq!(roughness.filter, TextureFilter::Point);
    let picture = &desc.images[roughness.image].image;
    assert_eq!((0..4).map(|x| picture.rgb(x, 0)[0]).collect::<Vec<_>>(), [1.0, 0.0, 0.0, 1.0]);
    for (wraps, wrap) in [
        ([33071, 33071], WrapMode::Clamp),
        ([33071, 10497], WrapMode::Axes([EdgeMode::Clamp, EdgeMode::Repeat])),
        ([33648, 33071], WrapMode::Axes([EdgeMode::Repeat, EdgeMode::Clamp])),
    ] {
        file.json["samplers"] = json!([{"wrapS": wraps[0], "wrapT": wraps[1]}]);
        let desc = file.scene();
        assert_eq!(texture(&desc, parameter(&desc, "specular_roughness")).wrap, wrap);
    }
}

/// Normal maps of the base and of the coat, each by its own sampler and transform.
#[test]
fn normal_maps_have_samplers_and_transforms() {
    let moved = json!({"KHR_texture_transform": {"scale": [4, 2]}});
    let mut material = extended(
        "KHR_materials_clearcoat",
        json!({
            "clearcoatFactor": 1,
            "clearcoatNormalTexture": {"index": 1, "extensions": moved},
        }),
    );
    material["normalTexture"] = json!({"index": 0});
    let mut file = File::quad(material).textured(&[[128, 128, 255, 255], [255, 128, 128, 255]]);
    file.json["textures"] = json!([{"source": 0, "sampler": 0}, {"source": 0}]);
    file.json["samplers"] = json!([{"magFilter": 9728, "wrapS": 33071, "wrapT": 33071}]);
    let desc = file.scene();
    let shape = desc.shapes.iter().next().expect("a shape").1;
    let base = desc.materials[shape.material.expect("a material")].normal_map.expect("a normal map");
    assert_eq!((base.wrap, base.is_nearest, base.columns), (WrapMode::Clamp, true, UvImageDesc::IDENTITY));
    let coat = surface(&desc).geometry_coat_normal.expect("a normal map");
    assert_eq!((coat.wrap, coat.is_nearest), (WrapMode::Repeat, false));
    assert_eq!(coat.columns, [[4.0, 0.0], [0.0, 2.0], [0.0, -1.0]]);
}

#[test]
fn textures_in_extensions_that_are_not_read_are_left_out_with_a_warning() {
    let mut file = File::quad(json!({
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "baseColorFactor": [0.5, 1, 1, 1]},
        "normalTexture": {"index": 0},
    }))
    .textured(&[[255; 4]]);
    for (texture, reason) in [
        (json!({"extensions": {"EXT_texture_avif": {"source": 0}}}), "`EXT_texture_avif`, which is not read"),
        (json!({}), "it has no image"),
    ] {
        file.json["textures"] = json!([texture]);
        assert_eq!(color(&file.scene(), "base_color"), [0.5, 1.0, 1.0]);
        let warnings = file.messages(Severity::Warning);
        let told = |warning: &&String| warning.starts_with("/textures/0: ") && warning.contains(reason);
        assert_eq!(warnings.iter().filter(told).count(), 1, "{warnings:?}");
    }
    // One that is also there in a format that is read is drawn.
    file.json["textures"] = json!([{"source": 0, "extensions": {"EXT_texture_avif": {"source": 0}}}]);
    assert!(matches!(surface(&file.scene()).colors[0], Parameter::Texture(_)));
    // Readers that need it refuse the file.
    file.json["extensionsRequired"] = json!(["EXT_texture_avif"]);
    assert!(file.messages(Severity::Error)[0].contains("requires the extension `EXT_texture_avif`"));
}

/// Factors that single precision has rounded up are those of the end of their range.
#[test]
fn factors_that_are_one_but_for_rounding_are_one() {
    let mut material = extended("KHR_materials_ior", json!({"ior": 0.999_999_94}));
    material["pbrMetallicRoughness"] = json!({
        "metallicFactor": 1.000_000_119_209_289_6, "roughnessFactor": 1.000_000_2,
        "baseColorFactor": [1.000_000_119_209_289_6, 0.5, -1e-9, 1.000_000_1],
    });
    let desc = File::quad(material).scene();
    for (name, value) in [("base_metalness", 1.0), ("specular_roughness", 1.0), ("specular_ior", 1.0)] {
        assert_eq!(number(&desc, name), value, "{name}");
    }
    assert_eq!(color(&desc, "base_color"), [1.0, 0.5, 0.0]);
}

#[test]
fn textures_of_several_sets_are_placed_by_each() {
    let mut file = File::quad(json!({
        "normalTexture": {"index": 0},
        "pbrMetallicRoughness": {"metallicRoughnessTexture": {
            "index": 0, "texCoord": 2, "extensions": {"KHR_texture_transform": {"offset": [0.5, 0]}},
        }},
    }))
    .textured(&[[255; 4], [0; 4]]);
    let warns = |file: &File, what: &str| file.messages(Severity::Warning).iter().any(|m| m.contains(what));
    assert!(warns(&file, "there is no `TEXCOORD_2`"));
    // Two triangles that share two corners, whose coordinates of the second set are not the same
    // function of those of the first.
    let other = [[0.0, 0.0], [0.5, 0.25], [0.75, 1.0], [2.0, 0.125]];
    let other_index = file.floats("VEC2", other.as_flattened());
    file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_2"] = json!(other_index);
    assert!(!warns(&file, "TEXCOORD") && !warns(&file, "sets of texture coordinates"));
    let desc = file.scene();
    let shapes: Vec<_> = desc.shapes.iter().map(|(_, shape)| &shape.value).collect();
    assert_eq!(shapes.len(), 3, "two parts, and the ground");
    for (shape, corners) in shapes.iter().zip([[0, 1, 2], [0, 2, 3]]) {
        assert_eq!(mesh(shape).indices[..], [corners]);
        let MaterialKind::OpenPbr(surface) = &desc.materials[shape.material.expect("one")].kind else {
            panic!("another material")
        };
        let index = OpenPbrDesc::number("specular_roughness");
        let MappingDesc::Affine { columns: [x, y, delta] } =
            texture(&desc, &surface.numbers[index.expect("a name")]).mapping
        else {
            panic!("no affine map")
        };
        for corner in corners {
            let uv = mesh(shape).uvs[corner as usize];
            let found = [0, 1].map(|i| uv.x * x[i] + uv.y * y[i] + delta[i]);
            let [u, v] = other[corner as usize];
            let expected = [u + 0.5, 1.0 - v];
            assert!((0..2).all(|i| (found[i] - expected[i]).abs() < 1e-5), "{found:?}, not {expected:?}");
        }
    }
}

#[test]
fn opacity_cuts_out_or_blends() {
    let alpha = |mode: &str| {
        let file = File::quad(json!({
            "alphaMode": mode,
            "alphaCutoff": 0.25,
            "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "baseColorFactor": [1, 1, 1, 0.5]},
        }));
        let desc = file.textured(&[[255, 255, 255, 128]]).scene();
        let shape = desc.shapes.iter().next().expect("a shape").1.value.clone();
        (desc, shape.alpha)
    };
    assert_eq!(alpha("OPAQUE").1, None);
    let (desc, blended) = alpha("BLEND");
    let opacity = texture(&desc, blended.as_ref().expect("an alpha"));
    assert_eq!((opacity.channel, opacity.scale), (Some(ImageChannel::Alpha), 0.5));
    let (desc, Some(Parameter::Texture(masked))) = alpha("MASK") else { panic!("no texture") };
    let TextureKind::Step { texture: opacity, edge } = &desc.float_textures[masked].kind else {
        panic!("no step")
    };
    assert_eq!((texture(&desc, opacity).scale, *edge), (0.5, 0.25));
}

#[test]
fn normal_maps_are_scaled_and_mirrored_with_their_coordinates() {
    let mut file =
        File::quad(json!({"normalTexture": {"index": 0, "scale": 0.5}})).textured(&[[255, 255, 128, 255]]);
    let normal = |file: &File, shape: usize| {
        let desc = file.scene();
        let shape = desc.shapes.iter().nth(shape).expect("a shape").1;
        let map = desc.materials[shape.material.expect("a material")].normal_map.expect("a normal map");
        desc.images[map.image].image.rgb(0, 0)
    };
    assert_eq!(normal(&file, 0)[..2], [0.75, 0.75]);
    // Half of the quadrilateral has its texture the other way round.
    file.json["materials"][0]["normalTexture"]["scale"] = json!(1);
    let uvs = file.floats("VEC2", &[1., 1., 0., 1., 0., 0., 1., 0.]);
    file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(uvs);
    assert_eq!(normal(&file, 0)[..2], [1.0, 0.0]);
}

#[test]
fn clear_coats() {
    let desc = File::quad(extended(
        "KHR_materials_clearcoat",
        json!({"clearcoatFactor": 0.75, "clearcoatRoughnessFactor": 0.25}),
    ))
    .scene();
    for (name, value) in
        [("coat_weight", 0.75), ("coat_roughness", 0.25), ("coat_ior", 1.5), ("coat_darkening", 0.0)]
    {
        assert_eq!(number(&desc, name), value, "{name}");
    }
}

/// A coat has the normals of its own map, and of the mesh without one.
#[test]
fn clear_coats_have_their_own_normals() {
    let file = |coat: serde_json::Value| {
        let mut material = extended("KHR_materials_clearcoat", coat);
        material["normalTexture"] = json!({"index": 0});
        File::quad(material).textured(&[[128, 255, 128, 255]])
    };
    let desc = file(json!({"clearcoatFactor": 1})).scene();
    assert_eq!(surface(&desc).geometry_coat_normal, None);
    let normals = json!({"clearcoatFactor": 1, "clearcoatNormalTexture": {"index": 0, "scale": 0.5}});
    let desc = file(normals).scene();
    let map = surface(&desc).geometry_coat_normal.expect("a normal map");
    assert_eq!(desc.images[map.image].image.rgb(0, 0)[1], 0.75);
}

#[test]
fn sheen_becomes_fuzz() {
    let desc = File::quad(extended(
        "KHR_materials_sheen",
        json!({"sheenColorFactor": [0.2, 0.4, 0.8], "sheenRoughnessFactor": 0.3}),
    ))
    .scene();
    assert_eq!((number(&desc, "fuzz_weight"), number(&desc, "fuzz_roughness")), (0.8, 0.3));
    assert_eq!(color(&desc, "fuzz_color"), [0.25, 0.5, 1.0]);
}

#[test]
fn iridescence_becomes_a_thin_film() {
    let iridescence =
        json!({"iridescenceFactor": 1, "iridescenceIor": 1.8, "iridescenceThicknessMaximum": 600});
    let mut file = File::quad(extended("KHR_materials_iridescence", iridescence)).textured(&[[0; 4]]);
    let desc = file.scene();
    for (name, value) in [("thin_film_weight", 1.0), ("thin_film_ior", 1.8), ("thin_film_thickness", 0.6)] {
        assert_eq!(number(&desc, name), value, "{name}");
    }
    file.json["materials"][0]["extensions"]["KHR_materials_iridescence"]["iridescenceThicknessTexture"] =
        json!({"index": 0});
    let desc = file.scene();
    let Parameter::Texture(handle) = parameter(&desc, "thin_film_thickness") else { panic!("no texture") };
    let TextureKind::Mix { textures, amount } = &desc.float_textures[*handle].kind else { panic!("no mix") };
    assert_eq!(textures.each_ref().map(|texture| *texture.value().expect("a constant")), [0.1, 0.6]);
    assert_eq!(texture(&desc, amount).channel, Some(ImageChannel::Green));
}

#[test]
fn indices_specular_and_dispersion() {
    let desc = File::quad(extended("KHR_materials_ior", json!({"ior": 1.33}))).scene();
    assert_eq!(number(&desc, "specular_ior"), 1.33);
    let desc = File::quad(extended(
        "KHR_materials_specular",
        json!({"specularFactor": 0.5, "specularColorFactor": [2, 1, 0.5]}),
    ))
    .scene();
    assert_eq!((number(&desc, "specular_weight"), color(&desc, "specular_color")), (1.0, [1.0, 0.5, 0.25]));
    for (dispersion, scale, abbe) in [(0.5, 0.5, 20.0), (4.0, 1.0, 5.0)] {
        let mut material = extended("KHR_materials_dispersion", json!({"dispersion": dispersion}));
        material["extensions"]["KHR_materials_transmission"] = json!({"transmissionFactor": 1});
        material["extensions"]["KHR_materials_volume"] = json!({"thicknessFactor": 1});
        let desc = File::quad(material).scene();
        assert_eq!(number(&desc, "transmission_dispersion_scale"), scale);
        assert_eq!(number(&desc, "transmission_dispersion_abbe_number"), abbe);
    }
}

#[test]
fn volumes_absorb_and_thin_glass_is_a_sheet() {
    let mut material = extended("KHR_materials_transmission", json!({"transmissionFactor": 1}));
    material["pbrMetallicRoughness"]["roughnessFactor"] = json!(0.5);
    let desc = File::quad(material.clone()).scene();
    for (name, value) in [("specular_ior", 1.5), ("specular_roughness", 0.5), ("transmission_weight", 1.0)] {
        assert_eq!(number(&desc, name), value, "{name}");
    }
    assert!(surface(&desc).thin_walled && desc.media.is_empty());
    material["extensions"]["KHR_materials_volume"] =
        json!({"thicknessFactor": 1, "attenuationDistance": 2, "attenuationColor": [1, 0.5, 0.25]});
    let desc = File::quad(material).scene();
    assert!(!surface(&desc).thin_walled);
    let (_, shape) = desc.shapes.iter().next().expect("a shape");
    let inside = shape.medium_interface.expect("media").inside.expect("a medium");
    let MediumKind::Homogeneous { coefficients, .. } = &desc.media[inside].kind else { panic!("a grid") };
    let CoefficientsDesc::Given { sigma_a: SpectrumDesc::Samples(samples), .. } = coefficients else {
        panic!("{coefficients:?}")
    };
    // Beer's law: after a distance of 2 the colour is left, of which red is most.
    let left = |lambda: f32| {
        let (_, sigma) = samples.iter().find(|sample| sample.0 == lambda).expect("a sample");
        (-2.0 * sigma).exp()
    };
    for (lambda, expected) in [(640.0, 1.0), (545.0, 0.5), (450.0, 0.25)] {
        assert!((left(lambda) - expected).abs() < 0.12, "{lambda}: {}", left(lambda));
    }
    assert!(matches!(desc.integrator.value, description::IntegratorDesc::VolPath(_)));
}

#[test]
fn anisotropy_keeps_both_widths_of_highlights() {
    let mut material = extended("KHR_materials_anisotropy", json!({"anisotropyStrength": 0.6}));
    material["pbrMetallicRoughness"]["roughnessFactor"] = json!(0.5);
    let desc = File::quad(material).scene();
    let (roughness, anisotropy) =
        (number(&desc, "specular_roughness"), number(&desc, "specular_roughness_anisotropy"));
    // α of OpenPBR along and across, and of the extension.
    let along = roughness * roughness * (2.0 / (1.0 + (1.0 - anisotropy) * (1.0 - anisotropy))).sqrt();
    assert!((along - (0.25 + 0.75 * 0.36)).abs() < 1e-5, "{along}");
    assert!((along * (1.0 - anisotropy) - 0.25).abs() < 1e-5, "{anisotropy}");
}

#[test]
fn specular_and_glossiness_are_converted() {
    let desc = File::quad(extended(
        "KHR_materials_pbrSpecularGlossiness",
        json!({"diffuseFactor": [0.1, 0.2, 0.3, 1], "specularFactor": [0.5, 0.25, 0.5], "glossinessFactor": 0.75}),
    ))
    .scene();
    assert_eq!(color(&desc, "base_color"), [0.1, 0.2, 0.3]);
    assert_eq!((number(&desc, "base_metalness"), number(&desc, "specular_roughness")), (0.0, 0.25));
    assert_eq!((number(&desc, "specular_weight"), color(&desc, "specular_color")), (12.5, [1.0, 0.5, 1.0]));
}

#[test]
fn diffuse_transmission_is_mixed_in() {
    let desc = File::quad(extended(
        "KHR_materials_diffuse_transmission",
        json!({"diffuseTransmissionFactor": 0.25, "diffuseTransmissionColorFactor": [1, 0.5, 0.5]}),
    ))
    .scene();
    let (_, shape) = desc.shapes.iter().next().expect("a shape");
    let MaterialKind::Mix { materials, amount } = &desc.materials[shape.material.expect("a material")].kind
    else {
        panic!("no mix")
    };
    assert_eq!(amount.value(), Some(&0.25));
    assert!(matches!(desc.materials[materials[1]].kind, MaterialKind::DiffuseTransmission { .. }));
}

#[test]
fn variants_are_chosen_by_name_or_number() {
    let mut file = File::quad(json!({}));
    file.json["materials"] = json!([{"name": "plain"}, {"name": "fancy"}]);
    file.json["extensions"] =
        json!({"KHR_materials_variants": {"variants": [{"name": "day"}, {"name": "night"}]}});
    file.json["meshes"][0]["primitives"][0]["extensions"] =
        json!({"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [1]}]}});
    for (path, name) in [("a.glb", "plain"), ("a.glb#variant=night", "fancy"), ("a.glb#variant=0", "plain")] {
        let desc = file.scene_of(path);
        let (_, shape) = desc.shapes.iter().next().expect("a shape");
        assert_eq!(desc.materials[shape.material.expect("a material")].name, name, "{path}");
    }
    assert!(file.read_as("a.glb#variant=dusk").has_errors());
}

#[test]
fn what_is_out_of_range_is_refused_at_its_place() {
    for (material, pointer) in [
        (
            json!({"pbrMetallicRoughness": {"metallicFactor": 2}}),
            "/materials/0/pbrMetallicRoughness/metallicFactor",
        ),
        (json!({"emissiveTexture": {"index": 3}}), "/materials/0/emissiveTexture/index"),
        (json!({"alphaMode": "GLASS"}), "/materials/0/alphaMode"),
        (
            extended("KHR_materials_volume", json!({"attenuationDistance": 0})),
            "/materials/0/extensions/KHR_materials_volume/attenuationDistance",
        ),
    ] {
        let errors = File::quad(material).messages(Severity::Error);
        assert_eq!(errors.len(), 1, "{errors:?}");
        assert!(errors[0].starts_with(pointer), "{errors:?}");
    }
}

#[test]
fn surfaces_are_single_sided_unless_their_material_says_otherwise() {
    for (material, wanted) in [
        (json!({}), true),
        (json!({"doubleSided": false, "alphaMode": "BLEND"}), true),
        (json!({"doubleSided": true}), false),
        (json!({"extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}}), true),
        (json!({"doubleSided": true, "extensions": {"KHR_materials_unlit": {}}}), false),
    ] {
        let desc = File::quad(material.clone()).scene();
        let (_, shape) = desc.shapes.iter().next().unwrap();
        assert_eq!(shape.single_sided, wanted, "{material}");
    }
    // A primitive without a material has the default one.
    let mut file = File::quad(json!({"doubleSided": true}));
    file.json["meshes"][0]["primitives"][0].as_object_mut().unwrap().remove("material");
    assert!(file.scene().shapes.iter().next().unwrap().1.single_sided);
}
