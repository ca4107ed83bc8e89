//! No input makes the readers panic, hang or take much memory.

use std::io::Write;
use std::sync::LazyLock;

use alhazen_import::import;
use assets::{MemoryAssets, read_obj, read_ply, read_stl};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::volumes;

const SCENE: &str = r#"
Option "seed" 3
LookAt 0 1 -5 0 0 0 0 1 0
Camera "perspective" "float fov" [40] "float screenwindow" [-1 1 -1 1]
Film "rgb" "integer xresolution" 64 "string filename" "a.exr"
WorldBegin
AttributeBegin
  ActiveTransform EndTime Translate 1 2 3 ActiveTransform All
  MakeNamedMedium "m" "string type" "homogeneous" "rgb sigma_a" [1 1 1]
  MediumInterface "m" ""
  Texture "t" "spectrum" "checkerboard" "rgb tex1" [1 0 0]
  MakeNamedMaterial "a" "string type" "diffuse" "texture reflectance" "t"
  NamedMaterial "a"
  AreaLightSource "diffuse" "blackbody L" 5000 "float scale" .1
  Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 2] "point2 uv" [0 0 1 0 0 1]
  Shape "curve" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 1] "string type" "cylinder"
AttributeEnd
ObjectBegin "o" Shape "sphere" ObjectEnd
ObjectInstance "o"
Shape "implicit" "string f" "max(x^2 - y, sin(3*z)) / 2" "point3 bounds" [-1 -1 -1 1 1 1]
Shape "csg" "string operation" "difference" "string operands" ["o" "o"]
LightSource "infinite" "spectrum L" [400 1 700 2]
"#;

const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
    element face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n4 0 1 2 3\n";

const OBJ: &str = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf -1 -2 -3 -4\n";

const STL: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\nendsolid a";

const IES: &str = "IESNA:LM-63-1995\n[TEST] made up\nTILT=INCLUDE\n1\n2\n0 90\n1 0.9\n\
    1 1000 1 3 2 1 2 0 0 0\n1 1 60\n0 45 90\n0 90\n100 50 0\n90 40 1\n";

/// Bytes as the triangles of a binary STL file that says how many it holds.
fn binary_stl(triangles: Vec<u8>) -> Vec<u8> {
    let count = (triangles.len() / 50) as u32;
    [&[0; 80][..], &count.to_le_bytes(), &triangles].concat()
}

/// Whether a photometric file is refused.
fn refuses_lamp(bytes: Vec<u8>) -> bool {
    let scene = "WorldBegin LightSource \"goniometric\" \"string filename\" \"lamp.IES\"";
    import("a.pbrt", &MemoryAssets::default().with("a.pbrt", scene).with("lamp.IES", bytes)).has_errors()
}

/// A file of measurements with a field of each kind, padded to where its numbers begin.
fn measurements() -> Vec<u8> {
    const NUMBERS: usize = 320;
    let fields: [(&str, &[u64]); 7] = [
        ("phi_i", &[1]),
        ("theta_i", &[2]),
        ("ndf", &[2, 2]),
        ("sigma", &[2, 2]),
        ("vndf", &[1, 2, 2, 2]),
        ("luminance", &[1, 2, 2, 2]),
        ("rgb", &[1, 2, 3, 2, 2]),
    ];
    let mut bytes = b"tensor_file\0\x01\x00".to_vec();
    bytes.extend(7_u32.to_le_bytes());
    let mut numbers: Vec<u8> = Vec::new();
    for (name, shape) in fields {
        bytes.extend((name.len() as u16).to_le_bytes());
        bytes.extend(name.as_bytes());
        bytes.extend((shape.len() as u16).to_le_bytes());
        bytes.push(10);
        bytes.extend(((NUMBERS + numbers.len()) as u64).to_le_bytes());
        shape.iter().for_each(|length| bytes.extend(length.to_le_bytes()));
        let count = shape.iter().product::<u64>() as u16;
        numbers.extend((1..=count).flat_map(|i| f32::from(i).to_le_bytes()));
    }
    assert!(bytes.len() <= NUMBERS, "{}", bytes.len());
    bytes.resize(NUMBERS, 0);
    bytes.extend(numbers);
    bytes
}

/// Why a file of measurements is refused; empty if it is not.
fn measurements_refused(bytes: Vec<u8>) -> String {
    let scene = "WorldBegin Material \"measured\" \"string filename\" \"a.bsdf\" Shape \"sphere\"";
    let assets = MemoryAssets::default().with("a.pbrt", scene).with("a.bsdf", bytes);
    let messages = import("a.pbrt", &assets).diagnostics.into_iter().map(|diagnostic| diagnostic.message);
    messages.collect::<Vec<_>>().join("; ")
}

/// A text with some bytes replaced, removed or doubled.
fn mutated(text: &'static str) -> impl Strategy<Value = Vec<u8>> {
    prop::collection::vec((0..text.len(), any::<u8>(), 0..3_u8), 1..8).prop_map(move |changes| {
        let mut bytes = text.as_bytes().to_vec();
        for (at, byte, how) in changes {
            let at = at % bytes.len();
            match how {
                0 => bytes[at] = byte,
                1 => _ = bytes.remove(at),
                _ => bytes.insert(at, bytes[at]),
            }
        }
        bytes
    })
}

fn import_bytes(bytes: Vec<u8>) -> bool {
    import("a.pbrt", &MemoryAssets::default().with("a.pbrt", bytes)).has_errors()
}

#[test]
fn the_unchanged_texts_are_read() {
    assert!(!import_bytes(SCENE.into()));
    assert!(read_ply(PLY.as_bytes()).is_ok() && read_obj(OBJ.as_bytes()).is_ok());
    assert!(read_stl(STL.as_bytes()).is_ok() && read_stl(&binary_stl(STL.into())).is_ok());
    assert!(!refuses_lamp(IES.into()));
}

#[test]
fn cut_off_lamps_are_refused() {
    // Before its last number, and the end of the line.
    for length in 0..IES.len() - 2 {
        assert!(refuses_lamp(IES.as_bytes()[..length].into()), "{length}");
    }
}

#[test]
fn measurements_that_are_cut_off_or_do_not_fit_are_refused() {
    let good = measurements();
    assert_eq!(measurements_refused(good.clone()), "");
    for length in 0..good.len() {
        let message = measurements_refused(good[..length].into());
        assert!(message.starts_with("cannot read the measurements `a.bsdf`: it "), "{length}: {message}");
    }
    let changed = |from: &[u8], to: &[u8]| {
        let at = good.windows(from.len()).position(|bytes| bytes == from).expect("the bytes are there");
        let mut bytes = good.clone();
        bytes[at..at + from.len()].copy_from_slice(to);
        measurements_refused(bytes)
    };
    for (from, to, expected) in [
        (&b"tensor"[..], &b"sensor"[..], "not a tensor file"),
        (b"vndf", b"vndg", "has no field `vndf`"),
        (b"rgb\x05", b"rgb\x04", "layers [1, 2], not [1, 2, 3]"),
        (b"sigma\x02\0\x0a", b"sigma\x02\0\x01", "`sigma` does not have 32-bit floats"),
        (b"theta_i\x01", b"theta_i\x02", "ends within its field `theta_i`"),
        (b"theta_i\x01\0\x0a", b"theta_i\x00\0\x0a", "`theta_i` has 0 dimensions"),
    ] {
        let message = changed(from, to);
        assert!(message.contains(expected), "{message}, not {expected}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, rng_seed: RngSeed::Fixed(1), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_bytes_do_not_panic(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let _ = (read_ply(&bytes).is_ok(), read_obj(&bytes).is_ok(), read_stl(&bytes).is_ok());
        let _ = (read_stl(&binary_stl(bytes.clone())).is_ok(), import_bytes(bytes));
    }

    #[test]
    fn random_words_do_not_panic(words in prop::collection::vec(
        prop::sample::select(SCENE.split_whitespace().collect::<Vec<_>>()), 0..60,
    )) {
        let _ = import_bytes(words.join(" ").into_bytes());
    }

    #[test]
    fn damaged_scenes_do_not_panic(bytes in mutated(SCENE)) {
        let _ = import_bytes(bytes);
    }

    #[test]
    fn damaged_meshes_do_not_panic(ply in mutated(PLY), obj in mutated(OBJ), stl in mutated(STL)) {
        let _ = (read_ply(&ply).is_ok(), read_obj(&obj).is_ok(), read_stl(&stl).is_ok());
    }

    #[test]
    fn damaged_lamps_do_not_panic(bytes in mutated(IES)) {
        let _ = refuses_lamp(bytes);
    }

    #[test]
    fn damaged_measurements_do_not_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        length in 0..700_usize,
    ) {
        let mut bytes = measurements();
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        bytes.truncate(length);
        let _ = measurements_refused(bytes);
    }

    #[test]
    fn damaged_binary_meshes_do_not_panic(body in prop::collection::vec(any::<u8>(), 0..120), big: bool) {
        let order = if big { "big" } else { "little" };
        let mut bytes = PLY[..PLY.find("0 0 0").unwrap()].replace("ascii", &format!("binary_{order}_endian")).into_bytes();
        bytes.extend(body);
        let _ = read_ply(&bytes).is_ok();
    }
}

const MTL: &str =
    "newmtl a\nKd 0.5 0.5 0.5\nKs 1 1 1\nKe 0 0 0\nNs 20\nNi 1.5\nd 0.2\nillum 7\nmap_Kd -s 1 1 a.png\n";

fn packed(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    encoder.write_all(bytes).expect("memory takes bytes");
    encoder.finish().expect("memory takes bytes")
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, rng_seed: RngSeed::Fixed(2), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_mesh_scenes_do_not_panic(obj in mutated(OBJ), mtl in mutated(MTL)) {
        let assets = MemoryAssets::default().with("a.obj", obj).with("a.mtl", mtl);
        let imported = import("a.obj", &assets);
        prop_assert!(imported.has_errors() || imported.desc.shapes.len() >= 2, "the mesh and the ground");
    }

    #[test]
    fn damaged_packed_scenes_do_not_panic(changes in prop::collection::vec((any::<usize>(), any::<u8>()), 1..4)) {
        let mut bytes = packed(SCENE.as_bytes());
        for (at, byte) in changes {
            let at = at % bytes.len();
            bytes[at] = byte;
        }
        let _ = import_bytes(bytes);
    }

    #[test]
    fn damaged_tables_do_not_panic(bytes in prop::collection::vec(prop::sample::select(&b"0123456789.-+e #\n,x\xff"[..]), 0..80)) {
        let scene = "Camera \"realistic\" \"string lensfile\" \"a.dat\"\nWorldBegin\n\
                     Material \"diffuse\" \"spectrum reflectance\" \"a.dat\"\nShape \"plymesh\" \"string filename\" \"a.dat\"\n";
        let _ = import("a.pbrt", &MemoryAssets::default().with("a.pbrt", scene).with("a.dat", bytes)).has_errors();
    }
}

fn refuses_volume(file: Vec<u8>) -> bool {
    volumes::read(volumes::SCENE, file).has_errors()
}

#[test]
fn cut_off_volumes_are_refused() {
    for codec in 0..3 {
        let file = volumes::file(codec);
        assert!(!refuses_volume(file.clone()));
        let step = if file.len() < 10_000 { 1 } else { 997 };
        for length in (0..300).chain((300..file.len()).step_by(step)).chain([file.len() - 1]) {
            assert!(refuses_volume(file[..length].into()), "codec {codec}, {length} bytes");
        }
    }
    // The header of the file knows nothing of the cut.
    let grid = volumes::grid("density", 0.0);
    for length in (0..1000).chain((1000..grid.len()).step_by(997)).chain([grid.len() - 1]) {
        let cut = vec![("density", grid[..length].to_vec())];
        assert!(refuses_volume(volumes::segment(b"NanoVDB0", 0, &cut)), "{length}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, rng_seed: RngSeed::Fixed(3), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_volumes_do_not_panic(
        codec in 0..3_u16,
        flips in prop::collection::vec((any::<prop::sample::Index>(), 0..8), 1..5),
    ) {
        // The bytes that mean most: headers, the root, masks, the ends of tables, and a leaf.
        let places = [0..volumes::ROOT + 96, volumes::UPPER..volumes::UPPER + 8300, volumes::LOWER..volumes::LOWER + 1200,
            volumes::LEAF - 3000..volumes::LEAF + 200];
        let places: Vec<usize> = places.into_iter().flatten().collect();
        static GRID: LazyLock<Vec<u8>> = LazyLock::new(|| volumes::grid("density", 0.0));
        static FILES: LazyLock<[Vec<u8>; 3]> = LazyLock::new(|| [0, 1, 2].map(volumes::file));
        let (mut grid, mut file) = (GRID.clone(), FILES[usize::from(codec)].clone());
        for (at, bit) in flips {
            grid[places[at.index(places.len())]] ^= 1_u8 << bit;
            let at = at.index(file.len().min(4000));
            file[at] ^= 1_u8 << bit;
        }
        let _ = refuses_volume(volumes::segment(b"NanoVDB2", codec, &[("density", grid)]));
        let _ = refuses_volume(file);
    }
}
