//! Mesh files in all their forms give the same mesh.

use std::io::Write;

use alhazen_import::import;
use assets::{MemoryAssets, Mesh, MeshError, read_obj, read_ply};
use description::ShapeKind;
use flate2::{Compression, write::GzEncoder};
use math::{Vec2, Vec3};

const HEADER: &str = "comment made by hand\nelement vertex 5\nproperty uchar red\nproperty float x\nproperty double y\nproperty short z\n\
    property list uchar float weights\nproperty float texture_u\nproperty float texture_v\nelement face 2\n\
    property int material\nproperty list uint ushort vertex_index\nelement edge 1\nproperty int a\nend_header\n";

/// x, y, z, weights, and u and v.
type Vertex = (f32, f64, i16, &'static [f32], [f32; 2]);

const VERTICES: [Vertex; 5] = [
    (0.0, 0.0, 0, &[], [0.0, 0.0]),
    (1.0, 0.0, 0, &[0.5], [1.0, 0.0]),
    (1.0, 1.0, 0, &[0.25, 0.75], [1.0, 1.0]),
    (0.0, 1.0, 0, &[], [0.0, 1.0]),
    (0.5, 2.0, -1, &[1.0], [0.5, 0.5]),
];

const FACES: [&[u16]; 2] = [&[0, 1, 2, 3], &[3, 2, 4]];

fn ascii() -> Vec<u8> {
    let mut text = format!("ply\r\nformat ascii 1.0\r\n{}", HEADER.replace('\n', "\r\n"));
    let list = |values: Vec<String>| format!("{} {}", values.len(), values.join(" "));
    for (x, y, z, weights, [u, v]) in VERTICES {
        let weights = list(weights.iter().map(f32::to_string).collect());
        text += &format!("255 {x} {y} {z} {weights} {u} {v}\r\n");
    }
    for face in FACES {
        text += &format!("7 {}\r\n", list(face.iter().map(u16::to_string).collect()));
    }
    (text + "3\r\n").into_bytes()
}

fn binary(big: bool) -> Vec<u8> {
    let order = if big { "big" } else { "little" };
    let mut bytes = format!("ply\nformat binary_{order}_endian 1.0\n{HEADER}").into_bytes();
    macro_rules! put {
        ($value:expr) => {
            if big { bytes.extend($value.to_be_bytes()) } else { bytes.extend($value.to_le_bytes()) }
        };
    }
    for (x, y, z, weights, [u, v]) in VERTICES {
        put!(255_u8);
        put!(x);
        put!(y);
        put!(z);
        put!((weights.len() as u8));
        weights.iter().for_each(|weight| put!(weight));
        put!(u);
        put!(v);
    }
    for face in FACES {
        put!(7_i32);
        put!((face.len() as u32));
        face.iter().for_each(|corner| put!(corner));
    }
    put!(3_i32);
    bytes
}

fn expected() -> Mesh {
    Mesh {
        positions: VERTICES.iter().map(|&(x, y, z, ..)| Vec3::new(x, y as f32, z.into())).collect(),
        uvs: VERTICES.iter().map(|&(.., uv)| Vec2::from_array(uv)).collect(),
        quads: vec![[0, 1, 2, 3]],
        triangles: vec![[3, 2, 4]],
        warnings: [
            "the property `red` of `vertex` is not read",
            "the property `material` of `face` is not read",
            "elements `edge` are not read",
        ]
        .map(|text| format!("header: {text}"))
        .into(),
        ..Mesh::default()
    }
}

#[test]
fn all_encodings_of_ply_give_the_same_mesh() {
    for bytes in [ascii(), binary(false), binary(true)] {
        assert_eq!(read_ply(&bytes), Ok(expected()));
    }
}

/// A file as most programs write it: floats side by side and no face numbers, which are read in
/// bulk.
fn plain(big: bool, faces: &[&[i32]], x: f32) -> Vec<u8> {
    let order = if big { "big" } else { "little" };
    let names = ["x", "y", "z", "nx", "ny", "nz", "s", "t"].map(|name| format!("property float {name}\n"));
    let mut bytes = format!(
        "ply\nformat binary_{order}_endian 1.0\nelement vertex 4\nproperty uchar red\n{}element face {}\n\
         property list uchar int vertex_indices\nend_header\n",
        names.concat(),
        faces.len()
    )
    .into_bytes();
    let put = |bytes: &mut Vec<u8>, value: u32| {
        bytes.extend(if big { value.to_be_bytes() } else { value.to_le_bytes() });
    };
    for [u, v] in [[0.0_f32, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
        bytes.push(9);
        [x + u, v, 2.0, 0.25, -0.5, 1.0, u, v].iter().for_each(|value| put(&mut bytes, value.to_bits()));
    }
    for face in faces {
        bytes.push(face.len() as u8);
        face.iter().for_each(|corner| put(&mut bytes, *corner as u32));
    }
    bytes
}

#[test]
fn plain_binary_files_are_read_and_checked() {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from_array);
    for big in [false, true] {
        let mesh = read_ply(&plain(big, &[&[0, 1, 2], &[0, 1, 2, 3], &[1], &[3, 2, 1]], 0.0)).unwrap();
        assert_eq!(mesh.positions, corners.map(|c| c.extend(2.0)));
        assert_eq!(mesh.normals, [Vec3::new(0.25, -0.5, 1.0); 4]);
        assert_eq!(mesh.uvs, corners);
        assert_eq!((mesh.triangles, mesh.quads), (vec![[0, 1, 2], [3, 2, 1]], vec![[0, 1, 2, 3]]));
        for corner in [-1, 4] {
            let message = format!("a face has vertex index {corner}, but there are 4 vertices");
            let mesh = read_ply(&plain(big, &[&[0, 1, 2], &[0, corner, 2]], 0.0));
            assert_eq!(mesh, Err(MeshError::Invalid(message)));
        }
        let message = "a vertex position is not finite".to_owned();
        assert_eq!(read_ply(&plain(big, &[&[0, 1, 2]], f32::NAN)), Err(MeshError::Invalid(message)));
    }
}

#[test]
fn every_shortened_ply_is_refused() {
    for bytes in [binary(false), binary(true), plain(false, &[&[0, 1, 2], &[0, 2, 3]], 0.0)] {
        for length in 0..bytes.len() {
            assert!(read_ply(&bytes[..length]).is_err(), "{length} of {} bytes", bytes.len());
        }
    }
}

#[test]
fn counts_are_checked_before_memory_is_taken() {
    let text =
        "ply\nformat ascii 1.0\nelement vertex 18446744073709551615\nproperty float x\nend_header\n1\n";
    assert!(matches!(read_ply(text.as_bytes()), Err(MeshError::Limits(_))));
    let mut bytes = binary(false);
    let count = bytes.len() - 4 - 3 * 2 - 4;
    bytes[count..count + 4].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(matches!(read_ply(&bytes), Err(MeshError::Limits(_))));
}

#[test]
fn triangles_of_strips_have_one_winding() {
    let text = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement tristrips 1\n\
        property list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n8 0 1 2 3 -1 2 3 4\n";
    let mesh = read_ply(text.as_bytes()).unwrap();
    assert_eq!(mesh.triangles, [[0, 1, 2], [2, 1, 3], [2, 3, 4]]);
}

#[test]
fn faces_may_stand_before_the_vertices() {
    let vertices = [
        "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n",
        "0 0 0\n1 0 0\n1 1 0\n0 1 0\n",
    ];
    let faces = ["element face 2\nproperty list uchar int vertex_indices\n", "4 0 1 2 3\n3 0 1 CORNER\n"];
    let read = |[a, b]: [[&str; 2]; 2], corner: &str| {
        let text = format!("ply\nformat ascii 1.0\n{}{}end_header\n{}{}", a[0], b[0], a[1], b[1]);
        read_ply(text.replace("CORNER", corner).as_bytes())
    };
    let mesh = read([faces, vertices], "2").unwrap();
    assert_eq!((mesh.triangles.as_slice(), mesh.quads.as_slice()), (&[[0, 1, 2]][..], &[[0, 1, 2, 3]][..]));
    assert_eq!(Ok(mesh), read([vertices, faces], "2"));
    for corner in ["4", "-1", "0.5"] {
        let message =
            MeshError::Invalid(format!("a face has vertex index {corner}, but there are 4 vertices"));
        assert_eq!(read([faces, vertices], corner), Err(message.clone()));
        assert_eq!(read([vertices, faces], corner), Err(message));
    }
}

#[test]
fn packed_files_are_read_wherever_they_are_named() {
    let pack = |bytes: &[u8]| {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    };
    let assets = MemoryAssets::default()
        .with("scene.pbrt.gz", pack(b"WorldBegin\nInclude \"part.pbrt.gz\""))
        .with("part.pbrt.gz", pack(b"Shape \"plymesh\" \"string filename\" \"a.ply.gz\""))
        .with("a.ply.gz", pack(&binary(true)));
    let imported = import("scene.pbrt.gz", &assets);
    assert!(!imported.has_errors(), "{:#?}", imported.diagnostics);
    let (_, shape) = imported.desc.shapes.iter().next().unwrap();
    assert!(matches!(&shape.kind, ShapeKind::PlyMesh { triangles, .. } if triangles.indices.len() == 1));
}

#[test]
fn an_stl_file_stands_in_the_studio_and_is_a_shape_of_scenes() {
    let facet = |a: &str, b: &str, c: &str| {
        format!("facet normal 0 0 0\nouter loop\nvertex {a}\nvertex {b}\nvertex {c}\nendloop\nendfacet\n")
    };
    let stl =
        format!("solid\n{}{}endsolid", facet("0 0 0", "1 0 0", "0 0 2"), facet("0 0 2", "1 0 0", "1 0 2"));
    let scene = "WorldBegin Shape \"plymesh\" \"string filename\" \"a.stl\"";
    let assets = MemoryAssets::default().with("a.stl", stl).with("a.pbrt", scene);
    let shape = |path: &str| {
        let imported = import(path, &assets);
        assert!(imported.diagnostics.is_empty(), "{:#?}", imported.diagnostics);
        imported.desc.shapes.iter().next().expect("a shape").1.value.clone()
    };
    let (alone, part) = (shape("a.stl"), shape("a.pbrt"));
    for shape in [&alone, &part] {
        let ShapeKind::PlyMesh { triangles, .. } = &shape.kind else { panic!("{:?}", shape.kind) };
        assert_eq!(triangles.indices[..], [[0, 1, 2], [2, 1, 3]]);
    }
    // z of the file is up in the studio.
    let top = alone.world_from_object.start.transform_point3(Vec3::new(0.0, 0.0, 2.0).as_dvec3());
    assert!((top - Vec3::new(0.0, 2.0, 0.0).as_dvec3()).length() < 1e-12, "{top}");
}

#[test]
fn an_obj_file_is_a_scene_with_its_materials() {
    let obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl lamp\nf 1 2 3\nusemtl glass\nf 3 2 1\n";
    assert_eq!(read_obj(obj.as_bytes()).unwrap().triangles.len(), 2);
    let mtl = "newmtl lamp\nKd 0.5 0.5 0.5\nKe 4 4 4\nnewmtl glass\nillum 7\nNi 1.4\n";
    let imported = import("a.obj", &MemoryAssets::default().with("a.obj", obj).with("a.mtl", mtl));
    assert!(imported.diagnostics.is_empty(), "{:#?}", imported.diagnostics);
    let desc = imported.desc;
    // With the ground and its material.
    assert_eq!((desc.shapes.len(), desc.materials.len(), desc.area_lights.len()), (3, 3, 1));
    let camera = desc.camera.camera_from_world.start;
    for corner in [Vec3::ZERO, Vec3::X, Vec3::Y] {
        let seen = camera.transform_point3(corner.as_dvec3());
        assert!(
            seen.z > 0.0 && seen.x.abs().max(seen.y.abs()) < seen.z * 20_f64.to_radians().tan(),
            "{seen}"
        );
    }
}

/// An ASCII PLY file of a square, with more properties and their values.
fn square_ply(vertex: &str, values: [&str; 4], face: &str, faces: [&str; 2]) -> String {
    let places = ["-1 -1 0", "1 -1 0", "1 1 0", "-1 1 0"];
    let rows: String = places.iter().zip(values).map(|(place, value)| format!("{place} {value}\n")).collect();
    format!(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n{vertex}\
         element face 2\nproperty list uchar int vertex_indices\n{face}end_header\n{rows}3 0 1 2 {}\n3 0 2 3 {}\n",
        faces[0], faces[1]
    )
}

#[test]
fn ply_files_of_other_programs_are_read() {
    let plain = square_ply("", [""; 4], "", [""; 2]);
    let mesh = read_ply(plain.as_bytes()).unwrap();
    let quality = square_ply("property float quality\n", ["nan", "-nan", "inf", "1.#QNAN"], "", [""; 2]);
    let latin = plain.replace("element face", "comment by J\u{f6}rg\nelement face");
    let latin: Vec<u8> = latin.chars().map(|c| c as u8).collect();
    for bytes in [
        quality.into_bytes(),
        latin,
        plain.replace('\n', "\r").into_bytes(),
        plain.replace('\n', "\r\n").into_bytes(),
        format!("\u{feff}{plain}").into_bytes(),
    ] {
        assert_eq!(read_ply(&bytes), Ok(mesh.clone()));
    }
    // Binary values after a header whose lines end by a carriage return alone.
    let header = plain.split("end_header").next().unwrap().replace("ascii", "binary_little_endian");
    let mut bytes = format!("{header}end_header\n").replace('\n', "\r").into_bytes();
    mesh.positions.iter().for_each(|p| bytes.extend(p.to_array().map(f32::to_le_bytes).concat()));
    for [a, b, c] in &mesh.triangles {
        bytes.push(3);
        bytes.extend([a, b, c].map(|corner| corner.to_le_bytes()).concat());
    }
    assert_eq!(read_ply(&bytes), Ok(mesh.clone()));
    // Elsewhere a number that is none is an error, or 0 where nothing needs it.
    let bad = plain.replace("1 1 0 ", "1 nan 0 ");
    assert_eq!(read_ply(bad.as_bytes()), Err(MeshError::Invalid("a vertex position is not finite".into())));
    let uvs = square_ply("property float u\nproperty float v\n", ["nan 0", "1 0", "1 1", "0 1"], "", [""; 2]);
    let uvs = read_ply(uvs.as_bytes()).unwrap();
    assert_eq!((uvs.uvs[0], uvs.warnings.len()), (Vec2::ZERO, 1));
}

#[test]
fn colours_of_ply_files_are_srgb_codes_of_any_type() {
    let properties = |kind: &str, prefix: &str| {
        ["red", "green", "blue"].map(|name| format!("property {kind} {prefix}{name}\n")).concat()
    };
    let half = image::linear_from_srgb(0.2);
    let expected = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, half], [1.0; 3]];
    for (kind, prefix, values) in [
        ("uchar", "", ["255 0 0", "0 255 0", "0 0 51", "255 255 255"]),
        ("uchar", "diffuse_", ["255 0 0", "0 255 0", "0 0 51", "255 255 255"]),
        ("ushort", "", ["65535 0 0", "0 65535 0", "0 0 13107", "65535 65535 65535"]),
        ("float", "", ["1 0 0", "0 1 0", "0 0 0.2", "1 1 1"]),
        ("int", "", ["255 0 0", "0 255 0", "0 0 51", "255 255 255"]),
    ] {
        let ply = square_ply(&properties(kind, prefix), values, "", [""; 2]);
        let mesh = read_ply(ply.as_bytes()).unwrap();
        assert_eq!((&mesh.colors[..], &mesh.warnings[..]), (&expected[..], &[][..]), "{kind}");
        let imported = import("a.ply", &MemoryAssets::default().with("a.ply", ply));
        assert!(imported.diagnostics.is_empty(), "{:#?}", imported.diagnostics);
        let (_, image) = imported.desc.images.iter().next().unwrap();
        assert_eq!(image.image.rgb(0, 0), [1.0, 0.0, 0.0]);
    }
    let faces = square_ply("", [""; 4], &properties("uchar", ""), ["255 0 0", "0 255 0"]);
    let mesh = read_ply(faces.as_bytes()).unwrap();
    for (triangle, color) in mesh.triangles.iter().zip(&expected) {
        assert!(triangle.iter().all(|&corner| mesh.colors[corner as usize] == *color));
    }
    let clear = properties("uchar", "") + "property uchar alpha\n";
    let clear = square_ply(&clear, ["0 0 0 255", "0 0 0 7", "0 0 0 255", "0 0 0 255"], "", [""; 2]);
    assert_eq!(read_ply(clear.as_bytes()).unwrap().warnings, ["vertices: their opacity is not drawn"]);
    let scene = "WorldBegin Shape \"plymesh\" \"string filename\" \"a.ply\"";
    let imported = import("a.pbrt", &MemoryAssets::default().with("a.pbrt", scene).with("a.ply", faces));
    assert!(imported.diagnostics[0].message.contains("colours of its vertices are not drawn"));
}

#[test]
fn texture_coordinates_of_faces_and_pictures_of_ply_files_are_read() {
    let wedges = ["6 0 0 1 0 1 1", "6 0.5 0.5 1 1 0 1"];
    let ply = square_ply("", [""; 4], "property list uchar float texcoord\n", wedges);
    let mesh = read_ply(ply.as_bytes()).unwrap();
    let uvs = |triangle: [u32; 3]| triangle.map(|corner| mesh.uvs[corner as usize]);
    let places = |triangle: [u32; 3]| triangle.map(|corner| mesh.positions[corner as usize]);
    assert_eq!(uvs(mesh.triangles[0]), [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]].map(Vec2::from_array));
    assert_eq!(uvs(mesh.triangles[1]), [[0.5, 0.5], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from_array));
    assert_eq!(places(mesh.triangles[1])[0], Vec3::new(-1.0, -1.0, 0.0));
    assert_eq!((mesh.positions.len(), mesh.warnings.len()), (5, 0), "one corner is split");
    let named = ply.replace("element vertex", "comment TextureFile my skin.png\nelement vertex");
    let imported = import("d/a.ply", &MemoryAssets::default().with("d/a.ply", named));
    let message = &imported.diagnostics[0].message;
    assert!(message.starts_with("cannot read the image `d/my skin.png`"), "{message}");
}
