//! Meshes: accessors of all types, kinds of primitives, nodes and instances.

use super::{File, mesh};
use base64::Engine;
use description::{SceneDesc, Severity, ShapeDesc};
use math::{DVec3, Vec3};
use serde_json::json;

fn first(desc: &SceneDesc) -> &ShapeDesc {
    desc.shapes.iter().next().expect("a shape").1
}

#[test]
fn a_mesh_has_its_vertices_with_v_up() {
    let desc = File::quad(json!({})).scene();
    let mesh = mesh(first(&desc));
    assert_eq!(mesh.indices.as_ref(), [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.positions[1], Vec3::new(1.0, -1.0, 0.0));
    assert_eq!(mesh.normals[3], Vec3::new(0.0, 0.0, 1.0));
    assert_eq!(
        mesh.uvs.iter().map(|uv| [uv.x, uv.y]).collect::<Vec<_>>(),
        [[0., 0.], [1., 0.], [1., 1.], [0., 1.]]
    );
}

#[test]
fn quantized_interleaved_and_sparse_vertices_are_read() {
    let mut file = File::quad(json!({}));
    // Positions as normalized shorts, normals as normalized bytes, 12 bytes for each vertex.
    let mut bytes = Vec::new();
    for [x, y] in [[-32767_i16, -32767], [32767, -32767], [32767, 32767], [-32768, 16384]] {
        bytes.extend([x, y, 0, 0].iter().flat_map(|v| v.to_le_bytes()));
        bytes.extend([0, 0, 127, 0]);
    }
    let view = file.view(&bytes);
    file.json["bufferViews"][view]["byteStride"] = json!(12);
    let accessors = file.json["accessors"].as_array_mut().unwrap();
    accessors[0] =
        json!({"bufferView": view, "componentType": 5122, "normalized": true, "count": 4, "type": "VEC3"});
    accessors[1] = json!({"bufferView": view, "byteOffset": 8, "componentType": 5120, "normalized": true, "count": 4, "type": "VEC3"});
    let (at, values) = (file.view(&[2, 0]), file.view(&[0.5_f32, 0.25].map(f32::to_le_bytes).concat()));
    // Coordinates that are all zero but for one vertex.
    file.json["accessors"][2] = json!({"componentType": 5126, "count": 4, "type": "VEC2", "sparse": {
        "count": 1,
        "indices": {"bufferView": at, "componentType": 5123},
        "values": {"bufferView": values},
    }});
    file.json["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
    file.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let desc = file.scene();
    let mesh = mesh(first(&desc));
    assert_eq!(mesh.positions[0], Vec3::new(-1.0, -1.0, 0.0));
    assert_eq!(mesh.positions[3].x, -1.0, "−32768 is −1, too");
    assert!((mesh.positions[3].y - 16384.0 / 32767.0).abs() < 1e-7);
    assert_eq!(mesh.normals[2], Vec3::new(0.0, 0.0, 1.0));
    assert_eq!(
        mesh.uvs.iter().map(|uv| [uv.x, uv.y]).collect::<Vec<_>>(),
        [[0., 1.], [0., 1.], [0.5, 0.75], [0., 1.]]
    );
}

#[test]
fn strips_and_fans_are_triangles_and_lines_are_not_drawn() {
    let mut file = File::quad(json!({}));
    let strip = file.indices(&[0, 1, 3, 2, 2]);
    let fan = file.indices(&[0, 1, 2, 3]);
    let primitive = file.json["meshes"][0]["primitives"][0].clone();
    for (indices, mode) in [(strip, 5), (fan, 6), (fan, 1), (fan, 0)] {
        let mut other = primitive.clone();
        (other["indices"], other["mode"]) = (json!(indices), json!(mode));
        file.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(other);
    }
    let desc = file.scene();
    // The last is the ground of the studio.
    let triangles = |shape: usize| mesh(desc.shapes.iter().nth(shape).expect("a shape").1).indices.to_vec();
    assert_eq!(desc.shapes.len(), 4);
    assert_eq!(triangles(1), [[0, 1, 3], [1, 2, 3]]);
    assert_eq!(triangles(2), [[1, 2, 0], [2, 3, 0]]);
    let warnings = file.messages(Severity::Warning);
    assert!(warnings.contains(&"/meshes/0/primitives/3: lines are not drawn".to_owned()), "{warnings:?}");
    assert!(warnings.contains(&"/meshes/0/primitives/4: points are not drawn".to_owned()), "{warnings:?}");
}

#[test]
fn nodes_place_meshes_and_repeated_ones_are_instances() {
    let mut file = File::quad(json!({}));
    file.json["nodes"] = json!([
        {"children": [1], "translation": [1, 0, 0], "rotation": [0, 0, 1, 1]},
        {"mesh": 0, "scale": [-2, 1, 1]},
    ]);
    let desc = file.scene();
    let place = first(&desc).world_from_object.start;
    let moved = place.transform_point3(DVec3::X);
    assert!((moved - DVec3::new(1.0, -2.0, 0.0)).length() < 1e-6, "{moved}");
    assert!(place.determinant() < 0.0);
    file.json["nodes"] = json!([
        {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1]},
        {"mesh": 0},
        {"mesh": 0, "scale": [0, 0, 0]},
        {"mesh": 0, "extensions": {"KHR_node_visibility": {"visible": false}}},
    ]);
    file.json["scenes"] = json!([{"nodes": [0, 1, 2, 3]}]);
    let desc = file.scene();
    assert_eq!((desc.objects.len(), desc.instances.len()), (1, 2));
    let (_, instance) = desc.instances.iter().next().expect("an instance");
    assert_eq!(instance.world_from_object.start.w_axis.truncate(), DVec3::new(5.0, 6.0, 7.0));
}

#[test]
fn instances_on_the_gpu_are_instances() {
    let mut file = File::quad(json!({}));
    let places = file.floats("VEC3", &[1., 0., 0., 2., 0., 0., 3., 0., 0.]);
    file.json["nodes"][0] = json!({"mesh": 0, "translation": [0, 10, 0], "extensions": {
        "EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": places}},
    }});
    let desc = file.scene();
    let places: Vec<_> = desc
        .instances
        .iter()
        .map(|(_, instance)| instance.world_from_object.start.w_axis.truncate())
        .collect();
    assert_eq!(places, [1.0, 2.0, 3.0].map(|x| DVec3::new(x, 10.0, 0.0)));
}

#[test]
fn packed_views_are_unpacked() {
    // A vertex stream and an index stream by the encoder of meshoptimizer.
    let decode = |text: &str| base64::engine::general_purpose::STANDARD.decode(text).unwrap();
    let packed = [decode(VERTICES), decode(TRIANGLES)];
    for extension in ["EXT_meshopt_compression", "KHR_meshopt_compression"] {
        views_are_unpacked(extension, &packed);
    }
}

fn views_are_unpacked(name: &str, packed: &[Vec<u8>; 2]) {
    let mut file = File::quad(json!({}));
    for (accessor, (bytes, count, stride, mode)) in
        [(0, (&packed[0], 4, 12, "ATTRIBUTES")), (3, (&packed[1], 6, 2, "TRIANGLES"))]
    {
        let view = file.view(bytes);
        let place = &mut file.json["bufferViews"][view];
        let extension = json!({
            "buffer": 0, "byteOffset": place["byteOffset"], "byteLength": place["byteLength"],
            "byteStride": stride, "count": count, "mode": mode,
        });
        *place = json!({
            "buffer": 0, "byteLength": count * stride, "extensions": {name: extension},
        });
        file.json["accessors"][accessor]["bufferView"] = json!(view);
    }
    let desc = file.scene();
    let mesh = mesh(first(&desc));
    assert_eq!(mesh.positions[2], Vec3::new(1.0, 1.0, 0.0));
    assert_eq!(mesh.positions[3], Vec3::new(-1.0, 1.0, 0.0));
    assert_eq!(mesh.indices.as_ref(), [[0, 1, 2], [0, 2, 3]]);
}

const VERTICES: &str = "oAAAAAEzAAAA//8AAAABDAAAAP8AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAIC/AACAvwAAAAA=";
const TRIANGLES: &str = "4fAAAHaHVmd4qYZliWiYAWkAAA==";

#[test]
fn colors_of_vertices_are_drawn() {
    let mut file = File::quad(json!({"pbrMetallicRoughness": {"baseColorFactor": [0.5, 1, 1, 1]}}));
    let colors = file.floats("VEC4", &[1., 0.5, 0.25, 1.].repeat(4));
    file.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(colors);
    // The same everywhere: a factor.
    let desc = file.scene();
    assert!(desc.spectrum_textures.is_empty());
    let material = |desc: &SceneDesc| desc.materials[first(desc).material.expect("a material")].kind.clone();
    let description::MaterialKind::OpenPbr(surface) = material(&desc) else { panic!("no surface") };
    assert_eq!(surface.colors[0], description::SpectrumDesc::rgb(0.5, 0.5, 0.25).into());
    // Varying: an image with four texels for each of the two triangles.
    let colors = file.floats("VEC3", &[1., 0., 0., 0., 1., 0., 0., 0., 1., 1., 1., 1.]);
    file.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(colors);
    let desc = file.scene();
    assert_eq!(mesh(first(&desc)).positions.len(), 6);
    let (_, image) = desc.images.iter().next().expect("an image");
    assert_eq!((image.image.width(), image.image.height()), (4, 2));
    assert_eq!([image.image.rgb(0, 0), image.image.rgb(1, 0)], [[0.5, 0., 0.], [0., 1., 0.]]);
    assert!(file.messages(Severity::Warning).iter().all(|message| !message.contains("colours")));
}

/// The fourth component of colours is opacity, where the material has any.
#[test]
fn opacities_of_vertices_multiply_that_of_the_material() {
    let file = |mode: &str, alphas: [f32; 4]| {
        let material = json!({"baseColorFactor": [1, 1, 1, 0.5]});
        let mut file =
            File::quad(json!({"alphaMode": mode, "alphaCutoff": 0.25, "pbrMetallicRoughness": material}));
        let colors: Vec<f32> = alphas.iter().flat_map(|&alpha| [1., 1., 1., alpha]).collect();
        let colors = file.floats("VEC4", &colors);
        file.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(colors);
        file
    };
    let alpha = |mode, alphas| first(&file(mode, alphas).scene()).alpha.clone();
    assert_eq!(alpha("OPAQUE", [0.0; 4]), None);
    assert_eq!(alpha("BLEND", [0.5; 4]), Some(0.25.into()));
    assert_eq!(alpha("BLEND", [0.0; 4]), Some(0.0.into()));
    assert_eq!(alpha("MASK", [0.4; 4]), Some(0.0.into()));
    assert_eq!(alpha("MASK", [0.6; 4]), Some(1.0.into()));
    // Varying: an image of its own, of the same texels as that of colours.
    let desc = file("BLEND", [1., 0.5, 0., 1.]).scene();
    let Some(description::Parameter::Texture(alpha)) = first(&desc).alpha else { panic!("no texture") };
    let description::TextureKind::Image(map) = &desc.float_textures[alpha].kind else { panic!("no image") };
    let image = &desc.images[map.image].image;
    assert_eq!([0, 1].map(|x| image.rgb(x, 0)[0]), [0.5, 0.25]);
    assert_eq!(image.rgb(0, 1)[0], 0.0);
    let desc = file("MASK", [1., 0.5, 0., 1.]).scene();
    let Some(description::Parameter::Texture(alpha)) = first(&desc).alpha else { panic!("no texture") };
    let kind = &desc.float_textures[alpha].kind;
    assert!(matches!(kind, description::TextureKind::Step { edge: 0.25, .. }), "{kind:?}");
    // Beside an image one opacity is a factor, and varying ones are told.
    let textured = |alphas| {
        let mut file = file("BLEND", alphas).textured(&[[255, 255, 255, 128]]);
        file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": 0});
        file
    };
    let desc = textured([0.5; 4]).scene();
    let Some(description::Parameter::Texture(alpha)) = first(&desc).alpha else { panic!("no texture") };
    let description::TextureKind::Image(map) = &desc.float_textures[alpha].kind else { panic!("no image") };
    assert_eq!(map.scale, 0.25);
    let warnings = textured([1., 0.5, 0., 1.]).messages(Severity::Warning);
    assert!(
        warnings.iter().any(|warning| warning.contains("colours of vertices are not drawn")),
        "{warnings:?}"
    );
}

#[test]
fn what_is_cut_out_everywhere_does_not_shine() {
    for (mode, alpha, lights) in [("BLEND", 0.0, 0), ("MASK", 0.2, 0), ("BLEND", 0.2, 1), ("OPAQUE", 0.0, 1)]
    {
        let mut file = File::quad(json!({"alphaMode": mode, "extensions": {"KHR_materials_unlit": {}}}));
        let colors = file.floats("VEC4", &[1., 1., 1., alpha].repeat(4));
        file.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(colors);
        assert_eq!(file.scene().area_lights.len(), lights, "{mode} {alpha}");
    }
}

/// Bytes and shorts are normalised, also where an accessor forgets to say so.
#[test]
fn colors_of_vertices_may_be_integers() {
    for (component, bytes) in [(5121, vec![255, 51, 0, 102]), (5123, vec![255, 255, 51, 51, 0, 0, 102, 102])]
    {
        for normalized in [true, false] {
            let mut file = File::quad(json!({"alphaMode": "BLEND"}));
            let view = file.view(&bytes.repeat(4));
            let accessors = file.json["accessors"].as_array_mut().unwrap();
            accessors.push(json!({
                "bufferView": view, "componentType": component, "count": 4, "type": "VEC4",
                "normalized": normalized,
            }));
            let index = accessors.len() - 1;
            file.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(index);
            let desc = file.scene();
            let shape = first(&desc);
            let Some(alpha) = shape.alpha.as_ref().and_then(|alpha| alpha.value()) else {
                panic!("no alpha")
            };
            assert!((alpha - 0.4).abs() < 1e-6, "{alpha}");
            let kind = &desc.materials[shape.material.expect("a material")].kind;
            let description::MaterialKind::OpenPbr(surface) = kind else { panic!("no surface") };
            assert_eq!(surface.colors[0], description::SpectrumDesc::rgb(1.0, 0.2, 0.0).into());
            let warnings = file.messages(Severity::Warning);
            let told = warnings.iter().any(|warning| warning.contains("integers of colours are normalised"));
            assert_eq!(told, !normalized, "{warnings:?}");
        }
    }
}

#[test]
fn faults_name_their_place() {
    type Change = fn(&mut serde_json::Value);
    let cases: [(Change, &str); 12] = [
        (|json| json["nodes"][0]["mesh"] = json!(7), "/nodes/0/mesh: there is no element 7 in `meshes`"),
        (|json| json["nodes"][0]["children"] = json!([0]), "/nodes/0: this node is its own descendant"),
        (
            |json| json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(9),
            "/meshes/0/primitives/0/attributes/POSITION: there is no element 9",
        ),
        (
            |json| json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(2),
            "/meshes/0/primitives/0/attributes/NORMAL: vectors of 3 numbers are needed here, not 2",
        ),
        (
            |json| json["accessors"][3]["count"] = json!(700),
            "/meshes/0/primitives/0/indices: 700 elements reach beyond the buffer view",
        ),
        (
            |json| json["accessors"][0]["count"] = json!(3),
            "/meshes/0/primitives/0/attributes/NORMAL: there are 4 for 3 vertices",
        ),
        (|json| json["accessors"][0]["type"] = json!("VEC5"), "/accessors/0/type: `VEC5` is not a type"),
        (|json| json["asset"]["version"] = json!("1.0"), "/asset/version: this is glTF of version `1.0`"),
        (
            |json| json["extensionsRequired"] = json!(["EXT_lights_image_based"]),
            "/extensionsRequired/0: the file requires the extension `EXT_lights_image_based`, which is not read",
        ),
        (
            |json| json["bufferViews"][0]["byteLength"] = json!(100_000),
            "/bufferViews/0: bytes 0 to 100000 reach beyond the buffer",
        ),
        (|json| json["scenes"][0]["nodes"] = json!([3]), "/scenes/0/nodes/0: there is no element 3"),
        (|json| json["nodes"] = json!("none"), "/nodes: this must be an array"),
    ];
    for (change, message) in cases {
        let mut file = File::quad(json!({}));
        change(&mut file.json);
        let errors = file.messages(Severity::Error);
        assert!(errors.iter().any(|error| error.starts_with(message)), "{message}: {errors:?}");
    }
}

#[test]
fn a_small_file_cannot_take_much_memory() {
    let mut file = File::quad(json!({}));
    file.json["accessors"][0] = json!({"componentType": 5126, "count": 3_000_000_000_u64, "type": "VEC3"});
    let errors = file.messages(Severity::Error);
    assert!(errors[0].contains("more data than its length suggests"), "{errors:?}");
}
