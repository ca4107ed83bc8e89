//! The tree of a grid: below its root nodes of 32³ nodes of 16³ leaves of 8³ voxels. Where a node
//! has no child, it has a tile: one value for all voxels that the child would have.

use std::collections::HashSet;

use super::bytes::Bytes;
use super::header;
use super::values::Values;

/// A region of one value.
pub(super) struct Tile {
    /// Its first voxel.
    pub(super) origin: [i32; 3],
    /// The number of voxels along its edge.
    pub(super) size: i32,
    pub(super) value: f32,
}

/// 8³ voxels with values of their own.
pub(super) struct Leaf {
    /// Its first voxel.
    pub(super) origin: [i32; 3],
    /// Its place in the bytes of the grid.
    pub(super) at: usize,
}

/// What a tree has.
pub(super) struct Tree {
    pub(super) background: f32,
    /// Those that differ from the background.
    pub(super) tiles: Vec<Tile>,
    pub(super) leaves: Vec<Leaf>,
    /// The first and last coordinates of active voxels, if there is one.
    pub(super) active: Option<[[i32; 3]; 2]>,
}

/// A level of nodes below the root that have nodes as children.
#[derive(Clone, Copy)]
struct Level {
    /// The number of children along an edge is two to this.
    log_children: u32,
    /// The number of voxels along the edge of a child is two to this.
    log_voxels: u32,
}

const UPPER: Level = Level { log_children: 5, log_voxels: 7 };
const LOWER: Level = Level { log_children: 4, log_voxels: 3 };
/// Where the bits of active tiles or voxels begin.
const MASK: usize = 32;
const LEAF_MASK: usize = 16;

impl Level {
    fn children(self) -> usize {
        1 << (3 * self.log_children)
    }

    /// Where the table of children begins: after two masks and, aligned, statistics.
    fn table(self) -> usize {
        MASK + 2 * self.children() / 8 + 32
    }

    fn bytes(self) -> usize {
        self.table() + 8 * self.children()
    }

    /// The first voxel of a child of the node with the given first voxel. z is the fastest.
    fn origin(self, [x, y, z]: [i32; 3], child: usize) -> [i32; 3] {
        let coordinate = |shift: u32| {
            let along = child >> (shift * self.log_children) & ((1 << self.log_children) - 1);
            (along as i32) << self.log_voxels
        };
        [x + coordinate(2), y + coordinate(1), z + coordinate(0)]
    }
}

impl Tree {
    pub(super) fn read(bytes: Bytes, values: Values) -> Result<Self, String> {
        const TREE: usize = header::SIZE;
        let root = bytes.target(TREE, TREE + 24)?;
        let background = values.value(bytes, root + values.place(28))?;
        let tree = Self { background, tiles: Vec::new(), leaves: Vec::new(), active: None };
        let mut reader = Reader { bytes, values, tree };
        reader.root(root)?;
        Ok(reader.tree)
    }
}

struct Reader<'a> {
    bytes: Bytes<'a>,
    values: Values,
    tree: Tree,
}

impl Reader<'_> {
    fn root(&mut self, root: usize) -> Result<(), String> {
        const TILE: usize = 32;
        let count = self.bytes.u32(root + 24)?;
        let first = root + self.values.root_bytes();
        self.bytes.part(first, u64::from(count) * TILE as u64)?;
        let mut origins = HashSet::new();
        let mut uppers = Vec::new();
        for at in (0..count as usize).map(|i| first + TILE * i) {
            // The upper 20 bits of the coordinates.
            let key = self.bytes.u64(at)?;
            let origin = [42, 21, 0].map(|shift| ((key >> shift) as u32) << 12).map(u32::cast_signed);
            // Regions that do not overlap are filled in a time that the limit of memory bounds.
            if !origins.insert(origin) {
                return Err("it is damaged: two children of its root are at the same place".into());
            }
            if self.bytes.u64(at + 8)? != 0 {
                uppers.push((origin, self.bytes.target(root, at + 8)?));
            } else {
                let is_active = self.bytes.u32(at + 16)? & 1 != 0;
                self.tile(origin, 4096, at + self.values.place(20), is_active)?;
            }
        }
        let lowers = self.children(UPPER, &uppers)?;
        let leaves = self.children(LOWER, &lowers)?;
        self.check_count(leaves.len(), self.values.leaf_bytes())?;
        for &(origin, at) in &leaves {
            self.include_active(origin, at)?;
        }
        self.tree.leaves = leaves.into_iter().map(|(origin, at)| Leaf { origin, at }).collect();
        Ok(())
    }

    /// Reads the tiles of nodes; returns the first voxels and the places of their children.
    fn children(
        &mut self,
        level: Level,
        nodes: &[([i32; 3], usize)],
    ) -> Result<Vec<([i32; 3], usize)>, String> {
        self.check_count(nodes.len(), level.bytes())?;
        let mut children = Vec::new();
        for &(first, node) in nodes {
            let bits = level.children() / 8;
            let is_active = self.bytes.part(node + MASK, bits as u64)?;
            let has_child = self.bytes.part(node + MASK + bits, bits as u64)?;
            for i in 0..level.children() {
                let (origin, at) = (level.origin(first, i), node + level.table() + 8 * i);
                let bit = |mask: &[u8]| mask[i / 8] >> (i % 8) & 1 != 0;
                if bit(has_child) {
                    children.push((origin, self.bytes.target(node, at)?));
                } else {
                    self.tile(origin, 1 << level.log_voxels, at, bit(is_active))?;
                }
            }
        }
        Ok(children)
    }

    /// Refuses more nodes than there are bytes for, among which some would be the same.
    fn check_count(&self, nodes: usize, bytes: usize) -> Result<(), String> {
        if nodes > self.bytes.len() / bytes {
            return Err(format!("it is damaged: it has {nodes} nodes of {bytes} bytes, which overlap"));
        }
        Ok(())
    }

    fn tile(&mut self, origin: [i32; 3], size: i32, at: usize, is_active: bool) -> Result<(), String> {
        let value = self.values.value(self.bytes, at)?;
        if is_active {
            self.include(origin, origin.map(|first| first + (size - 1)));
        }
        if value.to_bits() != self.tree.background.to_bits() {
            self.tree.tiles.push(Tile { origin, size, value });
        }
        Ok(())
    }

    /// Extends the bounds of active voxels by those of a leaf.
    fn include_active(&mut self, origin: [i32; 3], leaf: usize) -> Result<(), String> {
        let mask: [u8; 64] = self.bytes.array(leaf + LEAF_MASK)?;
        // A byte for each x and y, with a bit for each z.
        for (i, &row) in mask.iter().enumerate().filter(|&(_, &row)| row != 0) {
            let [x, y] = [origin[0] + (i / 8) as i32, origin[1] + (i % 8) as i32];
            let last = 7 - row.leading_zeros() as i32;
            self.include([x, y, origin[2] + row.trailing_zeros() as i32], [x, y, origin[2] + last]);
        }
        Ok(())
    }

    fn include(&mut self, first: [i32; 3], last: [i32; 3]) {
        let [low, high] = self.tree.active.get_or_insert([first, last]);
        for axis in 0..3 {
            low[axis] = low[axis].min(first[axis]);
            high[axis] = high[axis].max(last[axis]);
        }
    }
}
