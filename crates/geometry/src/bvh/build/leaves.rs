//! Making the blocks of leaves, while the tree above them is collapsed.

use super::overflow::Overflow;
use super::primitives::{MAX_WIDTH, PREFETCH_DISTANCE, Primitives};
use super::reference::{Extent, Ids, Reference};
use super::widen::{Boxes, Leaves};

/// A primitive of a leaf, or a part of one.
pub(super) trait Item: Sync {
    fn ids(&self) -> Ids;
    fn extent(&self, primitives: &impl Primitives) -> Extent;
}

impl Item for Reference {
    fn ids(&self) -> Ids {
        self.ids()
    }

    fn extent(&self, _: &impl Primitives) -> Extent {
        self.extent()
    }
}

impl Item for Ids {
    #[inline(always)]
    fn ids(&self) -> Ids {
        *self
    }

    /// The box is recomputed: the block needs the same corners.
    #[inline(always)]
    fn extent(&self, primitives: &impl Primitives) -> Extent {
        let [geometry, primitive] = *self;
        primitives.extent(geometry, primitive).unwrap_or(Extent::EMPTY)
    }
}

/// Makes blocks of primitives.
pub(super) struct BlockMaker<'a, P: Primitives> {
    pub primitives: &'a P,
    pub overflow: &'a Overflow<P::Block>,
}

impl<P: Primitives, T: Item> Leaves<T, P::Block> for BlockMaker<'_, P> {
    #[inline(always)]
    fn block(&self, items: &[T], len: usize, index: usize) -> P::Block {
        let &Self { primitives, overflow } = self;
        let width = primitives.width();
        let ahead = |blocks: usize| items.iter().skip(blocks * width).take(width).map(Item::ids);
        ahead(2 * PREFETCH_DISTANCE).for_each(|[g, p]| primitives.prefetch_indices(g, p));
        ahead(PREFETCH_DISTANCE).for_each(|[g, p]| primitives.prefetch(g, p));
        let mut references = [Reference::none(); MAX_WIDTH];
        for (reference, item) in references.iter_mut().zip(&items[..len]) {
            let [geometry, primitive] = item.ids();
            *reference = Reference::new(Extent::EMPTY, geometry, primitive);
        }
        overflow.block(primitives, index, &references[..len]).0
    }

    #[inline(always)]
    fn boxes(&self, items: &[T]) -> Boxes {
        Boxes::of(items.iter().map(|item| item.extent(self.primitives)))
    }
}
