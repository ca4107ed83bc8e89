//! Textures at many points, on a wall of tiles that the camera sees at a slant, so that footprints
//! of pixels have all sizes and shapes.

use std::path::Path;

use alhazen_gpu::Algorithm;
use assets::MemoryAssets;
use image::{ColorEncoding, Format, Image, WriteOptions};

use crate::pictures::Case;

/// Tiles in a row.
const ROW: usize = 6;

/// Mappings other than those of texture coordinates.
const MAPPINGS: [&str; 3] = [
    "\"string mapping\" \"spherical\"",
    "\"string mapping\" \"cylindrical\"",
    "\"string mapping\" \"planar\" \"vector3 v1\" [ 2 0.3 0 ] \"vector3 v2\" [ -0.2 1 1 ] \"float udelta\" 0.4",
];

/// An image without structure, of the given channels.
fn noise<const N: usize>(size: [u32; 2], names: [&str; N]) -> Image {
    let value = |x: u32, y: u32, c: usize| (x * 7919 + y * 104_729 + c as u32 * 31) % 257;
    Image::from_fn(size[0], size[1], names, |x, y| std::array::from_fn(|c| value(x, y, c) as f32 / 256.0))
}

/// An image as a file.
fn file(image: &Image, name: &str) -> Vec<u8> {
    image::encode(image, Format::from_name(name).expect("a format"), &WriteOptions::default())
        .expect("an image that can be written")
}

/// A picture of a wall of textures, the statements of which are given.
fn wall(textures: &[String]) -> Case {
    let mut text = String::from(
        "LookAt 3 -4 5  3 3.2 0  0 0 1\nCamera \"perspective\" \"float fov\" 55\n\
        Film \"rgb\"\nPixelFilter \"box\"\nWorldBegin\n\
        LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\nLightSource \"point\" \"point3 from\" [ 3 3 4 ] \"float scale\" 40\n",
    );
    for (i, texture) in textures.iter().enumerate() {
        let (x, y) = (i % ROW, i / ROW);
        text += &format!(
            "AttributeBegin\nTranslate {x} {y} 0\nScale 0.95 0.95 1\nTexture \"t{i}\" {texture}\n\
            Material \"diffuse\" \"texture reflectance\" \"t{i}\"\n\
            Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0.1  1 1 0.3 ]\nAttributeEnd\n"
        );
    }
    let rgb = noise([37, 20], ["R", "G", "B"]);
    let assets = MemoryAssets::default()
        .with("wall.pbrt", text)
        .with("codes.png", file(&rgb.to_u8(ColorEncoding::Srgb), "codes.png"))
        .with(
            "opacity.png",
            file(&noise([16, 8], ["R", "G", "B", "A"]).to_u8(ColorEncoding::Srgb), "opacity.png"),
        )
        .with("halves.exr", file(&rgb.to_f16(), "halves.exr"))
        .with("floats.pfm", file(&noise([16, 16], ["R", "G", "B"]), "floats.pfm"));
    Case::sized(Path::new("wall.pbrt"), &assets, [384, 256])
}

/// Compares a wall of textures by both engines.
fn compare(name: &str, textures: &[String]) {
    assert_eq!(wall(textures).compare(name, &Algorithm::RayCasting), None);
}

#[test]
fn images_have_the_picture_of_the_cpu() {
    let mut textures = Vec::new();
    for filter in ["point", "bilinear", "trilinear", "ewa"] {
        for (file, wrap) in [
            ("codes.png", "repeat"),
            ("halves.exr", "clamp"),
            ("floats.pfm", "black"),
            ("floats.pfm", "octahedralsphere"),
            ("opacity.png", "repeat"),
        ] {
            textures.push(format!(
                "\"spectrum\" \"imagemap\" \"string filename\" \"{file}\" \"string wrap\" \"{wrap}\" \
                \"string filter\" \"{filter}\" \"float uscale\" 3 \"float vscale\" -2.5 \"float udelta\" -0.7"
            ));
        }
    }
    textures.push("\"spectrum\" \"imagemap\" \"string filename\" \"codes.png\" \"bool invert\" true".into());
    textures.push("\"spectrum\" \"imagemap\" \"string filename\" \"codes.png\" \"float scale\" 0.01".into());
    compare("images", &textures);
}

#[test]
fn mappings_have_the_picture_of_the_cpu() {
    let kinds = [
        "\"imagemap\" \"string filename\" \"codes.png\"",
        "\"imagemap\" \"string filename\" \"halves.exr\" \"string filter\" \"ewa\"",
        "\"checkerboard\" \"rgb tex1\" [ 0.9 0.5 0.1 ] \"rgb tex2\" [ 0.1 0.2 0.3 ]",
        "\"bilerp\" \"rgb v00\" [ 0.9 0.5 0.1 ] \"rgb v11\" [ 0.1 0.2 0.3 ]",
    ];
    let all = kinds
        .iter()
        .flat_map(|kind| MAPPINGS.iter().map(move |mapping| format!("\"spectrum\" {kind} {mapping}")));
    compare("mappings", &all.collect::<Vec<_>>());
}

#[test]
fn noise_has_the_picture_of_the_cpu() {
    let mut textures: Vec<String> = Vec::new();
    let mut add = |kind: &str, name: &str| {
        let i = textures.len();
        textures.push(format!(
            "\"float\" \"{kind}\" {name}\nTexture \"s{i}\" \"float\" \"scale\" \"texture tex\" \"t{i}\" \"float scale\" 0.8\n\
            Texture \"t{i}\" \"spectrum\" \"mix\" \"rgb tex1\" [ 0.3 0.2 0.1 ] \"rgb tex2\" [ 0.5 0.7 0.9 ] \"texture amount\" \"s{i}\""
        ));
    };
    for octaves in [1, 3, 8] {
        add("fbm", &format!("\"integer octaves\" {octaves} \"float roughness\" 0.6"));
        add("wrinkled", &format!("\"integer octaves\" {octaves} \"float roughness\" 0.6"));
    }
    add("windy", "");
    for scale in [1, 9] {
        textures.push(format!("\"spectrum\" \"marble\" \"float scale\" {scale} \"float variation\" 0.4"));
    }
    let dots = "\"spectrum\" \"dots\" \"rgb inside\" [ 0.9 0.5 0.1 ] \"rgb outside\" [ 0.1 0.2 0.3 ]";
    textures.extend(MAPPINGS.iter().map(|mapping| format!("{dots} {mapping}")));
    compare("noise", &textures);
}
