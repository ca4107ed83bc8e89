//! What moves: spheres of sets, vertices of meshes, and instances, all of the top group.
//!
//! Kernels write the items and triangles that have moved, with their boxes: those of spheres from
//! centres, those of triangles from vertices ([`points`]), those of instances from transforms
//! ([`instances`]). Over the items and over the triangles ([`part`]) there are trees that the GPU
//! builds for each picture.
//!
//! The order of Morton codes puts near what is near ([`sort`]). Over that order there is one binary
//! tree whose nodes have the codes with common leading bits, and each of its nodes is found without
//! the others [Lauterbach 2009] [Karras 2012] ([`tree`]). Nodes of eight children are made of it,
//! those of [`Bvh`](crate::Bvh), so that every kernel traces rays through them.
//!
//! No thread waits for another one of its dispatch, and none reads what another one of it has
//! written, but for counters: WGSL promises neither that workgroups run at once nor that they see
//! what others write. Boxes of nodes are usually found bottom up, by threads that meet. Here a node
//! is a range of the order, and a pyramid of boxes has that of any range.
//!
//! A refitted tree has the nodes of the last one built, around what has moved.

mod error;
mod instances;
mod moving;
mod part;
mod points;
mod sort;
mod tree;

pub use error::MovingError;
pub use moving::Moving;
pub use sort::Sorter;

use crate::device::{Buffer, Kernel};
use crate::records::record;

/// Starts a kernel on buffers, in a number of workgroups.
pub type Start<'a> = dyn FnMut(&Kernel, &[&Buffer], u32) + 'a;

/// How a tree follows what moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Update {
    /// It is built anew.
    Rebuild,
    /// Its boxes grow and shrink; rays take longer the further neighbours have moved apart.
    Refit,
}

/// The threads of a workgroup, but for nodes of eight children.
const THREADS: u32 = 256;

record! {
    /// Where an item is, from the first on.
    pub(crate) struct Placement {
        rows: [[u32; 4]; 3],
        low: [f32; 3],
        item: u32,
        high: [f32; 3],
        unused: u32,
    }
}

record! {
    /// Arguments of the kernels that build a tree.
    pub(crate) struct Plan {
        /// Primitives, and the leaves of the pyramid: a power of two.
        count: u32,
        leaves: u32,
        /// The index of the run of a kernel: the digit that is sorted by, from the lowest on;
        /// the part of the pyramid, from its base on; the level of nodes, from the root on.
        step: u32,
        /// Blocks of keys.
        blocks: u32,
        /// The first of the items or triangles, and of the nodes.
        first_item: u32,
        first_node: u32,
        /// The bits of references to leaves, and the entries of a ray's stack that a leaf needs.
        leaf_bits: u32,
        leaf_stack: u32,
    }
}
