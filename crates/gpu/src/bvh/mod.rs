//! The trees of a world as buffers for kernels.
//!
//! [`binary`] takes the sixteen-wide nodes of the CPU's trees apart into binary ones and divides
//! their leaves, [`node`] collapses these into nodes of eight children, whose boxes are quantised
//! to eight bits a plane. Quantised boxes contain the exact ones. A group has a tree of triangles
//! and one of items, which are instances and single shapes ([`item`]). `shaders/trace.wgsl`
//! traverses them.
//!
//! A reference to a child or root is a node's index, or a leaf: a range of triangles or items.

mod binary;
mod item;
mod node;

use std::ops::Range;

use binary::Binary;
use geometry::{GeometryId, GroupId, InstanceId, PlainItem, PlainTree, World};
pub(crate) use item::angle;
use math::Bounds3;
use node::Writer;

/// The entries of the stack of `shaders/trace.wgsl`.
pub(crate) const STACK: usize = 24;

/// How many bits of a leaf's reference are the number of its primitives.
const COUNT_BITS: u32 = 5;

/// The most primitives of a leaf, which a ray tests one after another.
const MOST_PRIMITIVES: usize = 2;

/// Four words of a buffer.
pub type Words = [u32; 4];

/// The trees, triangles, shapes and instances of a world.
#[derive(Clone, Debug, Default)]
pub struct Bvh {
    /// Six quadruples for each node.
    pub nodes: Vec<Words>,
    /// Three quadruples for each triangle: a corner each, with the geometry, the primitive and
    /// whether it is cut out.
    pub triangles: Vec<Words>,
    /// Five quadruples for each instance or shape.
    pub items: Vec<Words>,
    /// Where rays begin.
    pub top: Top,
    /// Whether any instance moves.
    pub has_motion: bool,
    /// The items of the top group that have bounds.
    pub(crate) bounded: Range<usize>,
}

/// Where rays begin.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::NoUninit)]
pub struct Top {
    /// The references of the triangles and of the items of the top group.
    pub roots: [u32; 2],
    /// The reference of a leaf of its items without bounds.
    pub unbounded: u32,
    /// The largest coordinate of any box of the top group.
    pub size: f32,
}

/// Why a world has no buffers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BvhError {
    /// A geometry has a shape that kernels do not intersect.
    Shape(GeometryId),
    /// An instance is within another.
    Nested(InstanceId),
    /// An instanced geometry has no bounds.
    Unbounded(GeometryId),
    /// A tree is too deep for the stack of rays, or has too many primitives for references.
    TooLarge,
}

impl Bvh {
    /// The buffers of a world of meshes, single shapes, sets of spheres, and instances of groups of
    /// them. Hits on geometries that are cut out count if the kernel's `accepts` says so.
    pub fn new(world: &World, is_cut_out: &dyn Fn(GeometryId) -> bool) -> Result<Self, BvhError> {
        let mut bvh = Self::default();
        let mut groups = vec![Group::default(); world.groups()];
        // The instances of the top group refer to all others.
        for group in (0..world.groups() as u32).rev().map(GroupId) {
            groups[group.0 as usize] = bvh.add_group(world, group, &groups, is_cut_out)?;
        }
        let Group { roots, unbounded, size, stack } = groups[0];
        bvh.top = Top { roots, unbounded, size };
        if stack > STACK { Err(BvhError::TooLarge) } else { Ok(bvh) }
    }

    /// Adds a group, given those that its instances may place.
    fn add_group(
        &mut self,
        world: &World,
        group: GroupId,
        groups: &[Group],
        is_cut_out: &dyn Fn(GeometryId) -> bool,
    ) -> Result<Group, BvhError> {
        let (tree, mut triangles) = world.triangle_tree(group);
        let mut size = largest_coordinate(&tree);
        let mut writer = Writer::new(&mut self.nodes, node::TRIANGLES, self.triangles.len() / 3, 0);
        let tree = Binary::new(&tree, &mut triangles, |it| Some(Bounds3::around(it.corners)));
        let root = writer.root(&tree).ok_or(BvhError::TooLarge)?;
        let of_triangles = writer.stack;
        for triangle in triangles {
            let ids = [triangle.geometry.0, triangle.primitive, is_cut_out(triangle.geometry).into()];
            let corners = triangle.corners.iter().zip(ids);
            self.triangles.extend(corners.map(|(p, id)| [p.x.to_bits(), p.y.to_bits(), p.z.to_bits(), id]));
        }
        let (tree, mut items, unbounded) = world.item_tree(group);
        let (spheres, mut more) = world.sphere_tree(group);
        size = size.max(largest_coordinate(&tree)).max(largest_coordinate(&spheres));
        let bounds = |item: &PlainItem| match *item {
            PlainItem::Shape(geometry, primitive) => world.geometry(geometry).bounds(primitive),
            PlainItem::Instance(_) => None,
        };
        let tree = Binary::new(&tree, &mut items, bounds);
        let tree = tree.and(&Binary::new(&spheres, &mut more, bounds), items.len());
        items.extend(more);
        let first = self.items.len() / item::QUADRUPLES;
        // A ray within an instance has the two roots there on its stack, and the rest of the leaf
        // waits.
        let instances = if group == GroupId::TOP { &groups[1..] } else { &[] };
        let of_leaf = instances.iter().map(|group| group.stack).max().unwrap_or(0);
        let mut writer = Writer::new(&mut self.nodes, node::ITEMS, first, of_leaf);
        let item_root = writer.root(&tree).ok_or(BvhError::TooLarge)?;
        // Three roots wait together.
        let stack = 3 + of_triangles.max(writer.stack);
        self.bounded = first..first + items.len();
        let open = node::leaf(node::ITEMS, first + items.len(), unbounded.len()).ok_or(BvhError::TooLarge)?;
        if let (Some(&item), true) = (unbounded.first(), group != GroupId::TOP) {
            return Err(match item {
                PlainItem::Shape(geometry, _) => BvhError::Unbounded(geometry),
                PlainItem::Instance(id) => BvhError::Nested(id),
            });
        }
        let mut keys = Vec::new();
        let first_key = first + items.len() + unbounded.len();
        for item in items.into_iter().chain(unbounded) {
            self.items.extend(match item {
                PlainItem::Shape(geometry, primitive) => {
                    item::shape(world, geometry, primitive, is_cut_out(geometry))?
                }
                PlainItem::Instance(id) if group != GroupId::TOP => return Err(BvhError::Nested(id)),
                PlainItem::Instance(id) => {
                    let mut at = 0;
                    if let Some(moves) = world.render_from_instance(id).keys() {
                        at = (first_key + keys.len()) as u32;
                        keys.extend(item::motion(&moves));
                    }
                    item::instance(world, id, groups, at)
                }
            });
        }
        self.has_motion |= !keys.is_empty();
        self.items.extend(keys.into_iter().flatten());
        Ok(Group { roots: [root, item_root], unbounded: open, size, stack })
    }

    /// The geometry and the primitive of an item; `None` for an instance.
    pub(crate) fn shape(&self, item: usize) -> Option<(GeometryId, u32)> {
        item::ids(&self.items[item::QUADRUPLES * item..])
    }

    /// Replaces the tree of the top group's items by room for another one, of at most so many
    /// nodes. The index of its root.
    pub(crate) fn make_room(&mut self, nodes: usize) -> u32 {
        // It was the last tree that was written, its root first.
        let [_, root] = self.top.roots;
        let first = if node::is_leaf(root) { self.nodes.len() / 6 } else { root as usize };
        self.nodes.truncate(6 * first);
        self.nodes.resize(6 * (first + nodes), [0; 4]);
        self.top.roots[1] = first as u32;
        first as u32
    }
}

/// A group in the buffers.
#[derive(Clone, Copy, Debug, Default)]
struct Group {
    /// The references of its triangles and of its items.
    roots: [u32; 2],
    /// That of its items without bounds.
    unbounded: u32,
    /// The largest coordinate of its boxes.
    size: f32,
    /// The entries that a ray's stack needs within it.
    stack: usize,
}

/// The largest coordinate of a tree's boxes.
fn largest_coordinate(tree: &PlainTree) -> f32 {
    let children = tree.nodes.first().into_iter().flatten();
    let largest = |bounds: &Bounds3| bounds.min.abs().max(bounds.max.abs()).max_element();
    children.map(|child| largest(&child.bounds)).fold(0.0, f32::max)
}
