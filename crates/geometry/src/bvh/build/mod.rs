//! How primitives are divided.
//!
//! Every builder brings references to primitives into an order and grows a binary tree over them ([`tree`]);
//! what becomes a wide node is then decided for all of them alike ([`widen`]).
//!
//! Memory for n primitives, beyond what is kept: 32 n bytes of references and 20 n of binary nodes, given back
//! when the blocks are made. `fast` takes 32 n or 16 n more while it sorts, `high` twice as much.

mod balanced;
mod bins;
mod fast;
mod high;
mod partition;
mod reference;
mod refit;
mod spatial;
#[cfg(test)]
mod tests;
mod tree;
mod widen;

use super::node::WideNode;
use math::Bounds3;
use rayon::prelude::*;
use std::ops::Range;
use tree::Blocks;

pub(crate) use reference::Reference;
pub(super) use refit::refit;
pub(crate) use spatial::Corners;

/// How much time a tree is worth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BuildQuality {
    /// By Morton codes: for what is built anew for each picture. Takes half the time of `Balanced`, and rays
    /// take up to twice as many tests.
    Fast,
    /// By the surface-area heuristic over bins: for nearly everything.
    #[default]
    Balanced,
    /// With spatial splits: for long, thin, slanted triangles and pictures that take long. Takes six times as
    /// long as `Balanced`, and up to twice the memory.
    High,
}

/// A tree, and what its leaves hold.
pub(crate) struct Built {
    pub nodes: Vec<WideNode>,
    pub bounds: Bounds3,
    /// How many nodes are above each other.
    pub depth: usize,
    references: Vec<Reference>,
    blocks: Vec<Range<u32>>,
}

impl Built {
    /// What each block of the leaves is made of, in order.
    pub fn blocks(&self) -> impl IndexedParallelIterator<Item = &[Reference]> {
        self.blocks.par_iter().map(|r| &self.references[r.start as usize..r.end as usize])
    }
}

/// Builds a tree over references with finite bounds; leaves hold blocks of `width` references, a power of two.
pub(crate) fn build(
    references: Vec<Reference>,
    quality: BuildQuality,
    width: usize,
    corners: impl Corners,
) -> Built {
    if references.is_empty() {
        return Built { nodes: Vec::new(), bounds: Bounds3::EMPTY, depth: 0, references, blocks: Vec::new() };
    }
    let blocks = Blocks::of(width);
    let planted = match quality {
        BuildQuality::Fast => fast::plant(references, blocks),
        BuildQuality::Balanced => balanced::plant(references, blocks),
        BuildQuality::High => high::plant(references, &corners, blocks),
    };
    let wide = widen::widen(&planted, blocks);
    Built {
        nodes: wide.nodes,
        bounds: wide.extent.bounds(),
        depth: wide.depth,
        references: planted.references,
        blocks: wide.blocks,
    }
}
