//! Primitives that find no room in the block that was planned for them.
//!
//! Trees are cut as if each block took its full number of primitives. Where one does not, because
//! it has room for less than what they bring, the rest goes to blocks behind it, and all leaves are
//! told where their blocks are now.

use super::pages;
use super::primitives::Primitives;
use super::reference::{Extent, Reference};
use crate::bvh::node::{Child, WideNode};
use rayon::prelude::*;
use std::sync::Mutex;

/// Blocks beside those that were planned, each with the number of the one that was too small.
pub(super) struct Overflow<B>(Mutex<Vec<(u32, B)>>);

impl<B: Copy + Send> Overflow<B> {
    pub fn new() -> Self {
        Self(Mutex::default())
    }

    /// An empty list for so many planned blocks, and some more: one that grows would be copied.
    pub fn room(&self, planned: usize) -> Vec<B> {
        pages::room(planned + planned / 16)
    }

    /// Makes a planned block, and others when there is not room for all; gives the box around all.
    #[inline(always)]
    pub fn block<P: Primitives<Block = B>>(
        &self,
        primitives: &P,
        index: usize,
        references: &[Reference],
    ) -> (B, Extent) {
        let (block, taken, extent) = primitives.block(references);
        if taken == references.len() {
            return (block, extent);
        }
        (block, extent.union(self.add(primitives, index, &references[taken..])))
    }

    /// Makes blocks of what is left; gives the box around it.
    #[cold]
    #[inline(never)]
    fn add<P: Primitives<Block = B>>(&self, primitives: &P, index: usize, mut left: &[Reference]) -> Extent {
        let mut list = self.0.lock().expect("invariant: no thread panics with the lock");
        let mut all = Extent::EMPTY;
        while !left.is_empty() {
            let (block, taken, extent) = primitives.block(left);
            list.push((index as u32, block));
            left = &left[taken..];
            all = all.union(extent);
        }
        all
    }

    /// Puts the blocks behind those that were too small, and brings the leaves up to date.
    pub fn resolve(self, mut blocks: Vec<B>, nodes: &mut [WideNode]) -> Vec<B> {
        let mut added = self.0.into_inner().expect("invariant: no thread panics with the lock");
        if added.is_empty() {
            return blocks;
        }
        // Stable, as blocks of one number are in order.
        added.par_sort_by_key(|&(index, _)| index);
        // Where each planned block comes to stand: behind as many blocks more than planned.
        let planned = blocks.len();
        let mut firsts: Vec<u32> = (0..=planned as u32).collect();
        blocks.reserve_exact(added.len());
        blocks.resize(planned + added.len(), blocks[0]);

        let (mut gap, mut end) = (added.len(), planned);
        firsts[planned] += gap as u32;
        for of_one in added.chunk_by(|(a, _), (b, _)| a == b).rev() {
            let later = of_one[0].0 as usize + 1..end;
            firsts[later.clone()].iter_mut().for_each(|first| *first += gap as u32);
            blocks.copy_within(later.clone(), later.start + gap);
            gap -= of_one.len();
            end = later.start;
            blocks[end + gap..].iter_mut().zip(of_one).for_each(|(block, &(_, added))| *block = added);
        }
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
