//! A grid as a table of bricks.

use std::collections::HashMap;
use std::sync::Arc;

use description::VoxelsDesc;
use rayon::prelude::*;

use super::bytes::Bytes;
use super::header::Header;
use super::tree::Tree;
use super::unpack::require;
use super::values::Values;

/// The number of voxels of a brick.
const BRICK: usize = 512;

/// Decodes a grid; on failure, the reason.
pub(super) fn read(bytes: Bytes, limit: u64) -> Result<VoxelsDesc, String> {
    let header = Header::read(bytes)?;
    let values = Values::numbered(header.kind)?;
    header.check()?;
    let tree = Tree::read(bytes, values)?;
    // Without active voxels the one at the origin stands for all.
    let active = tree.active.unwrap_or([[0; 3]; 2]);
    let places = Places::around(active);

    // The bricks are that of the background, one for each other value of tiles, and the leaves.
    let mut bricks = vec![tree.background];
    let mut bricks_of_values = HashMap::from([(tree.background.to_bits(), 0)]);
    let tiles: Vec<_> =
        tree.tiles.iter().filter_map(|tile| Some((places.covered(tile.origin, tile.size)?, tile))).collect();
    for (_, tile) in &tiles {
        bricks_of_values.entry(tile.value.to_bits()).or_insert_with(|| {
            bricks.push(tile.value);
            bricks.len() as u32 - 1
        });
    }
    let leaves: Vec<_> =
        tree.leaves.iter().filter_map(|leaf| Some((places.covered(leaf.origin, 8)?, leaf))).collect();
    let [count, leaf_brick] = [bricks.len() + leaves.len(), bricks.len()];
    let bytes_needed = places.count().saturating_mul(4).saturating_add((count * BRICK * 4) as u64);
    require(bytes_needed, limit)?;

    let mut table: Arc<[u32]> = std::iter::repeat_n(0, places.count() as usize).collect();
    let table_entries = Arc::get_mut(&mut table).expect("invariant: there is one owner");
    for (covered, tile) in tiles {
        places.fill(table_entries, covered, bricks_of_values[&tile.value.to_bits()]);
    }
    for (index, (covered, _)) in leaves.iter().enumerate() {
        places.fill(table_entries, *covered, (leaf_brick + index) as u32);
    }

    let mut numbers: Arc<[f32]> = std::iter::repeat_n(0.0, count * BRICK).collect();
    let all = Arc::get_mut(&mut numbers).expect("invariant: there is one owner");
    let (constant, own) = all.split_at_mut(leaf_brick * BRICK);
    for (brick, &value) in constant.chunks_exact_mut(BRICK).zip(&bricks) {
        brick.fill(value);
    }
    let leaves = own.par_chunks_exact_mut(BRICK).zip(&leaves);
    let error = leaves.find_map_first(|(brick, (_, leaf))| values.leaf(bytes, leaf.at, brick).err());
    error.map_or(Ok(()), Err)?;
    let world_from_index = header.world_from_index;
    Ok(VoxelsDesc {
        origin: places.first.map(|first| 8 * first),
        bricks: places.counts.map(|count| count as u32),
        table,
        values: numbers,
        active,
        world_from_index,
    })
}

/// The places of a table of bricks. Coordinates are those of voxels divided by 8.
struct Places {
    first: [i32; 3],
    counts: [i32; 3],
}

impl Places {
    /// Those of the voxels up to one beyond the given first and last ones.
    fn around([first, last]: [[i32; 3]; 2]) -> Self {
        let first = first.map(|first| first.saturating_sub(1) >> 3);
        let last = last.map(|last| last.saturating_add(1) >> 3);
        Self { first, counts: std::array::from_fn(|axis| last[axis] - first[axis] + 1) }
    }

    fn count(&self) -> u64 {
        self.counts.iter().fold(1, |count, &along| count.saturating_mul(along as u64))
    }

    /// The first place, and that after the last, of those that a cube of voxels covers, relative to
    /// the first of all; nothing outside.
    fn covered(&self, origin: [i32; 3], size: i32) -> Option<[[usize; 3]; 2]> {
        let mut covered = [[0; 3]; 2];
        for axis in 0..3 {
            let first = (origin[axis] >> 3) - self.first[axis];
            let end = (first + size / 8).min(self.counts[axis]);
            let first = first.max(0);
            if first >= end {
                return None;
            }
            covered[0][axis] = first as usize;
            covered[1][axis] = end as usize;
        }
        Some(covered)
    }

    fn fill(&self, table: &mut [u32], [first, end]: [[usize; 3]; 2], brick: u32) {
        let [columns, rows, _] = self.counts.map(|count| count as usize);
        for z in first[2]..end[2] {
            for y in first[1]..end[1] {
                let row = (z * rows + y) * columns;
                table[row + first[0]..row + end[0]].fill(brick);
            }
        }
    }
}
