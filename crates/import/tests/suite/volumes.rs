//! NanoVDB files: grids, codecs and layouts of files, and the messages about their errors.

use std::io::Write;
use std::sync::Arc;

use alhazen_import::import;
use assets::MemoryAssets;
use description::Imported;
use description::{MediumKind, VoxelsDesc};
use flate2::{Compression, write::ZlibEncoder};

use crate::corpora::{data, shown};

pub(crate) const SCENE: &str =
    r#"WorldBegin MakeNamedMedium "m" "string type" "nanovdb" "string filename" "a.nvdb""#;

const VERSION: u32 = 32 << 21 | 4 << 10;
/// Where the parts of [`grid`] are.
const TREE: usize = 672;
pub(crate) const ROOT: usize = TREE + 64;
pub(crate) const UPPER: usize = ROOT + 64 + 32;
pub(crate) const LOWER: usize = UPPER + 270400;
pub(crate) const LEAF: usize = LOWER + 33856;
const LEAF_BYTES: usize = 2144;

fn put<const N: usize>(bytes: &mut [u8], at: usize, number: [u8; N]) {
    bytes[at..at + N].copy_from_slice(&number);
}

fn set_bit(bytes: &mut [u8], mask: usize, bit: usize) {
    bytes[mask + bit / 8] |= 1 << (bit % 8);
}

/// The grid of a name: a root, an upper and a lower node, and two leaves.
///
/// The upper node is that of the voxels (-4096, 0, 0) to (-1, 4095, 4095). Its tile from
/// (-128, 0, 256) is active; its lower node is at (-128, 0, 128). A tile of that at (-8, 8, 128) is
/// active, one at (-24, 0, 128) is not. The leaf at (-8, 0, 128) is active; the leaf at
/// (-16, 8, 144) has a voxel that is active.
pub(crate) fn grid(name: &str, background: f32) -> Vec<u8> {
    let mut bytes = vec![0; LEAF + 2 * LEAF_BYTES];
    let length = bytes.len() as u64;
    put(&mut bytes, 0, *b"NanoVDB0");
    put(&mut bytes, 16, VERSION.to_le_bytes());
    put(&mut bytes, 32, length.to_le_bytes());
    bytes[40..40 + name.len()].copy_from_slice(name.as_bytes());
    for (i, entry) in [0.5, 0.0, 0.0, 0.0, 0.25, 0.125, 0.0, 0.0, 2.0].into_iter().enumerate() {
        put(&mut bytes, 384 + 8 * i, f64::to_le_bytes(entry));
    }
    for (i, entry) in [10.0, 20.0, 30.0].into_iter().enumerate() {
        put(&mut bytes, 528 + 8 * i, f64::to_le_bytes(entry));
    }
    put(&mut bytes, 632, 2_u32.to_le_bytes());
    put(&mut bytes, 636, 1_u32.to_le_bytes());
    put(&mut bytes, TREE + 24, 64_u64.to_le_bytes());
    put(&mut bytes, ROOT + 24, 1_u32.to_le_bytes());
    put(&mut bytes, ROOT + 28, background.to_le_bytes());
    put(&mut bytes, ROOT + 64, (0xfffff_u64 << 42).to_le_bytes());
    put(&mut bytes, ROOT + 64 + 8, (96_u64).to_le_bytes());

    let table = UPPER + 8256;
    (0..32768).for_each(|i| put(&mut bytes, table + 8 * i, background.to_le_bytes()));
    set_bit(&mut bytes, UPPER + 32 + 4096, 31 << 10 | 1);
    put(&mut bytes, table + 8 * (31 << 10 | 1), 270400_u64.to_le_bytes());
    set_bit(&mut bytes, UPPER + 32, 31 << 10 | 2);
    put(&mut bytes, table + 8 * (31 << 10 | 2), 0.25_f32.to_le_bytes());

    let table = LOWER + 1088;
    (0..4096).for_each(|i| put(&mut bytes, table + 8 * i, background.to_le_bytes()));
    for (child, leaf) in [(15 << 8, 0), (14 << 8 | 1 << 4 | 2, 1)] {
        set_bit(&mut bytes, LOWER + 32 + 512, child);
        put(&mut bytes, table + 8 * child, (LEAF - LOWER + LEAF_BYTES * leaf).to_le_bytes());
    }
    set_bit(&mut bytes, LOWER + 32, 15 << 8 | 1 << 4);
    for tile in [15 << 8 | 1 << 4, 13 << 8] {
        put(&mut bytes, table + 8 * tile, 0.75_f32.to_le_bytes());
    }

    bytes[LEAF + 16..LEAF + 16 + 64].fill(0xff);
    set_bit(&mut bytes, LEAF + LEAF_BYTES + 16, 5 << 6 | 4 << 3 | 3);
    for leaf in 0..2 {
        for i in 0..512 {
            let value = (1 + leaf) as f32 * i as f32;
            put(&mut bytes, LEAF + LEAF_BYTES * leaf + 96 + 4 * i, value.to_le_bytes());
        }
    }
    bytes
}

fn zip(grid: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(grid).expect("memory takes bytes");
    encoder.finish().expect("memory takes bytes")
}

/// A grid as Blosc stores what it cannot pack: one stream for each byte of its numbers.
fn blosc(grid: &[u8]) -> Vec<u8> {
    let [length, stream] = [grid.len() as u32, grid.len() as u32 / 4].map(u32::to_le_bytes);
    let mut bytes = vec![2, 1, 0x21, 4];
    bytes.extend([length, length, [0; 4], 20_u32.to_le_bytes()].as_flattened());
    for byte in 0..4 {
        bytes.extend(stream);
        bytes.extend(grid.iter().skip(byte).step_by(4));
    }
    bytes
}

/// A segment of grids.
pub(crate) fn segment(magic: &[u8; 8], codec: u16, grids: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let mut head = magic.to_vec();
    head.extend(VERSION.to_le_bytes());
    head.extend([grids.len() as u16, codec].map(u16::to_le_bytes).as_flattened());
    let mut body = Vec::new();
    for (name, grid) in grids {
        let packed = match codec {
            0 => grid.clone(),
            1 => zip(grid),
            _ => blosc(grid),
        };
        let before = body.len();
        if codec != 0 {
            body.extend((packed.len() as u64).to_le_bytes());
        }
        body.extend(packed);
        let mut facts = [0; 176];
        put(&mut facts, 0, (grid.len() as u64).to_le_bytes());
        put(&mut facts, 8, ((body.len() - before) as u64).to_le_bytes());
        put(&mut facts, 136, (name.len() as u32 + 1).to_le_bytes());
        head.extend(facts);
        head.extend(name.bytes());
        head.push(0);
    }
    head.extend(body);
    head
}

/// The file of the grid `density` alone.
pub(crate) fn file(codec: u16) -> Vec<u8> {
    segment(b"NanoVDB0", codec, &[("density", grid("density", 0.0))])
}

pub(crate) fn read(scene: &str, file: Vec<u8>) -> Imported {
    import("a.pbrt", &MemoryAssets::default().with("a.pbrt", scene).with("a.nvdb", file))
}

/// The density and temperature of the only medium.
fn medium(imported: &Imported) -> (&VoxelsDesc, Option<&VoxelsDesc>) {
    assert!(!imported.has_errors(), "{}", shown(imported));
    let (_, medium) = imported.desc.media.iter().next().expect("a medium");
    match &medium.kind {
        MediumKind::NanoVdb { density, temperature, .. } => (density, temperature.as_ref()),
        other => panic!("{other:?}"),
    }
}

#[test]
fn leaves_and_tiles_become_bricks() {
    let imported = read(SCENE, segment(b"NanoVDB0", 0, &[("density", grid("density", 0.125))]));
    let (density, temperature) = medium(&imported);
    assert!(temperature.is_none());
    assert_eq!(density.active, [[-128, 0, 128], [-1, 127, 383]]);
    assert_eq!(density.origin, [-136, -8, 120]);
    assert_eq!(density.bricks, [18, 18, 34]);
    assert_eq!(density.world_from_index[0], [0.5, 0.0, 0.0, 10.0]);
    assert_eq!(density.world_from_index[1], [0.0, 0.25, 0.125, 20.0]);
    assert_eq!(density.world_from_index[2], [0.0, 0.0, 2.0, 30.0]);
    // The background, the tiles' two values and the leaves.
    assert_eq!(density.values.len(), 512 * 5);
    assert!(density.values[..512].iter().all(|&value| value == 0.125));
    for (index, value) in [
        ([-8, 0, 128], 0.0),
        ([-8, 0, 129], 1.0),
        ([-8, 1, 128], 8.0),
        ([-7, 0, 128], 64.0),
        ([-1, 7, 135], 511.0),
        ([0, 7, 135], 0.125),
        ([-11, 12, 147], 2.0 * (5 << 6 | 4 << 3 | 3) as f32),
        ([-8, 8, 128], 0.75),
        ([-1, 15, 135], 0.75),
        ([-24, 0, 128], 0.75),
        ([-25, 0, 128], 0.125),
        ([-24, 0, 136], 0.125),
        ([-128, 0, 256], 0.25),
        ([-1, 127, 383], 0.25),
        ([-1, 128, 383], 0.125),
        ([-1, 127, 384], 0.125),
        ([-1, 127, 255], 0.125),
        ([1000, 0, 0], 0.125),
    ] {
        assert_eq!(density.value(index), value, "{index:?}");
    }
}

#[test]
fn grids_without_active_voxels_have_their_background() {
    let mut empty = grid("density", 0.5);
    put(&mut empty, ROOT + 24, 0_u32.to_le_bytes());
    let imported = read(SCENE, segment(b"NanoVDB0", 0, &[("density", empty)]));
    let (density, _) = medium(&imported);
    assert_eq!((density.active, density.value([0; 3])), ([[0; 3]; 2], 0.5));
}

#[test]
fn all_codecs_and_layouts_of_files_give_the_same_grids() {
    let bare = grid("density", 0.0);
    let mut new_bare = bare.clone();
    put(&mut new_bare, 0, *b"NanoVDB1");
    let other = ("density of ice", grid("density of ice", 9.0));
    let plain = read(SCENE, file(0));
    let several = [other.clone(), ("density", bare.clone())];
    for (what, file) in [
        ("ZIP", file(1)),
        ("Blosc", file(2)),
        ("new magic", segment(b"NanoVDB2", 1, &[("density", new_bare.clone())])),
        ("several grids", segment(b"NanoVDB0", 2, &several)),
        ("several segments", [segment(b"NanoVDB0", 1, &[other]), file(0)].concat()),
        ("no segments", [grid("ice", 1.0), bare].concat()),
        ("no segments, new magic", new_bare),
    ] {
        let read = read(SCENE, file);
        assert_eq!(medium(&read).0, medium(&plain).0, "{what}");
    }
}

#[test]
fn grids_of_64_bit_floats_are_read() {
    // Nodes are as for 32-bit floats, but the root and leaves are longer.
    let single = grid("density", 0.0);
    let mut double = single[..ROOT].to_vec();
    put(&mut double, 636, 2_u32.to_le_bytes());
    let mut root = vec![0; 96 + 2 * 32];
    put(&mut root, 24, 2_u32.to_le_bytes());
    put(&mut root, 32, 0.5_f64.to_le_bytes());
    put(&mut root, 96, (0xfffff_u64 << 42).to_le_bytes());
    put(&mut root, 96 + 8, 160_u64.to_le_bytes());
    // A tile from (0, 0, 0) to (4095, 4095, 4095).
    put(&mut root, 128 + 24, 2.5_f64.to_le_bytes());
    double.extend(root);
    double.extend(&single[UPPER..LEAF]);
    let [upper, lower, leaf] = [ROOT + 160, ROOT + 160 + 270400, ROOT + 160 + 270400 + 33856];
    for (table, count) in [(upper + 8256, 32768), (lower + 1088, 4096)] {
        for i in 0..count {
            let at = table + 8 * i;
            let [low, high] = [at, at + 4].map(|at| f32::from_le_bytes([0, 1, 2, 3].map(|b| double[at + b])));
            if high == 0.0 && low >= 0.125 {
                put(&mut double, at, f64::from(low).to_le_bytes());
            }
        }
    }
    double.resize(leaf + 2 * 4224, 0);
    put(&mut double, lower + 1088 + 8 * (14 << 8 | 1 << 4 | 2), (leaf + 4224 - lower).to_le_bytes());
    double[leaf + 16..leaf + 80].fill(0xff);
    for i in 0..512 {
        put(&mut double, leaf + 128 + 8 * i, (i as f64).to_le_bytes());
    }
    let length = double.len() as u64;
    put(&mut double, 32, length.to_le_bytes());
    let imported = read(SCENE, segment(b"NanoVDB0", 0, &[("density", double)]));
    let (density, _) = medium(&imported);
    assert_eq!(density.active, [[-128, 0, 128], [-1, 127, 383]]);
    for (index, value) in [
        ([-8, 0, 129], 1.0),
        ([-1, 7, 135], 511.0),
        ([-8, 8, 128], 0.75),
        ([-128, 0, 256], 0.25),
        ([-25, 0, 128], 0.0),
        ([0, 0, 128], 2.5),
        ([7, 127, 383], 2.5),
        ([8, 0, 128], 0.5),
        ([-128, -1, 256], 0.5),
    ] {
        assert_eq!(density.value(index), value, "{index:?}");
    }
}

#[test]
fn grids_are_chosen_by_name() {
    let grids = ["density", "fuel", "temperature", "heat"].map(|name| (name, grid(name, name.len() as f32)));
    let file = segment(b"NanoVDB0", 1, &grids);
    let backgrounds = |parameters: &str| {
        let imported = read(&format!("{SCENE} {parameters}"), file.clone());
        let (density, temperature) = medium(&imported);
        (density.values[0], temperature.map(|temperature| temperature.values[0]))
    };
    assert_eq!(backgrounds(""), (7.0, Some(11.0)));
    assert_eq!(backgrounds(r#""string gridname" "fuel""#), (4.0, Some(11.0)));
    assert_eq!(backgrounds(r#""string temperaturename" "heat""#), (7.0, Some(4.0)));
}

#[test]
fn media_of_the_same_grid_share_it() {
    let scene = format!("{SCENE} {}", SCENE.replace("WorldBegin", "").replace("\"m\"", "\"n\""));
    let imported = read(&scene, file(0));
    assert!(!imported.has_errors(), "{}", shown(&imported));
    let media: Vec<_> = imported.desc.media.iter().map(|(_, medium)| &medium.kind).collect();
    let [MediumKind::NanoVdb { density: a, .. }, MediumKind::NanoVdb { density: b, .. }] = media[..] else {
        panic!("{media:?}")
    };
    assert!(Arc::ptr_eq(&a.values, &b.values) && Arc::ptr_eq(&a.table, &b.table));
}

#[test]
fn grids_that_are_missing_are_reported_where_they_are_named() {
    for (parameters, place, message) in [
        (
            r#""string gridname" "densty""#,
            r#""densty""#,
            "there is no grid `densty` in `a.nvdb`, which has `density`, `fuel`",
        ),
        (r#""string temperaturename" "temperature""#, r#""temperature""#, "there is no grid `temperature`"),
    ] {
        let scene = format!("{SCENE} {parameters}");
        let grids = ["density", "fuel"].map(|name| (name, grid(name, 0.0)));
        let imported = read(&scene, segment(b"NanoVDB0", 1, &grids));
        let [diagnostic] = &imported.diagnostics[..] else { panic!("{}", shown(&imported)) };
        assert!(diagnostic.message.contains(message), "{}", diagnostic.message);
        let span = diagnostic.span();
        assert_eq!(&scene[span.start as usize..span.end as usize], place);
    }
    let imported = read(SCENE, segment(b"NanoVDB0", 1, &[("fuel", grid("fuel", 0.0))]));
    let span = imported.diagnostics[0].span();
    assert_eq!(&SCENE[span.start as usize..span.end as usize], r#""a.nvdb""#);
}

#[test]
fn files_that_cannot_be_read_say_why() {
    let nan = f32::NAN.to_le_bytes();
    let far = 0x7_ffff_u64.to_le_bytes();
    let good = grid("density", 0.0);
    let mut twins = good.clone();
    put(&mut twins, ROOT + 24, 2_u32.to_le_bytes());
    twins.copy_within(ROOT + 64..ROOT + 96, ROOT + 96);
    let mut overlapping = good.clone();
    overlapping[LOWER + 32 + 512..LOWER + 32 + 1024].fill(0xff);
    (0..4096).for_each(|i| {
        put(&mut overlapping, LOWER + 1088 + 8 * i, (LEAF - LOWER).to_le_bytes());
    });
    let with = |at: usize, bytes: &[u8]| {
        let mut grid = good.clone();
        grid[at..at + bytes.len()].copy_from_slice(bytes);
        grid
    };
    for (grid, message) in [
        (with(0, b"VDB"), "a grid does not begin with `NanoVDB`"),
        (with(16, &(31_u32 << 21).to_le_bytes()), "version 31.0"),
        (with(384, &[0; 72]), "no volume"),
        (with(384, &f64::NAN.to_le_bytes()), "no volume"),
        (with(632, &[1]), "it is a level set, not a fog volume"),
        (with(632, &[77]), "it is a grid of an unknown class"),
        (with(636, &[6]), "vector of 32-bit floats"),
        (with(636, &[99]), "unknown type"),
        (with(TREE + 24, &(1_u64 << 40).to_le_bytes()), "cut off or damaged"),
        (with(TREE + 24, &(i64::MIN).to_le_bytes()), "refers to one"),
        (with(ROOT + 24, &u32::MAX.to_le_bytes()), "cut off or damaged"),
        (with(ROOT + 28, &nan), "a value is NaN"),
        (with(ROOT + 72, &(i64::MIN).to_le_bytes()), "refers to one"),
        (with(ROOT + 72, &(LEAF as u64).to_le_bytes()), "cut off or damaged"),
        (with(UPPER + 8256, &nan), "a value is NaN"),
        (with(LEAF + 96, &nan), "a value is NaN"),
        (twins, "two children of its root are at the same place"),
        (overlapping, "nodes of 2144 bytes, which overlap"),
    ] {
        let imported = read(SCENE, segment(b"NanoVDB0", 0, &[("density", grid)]));
        let [diagnostic] = &imported.diagnostics[..] else { panic!("{message}: {}", shown(&imported)) };
        assert!(diagnostic.message.contains(message), "{message}: {}", diagnostic.message);
        assert!(diagnostic.message.starts_with("cannot read the volume `a.nvdb`"), "{}", diagnostic.message);
    }
    // A second child of the root, at the other end of the world.
    let mut vast = good.clone();
    vast[ROOT + 24] = 2;
    put(&mut vast, ROOT + 96, far);
    put(&mut vast, ROOT + 96 + 16, [1, 0, 0, 0, 0, 0, 0, 63]);
    let packed = |codec| segment(b"NanoVDB0", codec, &[("density", good.clone())]);
    let with = |codec, at: usize, bytes: &[u8]| {
        let mut file = packed(codec);
        file[at..at + bytes.len()].copy_from_slice(bytes);
        file
    };
    for (file, message) in [
        (b" BDV\0\0\0\0 and so on".to_vec(), "it is an OpenVDB file; `nanovdb_convert`"),
        (b"0BDVonaN and so on".to_vec(), "big-endian"),
        (b"something else".to_vec(), "it is not a NanoVDB file"),
        (Vec::new(), "cut off"),
        (with(0, 8, &(29_u32 << 21).to_le_bytes()), "it is of version 29.0 of the format"),
        (with(0, 14, &[3]), "an unknown codec (3)"),
        (with(0, 16, &u64::MAX.to_le_bytes()), "cut off or damaged"),
        (with(1, 16, &(1_u64 << 30).to_le_bytes()), "at most 67108864 are allowed"),
        (with(1, 16, &[1, 0, 0]), "it is damaged: a grid has not the 1 bytes"),
        (with(2, 16, &[1, 0, 0]), "stand for 1"),
        ([packed(0), b"some more bytes".to_vec()].concat(), "no segment begins at its byte"),
    ] {
        let imported = read(SCENE, file);
        let diagnostic = &imported.diagnostics[0];
        assert!(diagnostic.message.contains(message), "{message}: {}", diagnostic.message);
    }
    let imported = read(SCENE, segment(b"NanoVDB0", 1, &[("density", vast)]));
    assert!(imported.diagnostics[0].message.contains("are allowed"), "{}", shown(&imported));
}

/// What the file says about the active voxels of its only grid, which is not packed: their number,
/// bounds, least and greatest value, mean and standard deviation.
fn statistics(file: &[u8]) -> (u64, [[i32; 3]; 2], [f32; 4]) {
    let grid = &file[16 + 176 + "density".len() + 1..];
    let word = |at: usize| [0, 1, 2, 3].map(|i| grid[at + i]);
    let corner = |at: usize| [0, 4, 8].map(|i| i32::from_le_bytes(word(at + i)));
    let root = TREE + 64;
    let values = [32, 36, 40, 44].map(|at| f32::from_le_bytes(word(root + at)));
    let count = u32::from_le_bytes(word(TREE + 56));
    (count.into(), [corner(root), corner(root + 12)], values)
}

#[test]
fn volumes_of_other_programs_have_the_statistics_in_their_files() {
    for (folder, name) in [("volumes", "smoke_000002.nvdb"), ("pbrt-v4-conformance", "assets/ring.nvdb")] {
        let Some(folder) = data(folder) else { continue };
        let file = std::fs::read(folder.join(name)).expect("the file is there");
        let (count, bounds, [least, greatest, mean, deviation]) = statistics(&file);
        let imported = read(SCENE, file);
        let (density, temperature) = medium(&imported);
        assert!(temperature.is_none());
        assert_eq!(density.active, bounds);
        // The background is zero, and active voxels are not.
        assert!(least > 0.0 && density.values[..512].iter().all(|&value| value == 0.0));
        let values: Vec<f64> =
            density.values.iter().filter(|&&value| value != 0.0).map(|&value| value.into()).collect();
        assert_eq!(values.len() as u64, count);
        assert_eq!(values.iter().copied().fold(f64::INFINITY, f64::min), f64::from(least));
        assert_eq!(values.iter().copied().fold(0.0, f64::max), f64::from(greatest));
        let sum: f64 = values.iter().sum();
        let found = sum / count as f64;
        let squares: f64 = values.iter().map(|value| (value - found).powi(2)).sum();
        assert!((found - f64::from(mean)).abs() < 1e-5, "{name}: {found}, {mean}");
        let spread = (squares / count as f64).sqrt();
        assert!((spread - f64::from(deviation)).abs() < 1e-5, "{name}: {spread}, {deviation}");
    }
}

#[test]
fn packed_volumes_of_other_programs_are_the_same() {
    let Some(folder) = data("volumes") else { return };
    let [plain, packed] = ["smoke_000002.nvdb", "smoke_000002_zip.nvdb"]
        .map(|name| read(SCENE, std::fs::read(folder.join(name)).expect("the file is there")));
    assert_eq!(medium(&plain).0, medium(&packed).0);
}
