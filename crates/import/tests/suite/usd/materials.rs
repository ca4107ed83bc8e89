//! Materials, textures, bindings, and colours of surfaces without a material.

use super::{QUAD, error, mesh, messages, number, scene, shape, shapes, text, warnings, without_errors};
use alhazen_import::import;
use assets::MemoryAssets;
use description::Imported;
use description::{
    FloatParameter, ImageChannel, ImageTextureDesc, MappingDesc, MaterialKind, OpenPbrDesc, SceneDesc,
    Severity, ShapeDesc, SpectrumDesc, SpectrumParameter, TextureKind, WrapMode,
};

/// A quadrilateral with a material of a `UsdPreviewSurface` with inputs, and other nodes.
fn surfaced(inputs: &str, nodes: &str) -> String {
    format!(
        "def Mesh \"m\" (prepend apiSchemas = [\"MaterialBindingAPI\"]) {{
            {QUAD}
            rel material:binding = </mat>
        }}
        def Material \"mat\" {{
            token outputs:surface.connect = </mat/s.outputs:surface>
            def Shader \"s\" {{
                uniform token info:id = \"UsdPreviewSurface\"
                {inputs}
                token outputs:surface
            }}
            {nodes}
        }}"
    )
}

fn kind<'d>(desc: &'d SceneDesc, shape: &ShapeDesc) -> &'d MaterialKind {
    &desc.materials[shape.material.expect("a material")].kind
}

fn principled(desc: &SceneDesc) -> &OpenPbrDesc {
    match kind(desc, shape(desc)) {
        MaterialKind::OpenPbr(surface) => surface,
        kind => panic!("{kind:?}"),
    }
}

fn diffuse(desc: &SceneDesc, shape: &ShapeDesc) -> [f32; 3] {
    match kind(desc, shape) {
        MaterialKind::Diffuse { reflectance: SpectrumParameter::Value(SpectrumDesc::Rgb { rgb, .. }) } => {
            *rgb
        }
        kind => panic!("{kind:?}"),
    }
}

fn rgb(parameter: &SpectrumParameter) -> [f32; 3] {
    match parameter {
        SpectrumParameter::Value(SpectrumDesc::Rgb { rgb, .. }) => *rgb,
        parameter => panic!("{parameter:?}"),
    }
}

fn value(surface: &OpenPbrDesc, name: &str) -> f32 {
    match number(surface, name) {
        FloatParameter::Value(value) => value,
        parameter => panic!("{name}: {parameter:?}"),
    }
}

#[test]
fn inputs_are_those_of_a_principled_surface() {
    let desc = scene(&surfaced(
        "color3f inputs:diffuseColor = (0.1, 0.2, 0.3) float inputs:metallic = 0.25 float inputs:roughness = 0.75
         float inputs:ior = 1.4 float inputs:clearcoat = 0.5 float inputs:clearcoatRoughness = 0.125",
        "",
    ));
    let surface = principled(&desc);
    assert_eq!(rgb(&surface.colors[0]), [0.1, 0.2, 0.3]);
    for (name, expected) in [
        ("base_metalness", 0.25),
        ("specular_roughness", 0.75),
        ("specular_ior", 1.4),
        ("coat_weight", 0.5),
        ("coat_roughness", 0.125),
        ("coat_darkening", 0.0),
    ] {
        assert_eq!(value(surface, name), expected, "{name}");
    }
    let desc = scene(&surfaced("", ""));
    let surface = principled(&desc);
    assert_eq!(rgb(&surface.colors[0]), [0.18; 3]);
    assert_eq!((value(surface, "specular_roughness"), value(surface, "specular_ior")), (0.5, 1.5));
    assert!(shape(&desc).alpha.is_none() && shape(&desc).area_light.is_none());
}

#[test]
fn specular_colours_are_reflectances() {
    let inputs = "int inputs:useSpecularWorkflow = 1 color3f inputs:specularColor = (0.08, 0.04, 0)";
    let desc = scene(&surfaced(inputs, ""));
    let surface = principled(&desc);
    assert!((value(surface, "specular_weight") - 2.0).abs() < 1e-6);
    assert_eq!(rgb(&surface.colors[1]), [1.0, 0.5, 0.0]);
    assert_eq!(value(surface, "base_metalness"), 0.0);
}

#[test]
fn opacity_is_cut_or_blended() {
    let alpha = |inputs: &str| shape(&scene(&surfaced(inputs, ""))).alpha.clone();
    assert_eq!(alpha("float inputs:opacity = 0.25"), Some(FloatParameter::Value(0.25)));
    let cut = "float inputs:opacity = 0.25 float inputs:opacityThreshold = 0.5";
    assert_eq!(alpha(cut), Some(FloatParameter::Value(0.0)));
    assert_eq!(alpha(&cut.replace("0.5", "0.125")), Some(FloatParameter::Value(1.0)));
    assert_eq!(alpha("float inputs:opacity = 1"), None);
}

#[test]
fn emission_is_an_area_light() {
    let desc = scene(&surfaced("color3f inputs:emissiveColor = (4, 2, 0)", ""));
    let light = &desc.area_lights[shape(&desc).area_light.expect("a light")];
    let SpectrumDesc::Rgb { rgb, .. } = &light.radiance else { panic!("{light:?}") };
    assert_eq!((light.scale, *rgb, light.two_sided), (4.0, [1.0, 0.5, 0.0], false));
    assert_eq!(light.group.as_deref(), Some("mat"));
    let two_sided = surfaced("color3f inputs:emissiveColor = (4, 2, 0)", "");
    let two_sided = two_sided.replace("rel material", "uniform bool doubleSided = 1 rel material");
    let desc = scene(&two_sided);
    assert!(desc.area_lights[shape(&desc).area_light.expect("a light")].two_sided);
}

#[test]
fn materials_may_have_inputs_and_graphs() {
    let desc = scene(&surfaced(
        "float inputs:roughness.connect = </mat.inputs:rough> float inputs:metallic.connect = </mat/g.outputs:m>",
        "float inputs:rough = 0.875
         def NodeGraph \"g\" { float inputs:m = 0.375 float outputs:m.connect = </mat/g.inputs:m> }",
    ));
    assert_eq!(value(principled(&desc), "specular_roughness"), 0.875);
    assert_eq!(value(principled(&desc), "base_metalness"), 0.375);
    let circle = surfaced(
        "float inputs:roughness.connect = </mat.inputs:a>",
        "float inputs:a.connect = </mat.inputs:b> float inputs:b.connect = </mat.inputs:a>",
    );
    assert!(
        error(&circle).contains("/mat/s.inputs:roughness: its connections do not end"),
        "{}",
        error(&circle)
    );
}

/// A texture of an input, with properties of its own and of its transform.
fn textured(input: &str, output: &str, own: &str, moved: Option<&str>) -> Imported {
    let nodes = format!(
        "def Shader \"t\" {{
            uniform token info:id = \"UsdUVTexture\"
            asset inputs:file = @textures/a.png@
            float2 inputs:st.connect = <{}>
            {own}
        }}
        def Shader \"r\" {{
            uniform token info:id = \"UsdPrimvarReader_float2\"
            token inputs:varname = \"st\"
        }}
        def Shader \"x\" {{
            uniform token info:id = \"UsdTransform2d\"
            float2 inputs:in.connect = </mat/r.outputs:result>
            {}
        }}",
        if moved.is_some() { "/mat/x.outputs:result" } else { "/mat/r.outputs:result" },
        moved.unwrap_or_default(),
    );
    let prims = surfaced(&format!("{input}.connect = </mat/t.outputs:{output}>"), &nodes);
    let pixels = image::Pixels::U8(vec![0, 51, 102, 255, 255, 204, 153, 51], image::ColorEncoding::Srgb);
    let picture = image::Image::new(2, 1, ["R", "G", "B", "A"], pixels).unwrap();
    let png = image::encode(&picture, image::Format::Png, &image::WriteOptions::default()).unwrap();
    import("a.usda", &MemoryAssets::default().with("a.usda", text(&prims)).with("textures/a.png", png))
}

fn image_of<V>(kind: &TextureKind<V>) -> &ImageTextureDesc {
    match kind {
        TextureKind::Image(image) => image,
        _ => panic!("no image"),
    }
}

/// The texture of the base colour.
fn base(desc: &SceneDesc) -> &ImageTextureDesc {
    match &principled(desc).colors[0] {
        SpectrumParameter::Texture(texture) => image_of(&desc.spectrum_textures[*texture].kind),
        parameter => panic!("{parameter:?}"),
    }
}

#[test]
fn textures_have_their_wrap_and_transform() {
    let of = |own: &str, moved: Option<&str>| {
        let desc = without_errors(textured("color3f inputs:diffuseColor", "rgb", own, moved));
        let base = base(&desc);
        let image = &desc.images[base.image].image;
        (base.wrap, base.mapping, base.scale, [image.width(), image.height()])
    };
    let plain = MappingDesc::Uv { scale: [1.0; 2], delta: [0.0; 2] };
    assert_eq!(of("", None), (WrapMode::Black, plain, 1.0, [2, 1]));
    let repeat = "token inputs:wrapS = \"repeat\" token inputs:wrapT = \"repeat\"";
    assert_eq!(of(repeat, None).0, WrapMode::Repeat);
    assert_eq!(of(&repeat.replace("repeat", "clamp"), None).0, WrapMode::Clamp);
    let mirrored = of(&repeat.replace("repeat", "mirror"), None);
    assert_eq!((mirrored.1, mirrored.3), (MappingDesc::Uv { scale: [0.5; 2], delta: [0.0; 2] }, [4, 2]));
    let moved = "float2 inputs:scale = (2, 3) float2 inputs:translation = (0.25, 0.5)";
    assert_eq!(of("", Some(moved)).1, MappingDesc::Uv { scale: [2.0, 3.0], delta: [0.25, 0.5] });
    // Counter-clockwise: u becomes v.
    let MappingDesc::Affine { columns } = of("", Some("float inputs:rotation = 90")).1 else {
        panic!("not affine")
    };
    assert!((columns[0][1] - 1.0).abs() < 1e-6 && (columns[1][0] + 1.0).abs() < 1e-6, "{columns:?}");
    assert_eq!(of("float4 inputs:scale = (0.5, 0.5, 0.5, 1)", None).2, 0.5);
}

#[test]
fn images_are_decoded_and_edited() {
    let first = |own: &str| {
        let desc = without_errors(textured("color3f inputs:diffuseColor", "rgb", own, None));
        let base = base(&desc);
        desc.images[base.image].image.rgb(0, 0)
    };
    let near = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 2e-3);
    assert!(near(first("token inputs:sourceColorSpace = \"raw\""), [0.0, 0.2, 0.4]));
    assert!(near(first(""), [0.0, 0.0331, 0.1329]), "{:?}", first(""));
    let edited = "token inputs:sourceColorSpace = \"raw\" float4 inputs:scale = (1, 2, 1, 1)
        float4 inputs:bias = (0.5, 0, 0, 0)";
    assert!(near(first(edited), [0.5, 0.4, 0.4]));
}

#[test]
fn numbers_are_channels_of_images() {
    let raw = "token inputs:sourceColorSpace = \"raw\"";
    let of = |output: &str, own: &str| {
        let desc = without_errors(textured("float inputs:roughness", output, &format!("{raw} {own}"), None));
        let FloatParameter::Texture(texture) = number(principled(&desc), "specular_roughness") else {
            panic!("no texture")
        };
        let image = image_of(&desc.float_textures[texture].kind);
        (image.channel, image.scale, desc.images[image.image].image.rgb(1, 0))
    };
    assert_eq!(of("g", "").0, Some(ImageChannel::Green));
    assert_eq!(
        (of("a", "").0, of("b", "float4 inputs:scale = (1, 1, 0.5, 1)").1),
        (Some(ImageChannel::Alpha), 0.5)
    );
    // 1 − 0.6 of blue.
    let inverted = of("b", "float4 inputs:scale = (1, 1, -1, 1) float4 inputs:bias = (0, 0, 1, 0)");
    assert!((inverted.2[0] - 0.4).abs() < 1e-6, "{inverted:?}");
}

#[test]
fn opacity_may_be_that_of_the_image() {
    let desc = without_errors(textured("float inputs:opacity", "a", "", None));
    let Some(FloatParameter::Texture(texture)) = &shape(&desc).alpha else { panic!("no texture") };
    assert_eq!(image_of(&desc.float_textures[*texture].kind).channel, Some(ImageChannel::Alpha));
}

#[test]
fn normal_maps_are_codes() {
    let usual = "float4 inputs:scale = (2, 2, 2, 1) float4 inputs:bias = (-1, -1, -1, 0)
        token inputs:sourceColorSpace = \"raw\"";
    let desc = without_errors(textured("normal3f inputs:normal", "rgb", usual, None));
    let map = desc.materials[shape(&desc).material.unwrap()].normal_map.expect("a normal map");
    assert_eq!(desc.images[map.image].image.rgb(1, 0), [1.0, 0.8, 0.6]);
    let halved =
        usual.replace("(2, 2, 2, 1)", "(1, 1, 2, 1)").replace("(-1, -1, -1, 0)", "(-0.5, -0.5, -1, 0)");
    let desc = without_errors(textured("normal3f inputs:normal", "rgb", &halved, None));
    let map = desc.materials[shape(&desc).material.unwrap()].normal_map.expect("a normal map");
    let [x, ..] = desc.images[map.image].image.rgb(1, 0);
    assert!((x - 0.75).abs() < 1e-6, "(1 − 0.5 + 1)/2, not {x}");
}

#[test]
fn missing_images_are_reported_and_replaced() {
    let prims = surfaced(
        "color3f inputs:diffuseColor.connect = </mat/t.outputs:rgb>",
        "def Shader \"t\" { uniform token info:id = \"UsdUVTexture\" asset inputs:file = @none.png@
            float4 inputs:fallback = (1, 0, 0.5, 1) }",
    );
    assert_eq!(messages(&prims, Severity::Error), ["/mat/t: there is no image `none.png`"]);
    let desc = super::read(&prims).desc;
    assert_eq!(rgb(&principled(&desc).colors[0]), [1.0, 0.0, 0.5]);
}

#[test]
fn other_shaders_are_named() {
    let prims = surfaced("", "").replace("UsdPreviewSurface", "PxrSurface");
    assert_eq!(warnings(&prims), ["/mat: shaders of the kind `PxrSurface` are not drawn"]);
    let missing = format!("def Mesh \"m\" {{ {QUAD} rel material:binding = </none> }}");
    assert_eq!(error(&missing), "/none: there is no such material");
}

/// Two materials, and a mesh of two triangles in a group.
fn bound(group: &str, own: &str, more: &str) -> SceneDesc {
    let material = |name: &str, color: &str| {
        surfaced(&format!("color3f inputs:diffuseColor = {color}"), "")
            .split_once("def Material")
            .map(|(_, rest)| {
                format!("def Material{}", rest.replace("mat", name).replace("forname", "format"))
            })
            .unwrap()
    };
    scene(&format!(
        "def Xform \"g\" {{ {group}
            def Mesh \"m\" {{ {own}
                int[] faceVertexCounts = [3, 3] int[] faceVertexIndices = [0, 1, 2, 0, 2, 3]
                point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
                uniform token subdivisionScheme = \"none\"
                {more}
            }}
        }} {} {}",
        material("red", "(1, 0, 0)"),
        material("blue", "(0, 0, 1)"),
    ))
}

fn colors(desc: &SceneDesc) -> Vec<([f32; 3], usize)> {
    let color = |shape: &ShapeDesc| match kind(desc, shape) {
        MaterialKind::OpenPbr(surface) => rgb(&surface.colors[0]),
        _ => diffuse(desc, shape),
    };
    shapes(desc).into_iter().map(|shape| (color(shape), mesh(shape).indices.len())).collect()
}

#[test]
fn materials_are_inherited_by_strength() {
    let (red, blue) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    assert_eq!(colors(&bound("rel material:binding = </red>", "", "")), [(red, 2)]);
    let both = ("rel material:binding = </red>", "rel material:binding = </blue>");
    assert_eq!(colors(&bound(both.0, both.1, "")), [(blue, 2)]);
    let strong = "rel material:binding = </red> (bindMaterialAs = \"strongerThanDescendants\")";
    assert_eq!(colors(&bound(strong, both.1, "")), [(red, 2)]);
    assert_eq!(colors(&bound("", "", "")), [([0.18; 3], 2)]);
}

#[test]
fn subsets_have_their_materials() {
    let (red, blue) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    let subset = "def GeomSubset \"s\" { uniform token elementType = \"face\" uniform token familyName = \"materialBind\"
        int[] indices = [1] rel material:binding = </blue> }";
    assert_eq!(colors(&bound("", "rel material:binding = </red>", subset)), [(blue, 1), (red, 1)]);
    let imported = super::read(&format!("def Mesh \"m\" {{ {QUAD} {} }}", subset.replace("[1]", "[7]")));
    assert!(imported.has_errors());
}

#[test]
fn surfaces_without_a_material_have_their_colour() {
    let of = |color: &str| scene(&format!("def Mesh \"m\" {{ {QUAD} {color} }}"));
    let desc = of("color3f[] primvars:displayColor = [(0.5, 0.25, 0)]");
    assert_eq!(diffuse(&desc, shape(&desc)), [0.5, 0.25, 0.0]);
    let desc = of(
        "color3f[] primvars:displayColor = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)] (interpolation = \"vertex\")",
    );
    let MaterialKind::Diffuse { reflectance: SpectrumParameter::Texture(_) } = kind(&desc, shape(&desc))
    else {
        panic!("no texture")
    };
    assert_eq!(desc.images.len(), 2, "and that of the studio");
    let desc = of("float[] primvars:displayOpacity = [0.5]");
    assert_eq!(shape(&desc).alpha, Some(FloatParameter::Value(0.5)));
    let above = format!(
        "def Xform \"g\" {{ color3f[] primvars:displayColor = [(0, 1, 0)] def Mesh \"m\" {{ {QUAD} }} }}"
    );
    let desc = scene(&above);
    assert_eq!(diffuse(&desc, shape(&desc)), [0.0, 1.0, 0.0]);
}

#[test]
fn a_primvar_may_be_the_base_colour() {
    let prims = surfaced(
        "float inputs:roughness = 0.25 color3f inputs:diffuseColor.connect = </mat/c.outputs:result>",
        "def Shader \"c\" { uniform token info:id = \"UsdPrimvarReader_float3\" token inputs:varname = \"displayColor\" }",
    )
    .replace("rel material", "color3f[] primvars:displayColor = [(0.25, 0.5, 1)] rel material");
    let desc = scene(&prims);
    assert_eq!(rgb(&principled(&desc).colors[0]), [0.25, 0.5, 1.0]);
    assert_eq!(value(principled(&desc), "specular_roughness"), 0.25);
}
