//! The trees of a world as buffers for kernels.
//!
//! [`binary`] takes the sixteen-wide nodes of the CPU's trees apart into binary ones, [`node`]
//! collapses these into nodes of eight children, whose boxes are quantised to eight bits a plane.
//! Quantised boxes contain the exact ones. `shaders/trace.wgsl` traverses them.
//!
//! A reference to a child or root is a node's index, or a leaf: a range of triangles or instances.

mod binary;
mod node;

use binary::Binary;
use geometry::{GroupId, PlainTree, World};
use math::Bounds3;
use node::Writer;

/// The entries of the stack of `shaders/trace.wgsl`.
const STACK: usize = 128;

/// Four words of a buffer.
pub type Words = [u32; 4];

/// The trees and triangles of a world.
#[derive(Clone, Debug, Default)]
pub struct Bvh {
    /// Six quadruples for each node.
    pub nodes: Vec<Words>,
    /// Three quadruples for each triangle: a corner each, with the geometry, the primitive and 0.
    pub triangles: Vec<Words>,
    /// Four quadruples for each instance: the rows of the matrix that takes rays inside, and the
    /// reference of its triangles, its id, the size of its group, and 0.
    pub instances: Vec<Words>,
    /// Where rays begin.
    pub top: Top,
}

/// Where rays begin.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::NoUninit)]
pub struct Top {
    /// The references of the triangles and of the instances of the top group.
    pub roots: [u32; 2],
    /// The largest coordinate of any box of the top group.
    pub size: f32,
    /// Fills up the words.
    pub unused: u32,
}

/// Why a world has no buffers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BvhError {
    /// A group has primitives other than triangles.
    Shapes,
    /// Instances are nested.
    Nested,
    /// An instance moves.
    Moving,
    /// A tree is too deep for the stack of rays, or has too many triangles for references.
    TooLarge,
}

impl Bvh {
    /// The buffers of a world of triangles and of instances of groups of triangles, at rest.
    pub fn new(world: &World) -> Result<Self, BvhError> {
        let mut bvh = Self::default();
        let groups = (0..world.groups() as u32).map(GroupId);
        let (mut roots, mut sizes) = (Vec::new(), Vec::new());
        let mut depth = 0;
        for group in groups {
            let (tree, triangles) = world.triangle_tree(group);
            sizes.push(largest_coordinate(&tree));
            let mut writer = Writer::new(&mut bvh.nodes, node::TRIANGLES, bvh.triangles.len() / 3);
            roots.push(writer.root(&Binary::new(&tree)).ok_or(BvhError::TooLarge)?);
            depth = depth.max(writer.stack);
            for triangle in triangles {
                let ids = [triangle.geometry.0, triangle.primitive, 0];
                let corners = triangle.corners.iter().zip(ids);
                bvh.triangles
                    .extend(corners.map(|(p, id)| [p.x.to_bits(), p.y.to_bits(), p.z.to_bits(), id]));
            }
            let (_, instances) = world.instance_tree(group).ok_or(BvhError::Shapes)?;
            if group != GroupId::TOP && !instances.is_empty() {
                return Err(BvhError::Nested);
            }
        }
        let (tree, instances) = world.instance_tree(GroupId::TOP).ok_or(BvhError::Shapes)?;
        let mut writer = Writer::new(&mut bvh.nodes, node::INSTANCES, 0);
        let instance_root = writer.root(&Binary::new(&tree)).ok_or(BvhError::TooLarge)?;
        let size = sizes[0].max(largest_coordinate(&tree));
        bvh.top = Top { roots: [roots[0], instance_root], size, unused: 0 };
        depth += writer.stack;
        for id in instances {
            let motion = world.render_from_instance(id);
            if motion.is_moving() {
                return Err(BvhError::Moving);
            }
            let inverse = motion.start().matrix().as_dmat4().inverse();
            bvh.instances
                .extend([0, 1, 2].map(|row| inverse.row(row).as_vec4().to_array().map(f32::to_bits)));
            let group = world.group_of_instance(id).0 as usize;
            bvh.instances.push([roots[group], id.0, sizes[group].to_bits(), 0]);
        }
        // Other roots and instances wait, too.
        if depth + 2 > STACK { Err(BvhError::TooLarge) } else { Ok(bvh) }
    }
}

/// The largest coordinate of a tree's boxes.
fn largest_coordinate(tree: &PlainTree) -> f32 {
    let children = tree.nodes.first().into_iter().flatten();
    let largest = |bounds: &Bounds3| bounds.min.abs().max(bounds.max.abs()).max_element();
    children.map(|child| largest(&child.bounds)).fold(0.0, f32::max)
}
