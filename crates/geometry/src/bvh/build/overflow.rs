//! Primitives that do not fit into the block planned for them.
//!
//! Trees are built as if each block took its full number of primitives. Where their data exceeds
//! the block's capacity, the rest goes to additional blocks behind it, and the leaves are updated.

use super::pages;
use super::primitives::Primitives;
use super::reference::{Extent, Reference};
use crate::bvh::node::{Child, WideNode};
use rayon::prelude::*;
use std::sync::Mutex;

/// Additional blocks, each with the index of the planned block that was too small.
pub(super) struct Overflow<B>(Mutex<Vec<(u32, B)>>);

impl<B: Copy + Send> Overflow<B> {
    pub fn new() -> Self {
        Self(Mutex::default())
    }

    /// An empty list with capacity for the planned blocks and some more, so that it is not copied
    /// to grow.
    pub fn with_capacity(&self, planned: usize) -> Vec<B> {
        pages::with_capacity(planned + planned / 16)
    }

    /// Makes a planned block, and additional ones where it is too small; returns the box around all
    /// of them.
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

    /// Makes additional blocks of the rest; returns the box around it.
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

    /// Inserts the additional blocks behind those that were too small, and updates the leaves.
    pub fn resolve(self, mut blocks: Vec<B>, nodes: &mut [WideNode]) -> Vec<B> {
        let mut added = self.0.into_inner().expect("invariant: no thread panics with the lock");
        if added.is_empty() {
            return blocks;
        }
        // Stable, so that blocks of one index stay in order.
        added.par_sort_by_key(|&(index, _)| index);
        // The final index of each planned block: its own plus the number of additional blocks
        // before it.
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
            node.replace_children(|child| match child.is_leaf() {
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
