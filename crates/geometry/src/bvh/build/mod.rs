//! How primitives are divided.
//!
//! Every builder brings references to primitives into an order and grows a binary tree over them
//! ([`tree`]); what becomes a wide node is then decided for all of them alike ([`widen`]).
//!
//! Memory for n primitives, beyond what is kept: 32 n bytes of references and 24 n of binary nodes
//! while the tree grows, then 8 n of ids while the blocks are made; `high` takes twice as much. `fast` has a reference and a
//! binary node for each block alone, and takes 16 n bytes to sort.

mod balanced;
mod bins;
mod fast;
mod high;
mod overflow;
mod pages;
mod partition;
mod primitives;
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
use tree::Blocks;
use widen::Wide;

use overflow::Overflow;
use primitives::{MAX_WIDTH, Numbering};
pub(crate) use primitives::Primitives;
pub(crate) use reference::{Extent, Reference};
pub(super) use refit::refit;

/// How much time a tree is worth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BuildQuality {
    /// By Morton codes: for what is built anew for each picture. Takes a third of the time of
    /// `Balanced`, and rays take up to twice as many tests.
    Fast,
    /// By the surface-area heuristic over bins: for nearly everything.
    #[default]
    Balanced,
    /// With spatial splits: for long, thin, slanted triangles and pictures that take long. Takes
    /// six times as long as `Balanced`, and up to twice the memory.
    High,
}

/// A tree, and what its leaves hold.
pub(crate) struct Built<B> {
    pub nodes: Vec<WideNode>,
    pub bounds: Bounds3,
    /// How many nodes are above each other.
    pub depth: usize,
    /// In the order of the leaves.
    pub blocks: Vec<B>,
}

/// Memory is asked for what is in a block so many blocks before that is made, and twice as many for
/// what leads there.
const AHEAD: usize = 8;

/// Builds a tree.
pub(crate) fn build<P: Primitives>(primitives: &P, quality: BuildQuality) -> Built<P::Block> {
    match quality {
        BuildQuality::Fast => fast::build(primitives),
        BuildQuality::Balanced | BuildQuality::High => {
            let mut references =
                Numbering::of(primitives).map(primitives, |_, geometry, primitive, extent| {
                    extent.map_or(Reference::none(), |extent| Reference::new(extent, geometry, primitive))
                });
            if references.iter().any(Reference::is_none) {
                references.retain(|r| !r.is_none());
            }
            let blocks = Blocks::of(primitives.width(), P::COST);
            let planted = match quality {
                BuildQuality::High => high::plant(
                    references,
                    &|r: &Reference| primitives.corners(r.geometry(), r.primitive()),
                    blocks,
                ),
                _ => balanced::plant(references, blocks),
            };
            let Wide { mut nodes, blocks, extent, depth } = widen::widen(&planted, blocks);
            // Blocks are made from ids alone: a quarter of the memory of references.
            let id = |r: &Reference| [r.geometry(), r.primitive()];
            let ids: Vec<[u32; 2]> = planted.references.par_iter().map(id).collect();
            drop(planted);
            let members = |block: usize| {
                let range = blocks.get(block).cloned().unwrap_or_default();
                &ids[range.start as usize..range.end as usize]
            };
            let overflow = Overflow::new();
            let block = |block: usize| {
                members(block + 2 * AHEAD).iter().for_each(|&[g, p]| primitives.prefetch_indices(g, p));
                members(block + AHEAD).iter().for_each(|&[g, p]| primitives.prefetch(g, p));
                let mut references = [Reference::none(); MAX_WIDTH];
                let ids = members(block);
                for (reference, &[geometry, primitive]) in references.iter_mut().zip(ids) {
                    *reference = Reference::new(Extent::EMPTY, geometry, primitive);
                }
                overflow.block(primitives, block, &references[..ids.len()]).0
            };
            let mut made = overflow.room(blocks.len());
            made.par_extend((0..blocks.len()).into_par_iter().map(block));
            let blocks = overflow.resolve(made, &mut nodes);
            Built { nodes, bounds: extent.bounds(), depth, blocks }
        }
    }
}
