//! Building trees.
//!
//! Every builder sorts references to primitives and builds a binary tree over them ([`tree`]),
//! which is then collapsed into wide nodes ([`widen`]).
//!
//! Temporary memory for n primitives: 32 n bytes of references and 24 n of binary nodes while the
//! tree is built, then 8 n of ids while the blocks are made; `high` takes twice as much. `fast` has
//! one reference and one binary node per block, and takes 16 n bytes to sort.

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

use rayon::prelude::*;
use tree::Blocks;
use widen::Wide;

use overflow::Overflow;
pub(crate) use primitives::Primitives;
use primitives::{MAX_WIDTH, Numbering, PREFETCH_DISTANCE};
pub(crate) use reference::{Extent, Reference};
pub(super) use refit::refit;
pub(crate) use widen::Built;

/// The trade-off between build time and tracing time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BuildQuality {
    /// By Morton codes: for what is rebuilt for each picture. Takes a third of the time of
    /// `Balanced`; rays take up to twice as many tests.
    Fast,
    /// By the binned surface area heuristic: for nearly everything.
    #[default]
    Balanced,
    /// With spatial splits: for long, thin, slanted triangles and long renders. Takes six times as
    /// long as `Balanced`, and up to twice the memory.
    High,
}

/// Builds a tree and the blocks of its leaves.
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
            let tree = match quality {
                BuildQuality::High => high::build(
                    references,
                    &|r: &Reference| primitives.corners(r.geometry(), r.primitive()),
                    blocks,
                ),
                _ => balanced::build(references, blocks),
            };
            let Wide { mut nodes, blocks, extent, depth } = widen::widen(&tree, blocks);
            // Blocks are made from ids alone: a quarter of the memory of references.
            let id = |r: &Reference| [r.geometry(), r.primitive()];
            let ids: Vec<[u32; 2]> = tree.references.par_iter().map(id).collect();
            drop(tree);
            let members = |block: usize| {
                let range = blocks.get(block).cloned().unwrap_or_default();
                &ids[range.start as usize..range.end as usize]
            };
            let overflow = Overflow::new();
            let block = |block: usize| {
                let far = members(block + 2 * PREFETCH_DISTANCE);
                far.iter().for_each(|&[g, p]| primitives.prefetch_indices(g, p));
                let near = members(block + PREFETCH_DISTANCE);
                near.iter().for_each(|&[g, p]| primitives.prefetch(g, p));
                let mut references = [Reference::none(); MAX_WIDTH];
                let ids = members(block);
                for (reference, &[geometry, primitive]) in references.iter_mut().zip(ids) {
                    *reference = Reference::new(Extent::EMPTY, geometry, primitive);
                }
                overflow.block(primitives, block, &references[..ids.len()]).0
            };
            let mut made = overflow.with_capacity(blocks.len());
            made.par_extend((0..blocks.len()).into_par_iter().map(block));
            let blocks = overflow.resolve(made, &mut nodes);
            Built { nodes, bounds: extent.bounds(), depth, blocks }
        }
    }
}
