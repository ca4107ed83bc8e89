//! Primitives that find no room in the block that was planned for them.
//!
//! Trees are cut as if each block took its full number of primitives. Where one does not, because it has room for
//! less than what they bring, the rest goes to blocks behind it, and all leaves are told where their blocks are now.

use super::primitives::Primitives;
use super::reference::{Extent, Reference};
use crate::bvh::node::{Child, WideNode};
use rayon::prelude::*;
use std::sync::Mutex;

/// Which of the planned blocks were too small.
#[derive(Default)]
pub(super) struct Overflow(Mutex<Vec<u32>>);

impl Overflow {
    /// An empty list for so many planned blocks, and some more: one that grows would be copied.
    pub fn room<B>(&self, planned: usize) -> Vec<B> {
        Vec::with_capacity(planned + planned / 64)
    }

    /// Makes a planned block, and notes when there is not room for all; gives the box around all.
    #[inline(always)]
    pub fn block<P: Primitives>(
        &self,
        primitives: &P,
        index: usize,
        references: &[Reference],
    ) -> (P::Block, Extent) {
        let (block, taken, extent) = primitives.block(references);
        if taken == references.len() {
            return (block, extent);
        }
        (block, extent.union(self.note(primitives, index, &references[taken..])))
    }

    /// Notes a planned block that was too small; gives the box around what is left.
    #[cold]
    #[inline(never)]
    fn note<P: Primitives>(&self, primitives: &P, index: usize, left: &[Reference]) -> Extent {
        self.0.lock().expect("invariant: no thread panics with the lock").push(index as u32);
        rest(primitives, left).fold(Extent::EMPTY, |all, (_, extent)| all.union(extent))
    }

    /// Puts blocks for what is left behind those that were too small, and brings the leaves up to date. `members` gives
    /// the primitives of a planned block.
    pub fn resolve<P: Primitives, M: AsRef<[Reference]>>(
        self,
        primitives: &P,
        members: impl Fn(usize) -> M + Sync,
        mut blocks: Vec<P::Block>,
        nodes: &mut [WideNode],
    ) -> Vec<P::Block> {
        let mut small = self.0.into_inner().expect("invariant: no thread panics with the lock");
        if small.is_empty() {
            return blocks;
        }
        small.par_sort_unstable();
        let rest_of = |&index: &u32| -> Vec<P::Block> {
            let members = members(index as usize);
            let (_, taken, _) = primitives.block(members.as_ref());
            rest(primitives, &members.as_ref()[taken..]).map(|(block, _)| block).collect()
        };
        let rests: Vec<_> = small.par_iter().map(rest_of).collect();
        // Where each planned block comes to stand: behind as many blocks more than planned.
        let mut firsts: Vec<u32> = (0..=blocks.len() as u32).collect();
        let planned = blocks.len();
        let mut end = planned;
        let added: usize = rests.iter().map(Vec::len).sum();
        blocks.reserve_exact(added);
        blocks.resize(planned + added, blocks[0]);

        let mut gap = added;
        for (&small, rest) in small.iter().zip(&rests).rev() {
            let later = small as usize + 1..end;
            firsts[later.start..].iter_mut().take(later.len()).for_each(|first| *first += gap as u32);
            blocks.copy_within(later.clone(), later.start + gap);
            gap -= rest.len();
            blocks[later.start + gap..][..rest.len()].copy_from_slice(rest);
            end = later.start;
        }
        firsts[planned] += added as u32;
        nodes.par_iter_mut().for_each(|node| {
            node.renew_children(|child| match child.is_leaf() {
                true => {
                    let planned = child.blocks();
                    let first = firsts[planned.start] as usize;
                    Child::leaf(first, firsts[planned.end] as usize - first)
                }
                false => child,
            });
        });
        blocks
    }
}

/// As many blocks as primitives need.
fn rest<P: Primitives>(
    primitives: &P,
    mut references: &[Reference],
) -> impl Iterator<Item = (P::Block, Extent)> {
    std::iter::from_fn(move || {
        if references.is_empty() {
            return None;
        }
        let (block, taken, extent) = primitives.block(references);
        references = &references[taken..];
        Some((block, extent))
    })
}
