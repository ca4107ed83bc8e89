//! Primitives packed by Draco and images packed by Basis Universal, as their own encoders write
//! them.

use super::File;
#[cfg(feature = "draco")]
use super::mesh;
use base64::Engine;
use description::{MaterialKind, Parameter, SceneDesc, Severity, TextureKind};
use serde_json::json;

fn decode(text: &str) -> Vec<u8> {
    base64::engine::general_purpose::STANDARD.decode(text).unwrap()
}

/// The quadrilateral of [`File::quad`], with texture coordinates as attribute 0, normals as 1 and
/// positions as 2: sequential, and as runs of connected triangles by valences.
const QUADS: [&str; 2] = [
    "RFJBQ08CAgEBAAAABAIAAgAAAR//AREB/wAAAwMJAgEAAQkDAAEACQMAAgIDAgABAQADAwEgASADAPCDpgwAAAAA/w8AAAADAQAKAwEwGwEQ\
     AwAcggD+A/8DAAD/AQAAAAEBAAMDASABIAMAIISYkAAAAAAA/z8AAAAAAAAAAAAAAACAPwwKAACAvwAAgL8AAAAAAAAAQA4=",
    "RFJBQ08CAgEBAAAABAICAgAAAR//ARH/ARH/ARED/wABAAAAAQAAAQAJAwACAgEDCQIBAAIBAQkDAAEDAQEBAAMDATABEAMAKIKYAAAAAAD/\
     PwAAAACAvwAAgL8AAAAAAAAAQA4FAQEAAwMBMAEQAwAkgiYAAgAAAAEBIAAAAAD/DwAAAAAAAAAAAAAAAIA/DAYDAQEDAQFAAQD/AwAA/wEA\
     AP8CREAK",
];

/// The quadrilateral with its data packed.
fn quad(packed: &[u8]) -> File {
    let mut file = File::quad(json!({}));
    for accessor in file.json["accessors"].as_array_mut().unwrap() {
        accessor.as_object_mut().unwrap().remove("bufferView");
    }
    let view = file.view(packed);
    file.json["meshes"][0]["primitives"][0]["extensions"] = json!({"KHR_draco_mesh_compression": {
        "bufferView": view, "attributes": {"POSITION": 2, "NORMAL": 1, "TEXCOORD_0": 0},
    }});
    file.json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    file
}

#[cfg(feature = "draco")]
#[test]
fn packed_primitives_are_those_without_packing() {
    for packed in QUADS {
        let desc = quad(&decode(packed)).scene();
        let mesh = mesh(desc.shapes.iter().next().expect("a shape").1);
        assert_eq!(mesh.indices[..], [[0, 1, 2], [1, 3, 2]]);
        let corners = [[-1.0, 1.0], [-1.0, -1.0], [1.0, 1.0], [1.0, -1.0]];
        for (vertex, [x, y]) in corners.into_iter().enumerate() {
            let (p, n, uv) = (mesh.positions[vertex], mesh.normals[vertex], mesh.uvs[vertex]);
            // 14 bits of positions, 12 of texture coordinates, with v up.
            assert!((p.x - x).abs() + (p.y - y).abs() + p.z.abs() < 1e-3, "{p}");
            let expected = [0.5 + 0.5 * x, 0.5 + 0.5 * y];
            assert!((uv.x - expected[0]).abs() + (uv.y - expected[1]).abs() < 1e-3, "{uv:?}");
            assert!((n.z - 1.0).abs() < 1e-3, "{n}");
        }
    }
}

/// Encoders merge vertices, or split them, and exporters keep the old numbers.
#[cfg(feature = "draco")]
#[test]
fn stale_counts_of_packed_primitives_are_those_of_the_stream() {
    for packed in QUADS.map(decode) {
        let expected = quad(&packed).scene();
        let expected = mesh(expected.shapes.iter().next().expect("a shape").1);
        for (vertices, indices) in [(6, 6), (3, 6), (4, 9), (700, 3), (1, 1)] {
            let mut file = quad(&packed);
            for accessor in file.json["accessors"].as_array_mut().unwrap() {
                let is_index = accessor["type"] == "SCALAR";
                accessor["count"] = json!(if is_index { indices } else { vertices });
            }
            let desc = file.scene();
            let found = mesh(desc.shapes.iter().next().expect("a shape").1);
            assert_eq!((&found.indices, &found.positions), (&expected.indices, &expected.positions));
            assert_eq!((&found.normals, &found.uvs), (&expected.normals, &expected.uvs));
            let warnings = file.messages(Severity::Warning);
            let message = format!(
                "the accessors say {vertices} vertices and {indices} indices; drawn are those that are packed, 4 and 6"
            );
            assert!(warnings.iter().any(|warning| warning.ends_with(&message)), "{warnings:?}");
        }
        // Without an accessor of indices, and as a strip, the triangles are those of the stream.
        let mut file = quad(&packed);
        file.json["meshes"][0]["primitives"][0].as_object_mut().unwrap().remove("indices");
        let desc = file.scene();
        assert_eq!(mesh(desc.shapes.iter().next().expect("a shape").1).indices, expected.indices);
        let mut file = quad(&packed);
        file.json["meshes"][0]["primitives"][0]["mode"] = json!(5);
        let desc = file.scene();
        assert_eq!(mesh(desc.shapes.iter().next().expect("a shape").1).indices, expected.indices);
    }
}

#[cfg(feature = "draco")]
#[test]
fn damaged_packed_primitives_are_refused() {
    for packed in QUADS.map(decode) {
        for length in 0..packed.len() - 1 {
            let errors = quad(&packed[..length.max(1)]).messages(Severity::Error);
            let place = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
            assert!(errors.len() == 1 && errors[0].starts_with(place), "{length}: {errors:?}");
        }
        for at in 0..packed.len() {
            let mut damaged = packed.clone();
            damaged[at] ^= 0x55;
            // Whether it is refused or not: some bytes are numbers.
            quad(&damaged).read();
        }
    }
    let mut file = quad(&decode(QUADS[0]));
    file.json["accessors"][1]["componentType"] = json!(5120);
    assert!(file.messages(Severity::Error)[0].contains("no attribute 1 of the accessor's type"));
}

/// 8 × 8 pixels of red, half-transparent green and, in the lower half, blue, as ETC1S and as
/// UASTC with and without Zstandard.
const PICTURES: [&str; 3] = [
    "q0tUWCAyMLsNChoKAAAAAAEAAAAIAAAACAAAAAAAAAAAAAAAAQAAAAEAAAABAAAAaAAAADwAAACkAAAAJAAAAMgAAAAAAAAAjQAAAAAAAABV\
     AQAAAAAAAAQAAAAAAAAAAAAAAAAAAAA8AAAAAAAAAAIAOACjAQIAAwMAAAgIAAAAAAAAAAA/AAAAAAAAAAAA/////0AAPw8AAAAAAAAAAP////\
     8fAAAAS1RYd3JpdGVyAEJhc2lzIFVuaXZlcnNhbCAyLjEwAAAFAAIALgAAAAkAAAAuAAAAAAAAAAAAAAAAAAAAAgAAAAIAAAACAAAAIMBE\
     AAAAAAAA4gQIMBEAAAAAAIAsOCAATAAAAAAAACAgAFMAAAAAACBQFn0YG6yqqqpSVVVVBUDARAAAAAAAAJIiRQEwASAAAAAAgMgRIGrAAAAA\
     IGgQjZ5AADABAAAAAACAAAKbCrAP",
    "q0tUWCAyMLsNChoKAAAAAAEAAAAIAAAACAAAAAAAAAAAAAAAAQAAAAEAAAAAAAAAaAAAACwAAACUAAAALAAAAAAAAAAAAAAAAAAAAAAAAADA\
     AAAAAAAAAEAAAAAAAAAAQAAAAAAAAAAsAAAAAAAAAAIAKACmAQIAAwMAABAAAAAAAAAAAAB/AwAAAAAAAAAA/////x8AAABLVFh3cml0ZXIA\
     QmFzaXMgVW5pdmVyc2FsIDIuMTAAAAQAAAB/fwAA9x8A4B96AAAAAAAAAAAAABfgHwAQAg8AAAAAAAAAAAAXAOD/HwLgAQAAAAAAAAAAFwDg\
     /x8C4AEAAAAAAAAAAA==",
    "q0tUWCAyMLsNChoKAAAAAAEAAAAIAAAACAAAAAAAAAAAAAAAAQAAAAEAAAACAAAAaAAAACwAAACUAAAAJAAAAAAAAAAAAAAAAAAAAAAAAAC4\
     AAAAAAAAACcAAAAAAAAAQAAAAAAAAAAsAAAAAAAAAAIAKACmAQIAAwMAABAAAAAAAAAAAAB/AwAAAAAAAAAA/////x8AAABLVFh3cml0ZXIA\
     QmFzaXMgVW5pdmVyc2FsIDIuMTAAACi1L/0gQPUAAKj3HwDgH3oAF+AfABACDwDg/x8C4AEDQAcAzIQaCA==",
];

fn textured(picture: &[u8]) -> File {
    let mut file = File::quad(json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}));
    let view = file.view(picture);
    file.json["images"] = json!([{"bufferView": view, "mimeType": "image/ktx2"}]);
    file.json["textures"] = json!([{"extensions": {"KHR_texture_basisu": {"source": 0}}}]);
    file.json["extensionsRequired"] = json!(["KHR_texture_basisu"]);
    file
}

fn base(desc: &SceneDesc) -> &image::Image {
    let shape = desc.shapes.iter().next().expect("a shape").1;
    let MaterialKind::OpenPbr(surface) = &desc.materials[shape.material.expect("one")].kind else {
        panic!("another material")
    };
    let Parameter::Texture(base) = &surface.colors[0] else { panic!("no texture") };
    let TextureKind::Image(base) = &desc.spectrum_textures[*base].kind else { panic!("no image") };
    &desc.images[base.image].image
}

#[cfg(feature = "basis")]
#[test]
fn packed_images_have_their_pixels() {
    for picture in PICTURES {
        let desc = textured(&decode(picture)).scene();
        let image = base(&desc);
        assert_eq!((image.width(), image.height()), (8, 8));
        assert!(image.alpha_index().is_some());
        for (at, expected) in
            [([1, 2], [1.0, 0.0, 0.0]), ([6, 1], [0.0, 1.0, 0.0]), ([3, 6], [0.0, 0.0, 1.0])]
        {
            let found = image.rgb(at[0], at[1]);
            let is_close =
                found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 0.03);
            assert!(is_close, "{found:?}, not {expected:?}");
        }
    }
}

#[test]
fn an_image_of_webp_goes_before_that_of_other_programs() {
    let mut file = File::quad(json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}))
        .textured(&[[255, 0, 0, 255]]);
    let green = image::Pixels::U8(vec![0, 255, 0], image::ColorEncoding::Srgb);
    let green = image::Image::new(1, 1, ["R", "G", "B"], green).unwrap();
    let webp = image::encode(&green, image::Format::Webp, &image::WriteOptions::default()).unwrap();
    let view = file.view(&webp);
    let images = file.json["images"].as_array_mut().unwrap();
    images.push(json!({"bufferView": view, "mimeType": "image/webp"}));
    assert_eq!(base(&file.scene()).rgb(0, 0), [1.0, 0.0, 0.0]);
    file.json["textures"] = json!([{"source": 0, "extensions": {"EXT_texture_webp": {"source": 1}}}]);
    assert_eq!(base(&file.scene()).rgb(0, 0), [0.0, 1.0, 0.0]);
}

#[cfg(feature = "basis")]
#[test]
fn damaged_packed_images_are_refused() {
    for picture in PICTURES.map(decode) {
        for length in (0..picture.len()).step_by(3) {
            let errors = textured(&picture[..length.max(1)]).messages(Severity::Error);
            assert!(errors.len() == 1 && errors[0].starts_with("/images/0: "), "{length}: {errors:?}");
        }
        for at in 0..picture.len() {
            let mut damaged = picture.clone();
            damaged[at] ^= 0xff;
            textured(&damaged).read();
        }
    }
    // A header of a huge image, and one of a huge level.
    for (at, bytes) in [(22, [0xff; 2]), (102, [0xff; 2])] {
        let mut huge = decode(PICTURES[2]);
        huge[at..at + 2].copy_from_slice(&bytes);
        assert!(textured(&huge).messages(Severity::Error)[0].contains("image too large"));
    }
}

/// Where the file requires the extension, and where it does not.
#[cfg(not(feature = "draco"))]
#[test]
fn packed_primitives_need_a_feature() {
    let reason = "the extension `KHR_draco_mesh_compression` is not read, as this program was built without the \
                  cargo feature `draco`";
    let mut file = quad(&decode(QUADS[0]));
    let required = reason
        .replace("` is", "`, which is")
        .replace("the ext", "/extensionsRequired/0: the file requires the ext");
    assert_eq!(file.messages(Severity::Error), [required]);
    file.json.as_object_mut().unwrap().remove("extensionsRequired");
    let place = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
    assert_eq!(file.messages(Severity::Error), [format!("{place}: {reason}")]);
}

/// A texture that has no other image is left out, unless the file requires it.
#[cfg(not(feature = "basis"))]
#[test]
fn packed_images_need_a_feature() {
    let reason = "is not read, as this program was built without the cargo feature `basis`";
    let mut file = textured(&decode(PICTURES[0]));
    let required = format!(
        "/extensionsRequired/0: the file requires the extension `KHR_texture_basisu`, which {reason}"
    );
    assert_eq!(file.messages(Severity::Error), [required]);
    file.json.as_object_mut().unwrap().remove("extensionsRequired");
    let warnings = file.messages(Severity::Warning);
    let left_out = format!(
        "/textures/0: this texture is left out, and its factor is drawn alone: its image is in \
         `KHR_texture_basisu`, which {reason}"
    );
    assert!(warnings.contains(&left_out), "{warnings:?}");
    file.json["textures"] = json!([{"source": 0}]);
    let errors = file.messages(Severity::Error);
    assert!(
        errors.len() == 1 && errors[0].starts_with("/images/0: ") && errors[0].ends_with(reason),
        "{errors:?}"
    );
}
