//! Grids as NanoVDB files ([Museth 2021]), of version 32.3 of the layout, without compression.
//!
//! A grid is a header, then a tree in breadth-first order: a root, upper nodes of 32³ lower nodes,
//! lower nodes of 16³ leaves, leaves of 8³ voxels. Bricks of one value are tiles of lower nodes.
//! Numbers are little-endian; nodes refer to others by their distance in bytes.

use std::collections::{BTreeMap, BTreeSet};

use description::VoxelsDesc;
use math::{DMat4, DVec3};

const MAGIC: &[u8] = b"NanoVDB0";
const VERSION: u32 = 32 << 21 | 3 << 10 | 3;
/// Bytes of the header of a grid, of a tree, of a root and of each of its children, of an upper
/// node, of a lower node and of a leaf.
const HEADER: usize = 672;
const TREE: usize = 64;
const ROOT: usize = 64;
const ROOT_TILE: usize = 32;
const UPPER: Level = Level { children: 1 << 15, bytes: 270_400 };
const LOWER: Level = Level { children: 1 << 12, bytes: 33_856 };
const LEAF: usize = 2144;
/// The file has a header, and for each grid facts before its name.
const FILE: usize = 16;
const FACTS: usize = 176;
/// The number of 32-bit floats among types, and of fog among classes.
const FLOAT: u32 = 1;
const FOG: u32 = 2;
/// Bounds and extremes are known, and nodes are in breadth-first order.
const FLAGS: u32 = 1 << 1 | 1 << 2 | 1 << 5;
/// What stands for no checksum.
const NO_CHECKSUM: u64 = u64::MAX;

/// A kind of node with nodes below it.
struct Level {
    children: usize,
    bytes: usize,
}

impl Level {
    /// Where the bits of active children begin, those of nodes among them, the extremes of values,
    /// and the table of children.
    const ACTIVE: usize = 32;

    fn nodes(&self) -> usize {
        Self::ACTIVE + self.children / 8
    }

    fn extremes(&self) -> usize {
        self.nodes() + self.children / 8
    }

    fn table(&self) -> usize {
        self.extremes() + 32
    }
}

/// What is known of the active voxels of a node.
#[derive(Clone, Copy)]
struct Summary {
    count: u64,
    first: [i32; 3],
    last: [i32; 3],
    least: f32,
    greatest: f32,
}

impl Summary {
    const NONE: Self = Self {
        count: 0,
        first: [i32::MAX; 3],
        last: [i32::MIN; 3],
        least: f32::INFINITY,
        greatest: f32::NEG_INFINITY,
    };

    fn add(&mut self, other: &Self) {
        self.count += other.count;
        for axis in 0..3 {
            self.first[axis] = self.first[axis].min(other.first[axis]);
            self.last[axis] = self.last[axis].max(other.last[axis]);
        }
        self.least = self.least.min(other.least);
        self.greatest = self.greatest.max(other.greatest);
    }

    /// The least and the greatest value; that of the background if there is none.
    fn extremes(&self, background: f32) -> [f32; 2] {
        if self.count == 0 { [background; 2] } else { [self.least, self.greatest] }
    }
}

/// A brick in the tree: its first voxel and its values, and whether it is a tile.
struct Brick<'a> {
    origin: [i32; 3],
    /// x fastest.
    values: &'a [f32],
    is_tile: bool,
    summary: Summary,
}

/// The place of a brick in the order of the tree: the key of its upper node, and its numbers among
/// the children of the upper and of the lower node.
type Place = (u64, usize, usize);

fn place(origin: [i32; 3]) -> Place {
    let key = origin.map(|x| u64::from(x.cast_unsigned() >> 12));
    let child = |size: u32, log_children: u32| {
        let along = origin.map(|x| (x >> size) as usize & ((1 << log_children) - 1));
        (along[0] << log_children | along[1]) << log_children | along[2]
    };
    (key[0] << 42 | key[1] << 21 | key[2], child(7, 5), child(3, 4))
}

/// The bricks that are not only background, and those with the outermost active voxels.
fn bricks(voxels: &VoxelsDesc) -> BTreeMap<Place, Brick<'_>> {
    let [first, last] = voxels.active;
    let corners = [first, last].map(|corner| corner.map(|x| x >> 3 << 3));
    let [columns, rows, _] = voxels.bricks.map(|count| count as usize);
    let mut bricks = BTreeMap::new();
    for (i, &brick) in voxels.table.iter().enumerate() {
        let at = [i % columns, i / columns % rows, i / columns / rows];
        let origin: [i32; 3] = std::array::from_fn(|axis| voxels.origin[axis] + 8 * at[axis] as i32);
        if brick == 0 && !corners.contains(&origin) {
            continue;
        }
        let values = &voxels.values[512 * brick as usize..][..512];
        let mut summary = Summary::NONE;
        for (voxel, &value) in values.iter().enumerate() {
            let index = [voxel & 7, voxel >> 3 & 7, voxel >> 6];
            let index: [i32; 3] = std::array::from_fn(|axis| origin[axis] + index[axis] as i32);
            if (0..3).all(|axis| (first[axis]..=last[axis]).contains(&index[axis])) {
                let one = Summary { count: 1, first: index, last: index, least: value, greatest: value };
                summary.add(&one);
            }
        }
        let is_constant = values.iter().all(|value| value.to_bits() == values[0].to_bits());
        let is_tile = is_constant && matches!(summary.count, 0 | 512);
        bricks.insert(place(origin), Brick { origin, values, is_tile, summary });
    }
    bricks
}

/// The bytes of a grid.
struct Out(Vec<u8>);

impl Out {
    fn put(&mut self, at: usize, bytes: &[u8]) {
        self.0[at..at + bytes.len()].copy_from_slice(bytes);
    }

    fn u32(&mut self, at: usize, value: u32) {
        self.put(at, &value.to_le_bytes());
    }

    fn u64(&mut self, at: usize, value: u64) {
        self.put(at, &value.to_le_bytes());
    }

    fn singles(&mut self, at: usize, values: &[f32]) {
        for (i, value) in values.iter().enumerate() {
            self.put(at + 4 * i, &value.to_le_bytes());
        }
    }

    fn doubles(&mut self, at: usize, values: &[f64]) {
        for (i, value) in values.iter().enumerate() {
            self.put(at + 8 * i, &value.to_le_bytes());
        }
    }

    fn coordinates(&mut self, at: usize, [first, last]: [[i32; 3]; 2]) {
        for (i, value) in first.into_iter().chain(last).enumerate() {
            self.put(at + 4 * i, &value.to_le_bytes());
        }
    }

    fn bit(&mut self, at: usize, index: usize) {
        self.0[at + index / 8] |= 1 << (index % 8);
    }

    /// The bounds and extremes of a node.
    fn summary(&mut self, at: usize, level: &Level, summary: &Summary, background: f32) {
        self.coordinates(at, [summary.first, summary.last]);
        self.singles(at + level.extremes(), &summary.extremes(background));
    }
}

/// What the head of a file says of a grid.
struct Facts {
    name: String,
    length: usize,
    summary: Summary,
    bounds: [f64; 6],
    voxel: [f64; 3],
    nodes: [u32; 4],
    tiles: [u32; 3],
}

fn grid(name: &str, index: usize, count: usize, voxels: &VoxelsDesc) -> (Facts, Vec<u8>) {
    let bricks = bricks(voxels);
    let background = voxels.values[0];
    let uppers: BTreeSet<u64> = bricks.keys().map(|&(upper, ..)| upper).collect();
    let lowers: BTreeSet<(u64, usize)> = bricks.keys().map(|&(upper, lower, _)| (upper, lower)).collect();
    let leaves = bricks.values().filter(|brick| !brick.is_tile).count();
    let root = HEADER + TREE;
    let first_upper = root + ROOT + ROOT_TILE * uppers.len();
    let first_lower = first_upper + UPPER.bytes * uppers.len();
    let first_leaf = first_lower + LOWER.bytes * lowers.len();
    let length = first_leaf + LEAF * leaves;
    let mut out = Out(vec![0; length]);

    let mut leaf = first_leaf;
    let mut lower_summaries: BTreeMap<(u64, usize), Summary> = BTreeMap::new();
    for (i, &(upper, child)) in lowers.iter().enumerate() {
        let node = first_lower + LOWER.bytes * i;
        let mut summary = Summary::NONE;
        let own = bricks.range((upper, child, 0)..=(upper, child, usize::MAX));
        out.fill(node + LOWER.table(), LOWER.children, background);
        for (&(_, _, slot), brick) in own {
            summary.add(&brick.summary);
            let entry = node + LOWER.table() + 8 * slot;
            if brick.is_tile {
                out.u64(entry, u64::from(brick.values[0].to_bits()));
                if brick.summary.count > 0 {
                    out.bit(node + Level::ACTIVE, slot);
                }
            } else {
                out.bit(node + LOWER.nodes(), slot);
                out.u64(entry, (leaf - node) as u64);
                out.leaf(leaf, brick, voxels.active, background);
                leaf += LEAF;
            }
        }
        out.summary(node, &LOWER, &summary, background);
        lower_summaries.insert((upper, child), summary);
    }

    let mut whole = Summary::NONE;
    let mut lower = first_lower;
    for (i, &upper) in uppers.iter().enumerate() {
        let node = first_upper + UPPER.bytes * i;
        let mut summary = Summary::NONE;
        out.fill(node + UPPER.table(), UPPER.children, background);
        for (&(_, slot), below) in lower_summaries.range((upper, 0)..=(upper, usize::MAX)) {
            summary.add(below);
            out.bit(node + UPPER.nodes(), slot);
            out.u64(node + UPPER.table() + 8 * slot, (lower - node) as u64);
            lower += LOWER.bytes;
        }
        out.summary(node, &UPPER, &summary, background);
        whole.add(&summary);
        let tile = root + ROOT + ROOT_TILE * i;
        out.u64(tile, upper);
        out.u64(tile + 8, (node - root) as u64);
    }
    out.coordinates(root, [whole.first, whole.last]);
    out.u32(root + 24, uppers.len() as u32);
    let [least, greatest] = whole.extremes(background);
    out.singles(root + 28, &[background, least, greatest]);

    let active_tiles = bricks.values().filter(|brick| brick.is_tile && brick.summary.count > 0).count();
    let nodes = [leaves, lowers.len(), uppers.len()].map(|count| count as u32);
    for (i, first) in [first_leaf, first_lower, first_upper, root].into_iter().enumerate() {
        out.u64(HEADER + 8 * i, (first - HEADER) as u64);
    }
    for (i, count) in nodes.into_iter().enumerate() {
        out.u32(HEADER + 32 + 4 * i, count);
    }
    out.u32(HEADER + 44, active_tiles as u32);
    out.u64(HEADER + 56, whole.count);

    let (bounds, voxel) = out.header(name, [index, count], voxels);
    let nodes = [nodes[0], nodes[1], nodes[2], 1];
    let tiles = [active_tiles as u32, 0, 0];
    let facts = Facts { name: name.to_owned(), length, summary: whole, bounds, voxel, nodes, tiles };
    (facts, out.0)
}

impl Out {
    /// A table of children that are all tiles of the background.
    fn fill(&mut self, table: usize, children: usize, background: f32) {
        for child in 0..children {
            self.u32(table + 8 * child, background.to_bits());
        }
    }

    fn leaf(&mut self, at: usize, brick: &Brick, [first, last]: [[i32; 3]; 2], background: f32) {
        let Summary { count, first: low, last: high, .. } = brick.summary;
        let low = if count == 0 { brick.origin } else { low };
        for axis in 0..3 {
            self.put(at + 4 * axis, &low[axis].to_le_bytes());
            self.0[at + 12 + axis] = if count == 0 { 0 } else { (high[axis] - low[axis]) as u8 };
        }
        // Whether the bounds are known.
        self.0[at + 15] = u8::from(count > 0) << 1;
        self.singles(at + 80, &brick.summary.extremes(background));
        for i in 0..512 {
            // In the file z is the fastest.
            let [x, y, z] = [i >> 6, i >> 3 & 7, i & 7];
            let index = [x, y, z];
            let is_active = (0..3)
                .all(|axis| (first[axis]..=last[axis]).contains(&(brick.origin[axis] + index[axis] as i32)));
            if is_active {
                self.bit(at + 16, i);
            }
            self.singles(at + 96 + 4 * i, &[brick.values[x | y << 3 | z << 6]]);
        }
    }

    /// The header of a grid, the index-th of a count; its bounds and the size of its voxels.
    fn header(
        &mut self,
        name: &str,
        [index, count]: [usize; 2],
        voxels: &VoxelsDesc,
    ) -> ([f64; 6], [f64; 3]) {
        let [x, y, z] = voxels.world_from_index;
        let matrix = DMat4::from_cols_array_2d(&[x, y, z, [0.0, 0.0, 0.0, 1.0]]).transpose();
        let inverse = matrix.inverse();
        let by_rows = |matrix: DMat4| {
            let rows = matrix.transpose();
            [rows.x_axis, rows.y_axis, rows.z_axis].map(|row| row.truncate().to_array())
        };
        let (forward, back) = (by_rows(matrix), by_rows(inverse));
        let offset = matrix.w_axis.truncate().to_array();
        let mut map = [forward.as_flattened(), back.as_flattened(), &offset].concat();
        map.push(1.0);
        let singles: Vec<f32> = map.iter().map(|&number| number as f32).collect();
        self.singles(296, &singles);
        self.doubles(384, &map);

        let [first, last] = voxels.active;
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for corner in 0..8 {
            let end = |axis: usize| {
                f64::from(if corner >> axis & 1 == 0 { first[axis] } else { last[axis].saturating_add(1) })
            };
            let point = matrix.transform_point3(DVec3::new(end(0), end(1), end(2)));
            (low, high) = (low.min(point), high.max(point));
        }
        let bounds = [low.x, low.y, low.z, high.x, high.y, high.z];
        let voxel = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|axis| axis.truncate().length());
        self.put(0, MAGIC);
        self.u64(8, NO_CHECKSUM);
        self.u32(16, VERSION);
        self.u32(20, FLAGS);
        self.u32(24, index as u32);
        self.u32(28, count as u32);
        self.u64(32, self.0.len() as u64);
        self.put(40, name.as_bytes());
        self.doubles(560, &bounds);
        self.doubles(608, &voxel);
        self.u32(632, FOG);
        self.u32(636, FLOAT);
        (bounds, voxel)
    }
}

/// The hash by which grids are found.
fn name_key(name: &str) -> u64 {
    name.bytes()
        .fold(0, |key: u64, byte| key.wrapping_mul(67).wrapping_add(u64::from(byte)).wrapping_add(key >> 56))
}

/// A file of grids with their names, of less than 256 bytes each.
pub(super) fn bytes(grids: &[(&str, &VoxelsDesc)]) -> Vec<u8> {
    let grids: Vec<_> = grids
        .iter()
        .enumerate()
        .map(|(index, (name, voxels))| grid(name, index, grids.len(), voxels))
        .collect();
    let mut out = Out(vec![0; FILE]);
    out.put(0, MAGIC);
    out.u32(8, VERSION);
    out.put(12, &(grids.len() as u16).to_le_bytes());
    for (facts, _) in &grids {
        let at = out.0.len();
        out.0.resize(at + FACTS, 0);
        out.u64(at, facts.length as u64);
        out.u64(at + 8, facts.length as u64);
        out.u64(at + 16, name_key(&facts.name));
        out.u64(at + 24, facts.summary.count);
        out.u32(at + 32, FLOAT);
        out.u32(at + 36, FOG);
        out.doubles(at + 40, &facts.bounds);
        out.coordinates(at + 88, [facts.summary.first, facts.summary.last]);
        out.doubles(at + 112, &facts.voxel);
        out.u32(at + 136, facts.name.len() as u32 + 1);
        for (i, count) in facts.nodes.into_iter().chain(facts.tiles).enumerate() {
            out.u32(at + 140 + 4 * i, count);
        }
        out.u32(at + 172, VERSION);
        out.0.extend(facts.name.bytes().chain([0]));
    }
    for (_, bytes) in grids {
        out.0.extend(bytes);
    }
    out.0
}
