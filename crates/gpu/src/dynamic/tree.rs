//! A tree over boxes on the device.

use std::sync::Arc;

use super::sort::Sorter;
use super::{Plan, Start, THREADS, Update};
use crate::bvh::STACK;
use crate::device::{Buffer, Device, GpuError, Kernel};
use crate::renderer::Kernels;
use crate::shaders;

/// Bytes of a box: `Box` of `shaders/dynamic/box.wgsl`.
pub const BOX: u64 = 32;

/// The bits of a Morton code.
const CODE_BITS: u32 = 30;

/// Children of a node, levels of the binary tree that one has at least, and threads of a workgroup
/// and workgroups that make nodes.
const WIDTH: u32 = 8;
const LEVELS: u32 = 3;
const NODE_THREADS: u32 = 64;
const MOST_GROUPS: u32 = 1024;

/// The most items: all workgroups of a kernel are in one dimension, and the stack of a ray suffices
/// whatever the tree is.
pub const MOST_ITEMS: u32 = 1 << 22;

/// Where items or triangles, and nodes, are in their buffers.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// The number of items or triangles, two or more.
    pub count: u32,
    /// The first of them.
    pub first_item: u32,
    /// The first node, which is the root.
    pub first_node: u32,
    /// The bits of references to leaves.
    pub leaf_bits: u32,
    /// The entries of a ray's stack that a leaf needs.
    pub leaf_stack: u32,
}

/// The most nodes over so many items. Each has eight children, or leaves alone; of those there are
/// at most one more than seven for each other node, and they have two leaves at least.
pub fn most_nodes(count: u32) -> usize {
    count as usize * 4 / 7 + 2
}

/// The most levels of nodes. A path of the binary tree has a node for each bit of a code at most,
/// and then for each bit of the places of equal codes.
const fn most_levels(count: u32) -> u32 {
    (CODE_BITS + u32::BITS - (count - 1).leading_zeros()).div_ceil(LEVELS)
}

/// Whether the stack of a ray suffices for such a tree whose leaves need so many entries: it has
/// one for each node of a path. The roots that wait with that of items are traversed before it.
pub fn fits_stack(count: u32, leaf_stack: u32) -> bool {
    most_levels(count) + leaf_stack <= STACK as u32
}

// Beside those of a path, a ray's stack may have the entries of three roots.
const _: () = assert!(3 + most_levels(MOST_ITEMS) <= STACK as u32);

/// The tree, and what builds it.
pub struct Tree {
    place: Place,
    kernels: [Arc<Kernel>; 7],
    /// What kernels are told at each step.
    plans: Vec<Buffer>,
    sorter: Sorter,
    /// The leaves of the pyramid.
    leaves: u32,
    pyramid: Buffer,
    /// The nodes of the binary tree, and their boxes.
    inner: Buffer,
    bounds: Buffer,
    /// The children of nodes, and the number of nodes of each level.
    children: Buffer,
    levels: Buffer,
}

impl Tree {
    pub fn new(kernels: &Kernels, place: Place) -> Result<Self, GpuError> {
        let device = kernels.device();
        let Place { count, first_item, first_node, leaf_bits, leaf_stack } = place;
        let leaves = count.next_power_of_two().max(THREADS);
        let common = Plan { count, leaves, first_item, first_node, leaf_bits, leaf_stack, ..Plan::default() };
        let plan = |step| Plan { step, ..common };
        // The pyramid has fewer parts than the tree levels.
        let levels = most_levels(count);
        let plans = (0..levels).map(|step| device.parameters(&plan(step)));
        let get = |(name, source)| kernels.get(name, source);
        let compiled: Vec<_> = shaders::tree().into_iter().map(get).collect::<Result<_, _>>()?;
        let Ok(kernels_of_tree) = <[Arc<Kernel>; 7]>::try_from(compiled) else {
            return Err(GpuError::Invalid("a kernel of trees is missing".into()));
        };
        let inner = u64::from(count - 1);
        Ok(Self {
            place,
            kernels: kernels_of_tree,
            plans: plans.collect::<Result<_, _>>()?,
            sorter: Sorter::new(kernels, count)?,
            leaves,
            pyramid: device.zeros("boxes of the pyramid", 2 * BOX * u64::from(leaves))?,
            inner: device.zeros("nodes of the binary tree", 8 * inner)?,
            bounds: device.zeros("boxes of the binary tree", BOX * inner)?,
            children: device.zeros("children of nodes", u64::from(4 * WIDTH) * most_nodes(count) as u64)?,
            levels: device.zeros("levels of nodes", 4 * u64::from(levels + 1))?,
        })
    }

    /// Builds or refits it: nodes around the boxes of items, given the ends of their middles.
    pub fn run(
        &self,
        device: &Device,
        update: Update,
        [boxes, ends, nodes]: [&Buffer; 3],
        start: &mut Start,
    ) -> Result<(), GpuError> {
        let Self { place, sorter, pyramid, inner, bounds, children, levels, .. } = self;
        let [codes, split, leaves, join, bound, collapse, quantise] = &self.kernels;
        let plan = &self.plans[0];
        let groups = place.count.div_ceil(THREADS);
        let node_groups = (most_nodes(place.count) as u32).div_ceil(NODE_THREADS);
        let (keys, primitives) = (sorter.keys(), sorter.values());
        if update == Update::Rebuild {
            start(codes, &[plan, boxes, ends, keys, primitives], groups);
            sorter.run(start);
            start(split, &[plan, keys, inner], groups);
        }
        start(leaves, &[plan, primitives, boxes, pyramid], self.leaves / THREADS);
        let mut width = self.leaves;
        for plan in &self.plans {
            start(join, &[plan, pyramid], width.div_ceil(THREADS));
            width /= THREADS;
            if width < 2 {
                break;
            }
        }
        start(bound, &[plan, inner, pyramid, bounds], groups);
        if update == Update::Rebuild {
            // The first level is the root.
            let mut counts = vec![0u32; self.plans.len() + 1];
            counts[0] = 1;
            device.write(levels, &counts)?;
            device.write(children, &[0u32])?;
            let groups = node_groups.min(MOST_GROUPS);
            for plan in &self.plans {
                start(collapse, &[plan, inner, bounds, nodes, children, levels], groups);
            }
        }
        start(quantise, &[plan, primitives, pyramid, bounds, nodes, children, levels], node_groups);
        Ok(())
    }
}
