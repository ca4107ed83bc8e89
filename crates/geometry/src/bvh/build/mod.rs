//! Building trees.
//!
//! Every builder sorts references to primitives and builds a binary tree over them ([`tree`]),
//! which is then collapsed into wide nodes ([`widen`]).
//!
//! Temporary memory for n primitives: 32 n bytes. `balanced` has 32 n of references, which are
//! freed in parts while 8 n of ids and 24 n of binary nodes are written; these are freed in turn
//! while nodes and blocks are written. `high` keeps its references, and has up to twice as many.
//! `fast` has one reference and one binary node per block, and takes 16 n bytes to sort.

mod balanced;
mod bins;
mod fast;
mod high;
mod leaves;
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

use leaves::{BlockMaker, Item};
use overflow::Overflow;
use pages::Zeroable;
use primitives::Numbering;
use tree::{BinaryTree, Blocks};
use widen::Wide;

pub(crate) use primitives::Primitives;
pub(crate) use reference::{Extent, Reference};
pub(super) use refit::refit;
pub(crate) use widen::Built;

/// The trade-off between build time and tracing time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BuildQuality {
    /// By Morton codes: for worlds that are rebuilt for each picture. Takes a third of the time of
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
            match quality {
                BuildQuality::High => {
                    let corners = |r: &Reference| primitives.corners(r.geometry(), r.primitive());
                    collapse(primitives, high::build(references, &corners, blocks), blocks)
                }
                _ => collapse(primitives, balanced::build(references, blocks), blocks),
            }
        }
    }
}

/// Makes wide nodes and blocks of a binary tree.
fn collapse<P: Primitives, T: Item + Zeroable + Send>(
    primitives: &P,
    tree: BinaryTree<T>,
    blocks: Blocks,
) -> Built<P::Block> {
    let overflow = Overflow::new();
    let mut list = overflow.with_capacity(tree.size.blocks as usize);
    let leaves = BlockMaker { primitives, overflow: &overflow };
    let Wide { mut nodes, extent, depth } = widen::widen(tree, blocks, &mut list, &leaves);
    let blocks = overflow.resolve(list, &mut nodes);
    Built { nodes, bounds: extent.bounds(), depth, blocks }
}
