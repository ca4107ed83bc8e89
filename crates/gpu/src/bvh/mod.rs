//! The trees of a world as buffers for kernels.
//!
//! [`binary`] takes the sixteen-wide nodes of the CPU's trees apart into binary ones and divides
//! their leaves, [`node`] collapses these into nodes of eight children, whose boxes are quantised
//! to eight bits a plane. Quantised boxes contain the exact ones. A group has a tree of triangles
//! and one of items, which are instances and single shapes ([`item`]). `shaders/trace.wgsl`
//! traverses them. [`ray_queries`] has the same for ray queries, whose trees are the driver's.
//!
//! A reference to a child or root is a node's index, or a leaf: a range of triangles or items.

mod binary;
mod item;
mod node;
mod paths;
mod placed;
mod ray_queries;

use std::ops::Range;

use binary::Binary;
use geometry::{GeometryId, GroupId, InstanceId, InstancePath, PlainItem, PlainTriangle, World};
use item::Item;
pub(crate) use item::angle;
use math::Bounds3;
use node::Writer;

use crate::records::record;
pub(crate) use node::{ITEMS, TRIANGLES};
pub(crate) use placed::Placed;
pub(crate) use ray_queries::{MOST as MAX_FOR_RAY_QUERIES, Plan};

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
    /// whether it is marked.
    pub triangles: Vec<Words>,
    /// Five quadruples for each instance or shape.
    pub items: Vec<Words>,
    /// Where rays begin.
    pub top: Top,
    /// Whether any instance moves.
    pub has_motion: bool,
    /// The instances, also those within others, with the index of the item of each.
    pub(crate) instances: Vec<(InstancePath, u32)>,
    /// The triangles of the top group, and its items that have bounds.
    pub(crate) triangles_of_top: Range<usize>,
    pub(crate) bounded: Range<usize>,
    groups: Vec<Group>,
    /// What ray queries are traced through instead of nodes.
    pub(crate) plan: Option<Plan>,
}

record! {
    /// Where rays begin.
    pub struct Top {
        /// The references of the triangles and of the items of the top group.
        roots: [u32; 2],
        /// The reference of a leaf of its items without bounds.
        unbounded: u32,
        /// The largest coordinate of any box of the top group.
        size: f32,
    }
}

/// Why a world has no buffers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BvhError {
    /// A geometry has a shape that kernels do not intersect.
    Shape(GeometryId),
    /// An instance is one of too many within others.
    Nested(InstanceId),
    /// An instanced geometry has no bounds.
    Unbounded(GeometryId),
    /// A tree is too deep for the stack of rays, or has too many primitives for references.
    TooLarge,
}

impl Bvh {
    /// The buffers of a world of meshes, single shapes, sets of spheres, and instances of groups of
    /// them. Hits on geometries that are marked count if the kernel's `accepts` says so.
    pub fn new(world: &World, is_marked: &dyn Fn(GeometryId) -> bool) -> Result<Self, BvhError> {
        let mut bvh = Self::default();
        let mut groups = vec![Group::EMPTY; world.groups()];
        // The instances of the top group refer to all others.
        for group in (0..world.groups() as u32).rev().map(GroupId) {
            groups[group.0 as usize] = bvh.add_group(world, group, &groups, is_marked)?;
        }
        let Group { roots, unbounded, size, stack, .. } = groups[0];
        bvh.top = Top { roots, unbounded, size };
        bvh.groups = groups;
        if stack > STACK { Err(BvhError::TooLarge) } else { Ok(bvh) }
    }

    /// Adds a group, given those that its instances may place.
    fn add_group(
        &mut self,
        world: &World,
        group: GroupId,
        groups: &[Group],
        is_marked: &dyn Fn(GeometryId) -> bool,
    ) -> Result<Group, BvhError> {
        let (tree, mut triangles) = world.triangle_tree(group);
        let first = self.triangles.len() / 3;
        self.triangles_of_top = first..first + triangles.len();
        let mut writer = Writer::new(&mut self.nodes, node::TRIANGLES, first, 0);
        let tree = Binary::new(&tree, &mut triangles, |it| Some(Bounds3::around(it.corners)));
        let root = writer.root(&tree).ok_or(BvhError::TooLarge)?;
        let (of_triangles, mut bounds) = (writer.stack, tree.bounds());
        self.add_triangles(triangles, is_marked);
        let (tree, all, unbounded) = world.item_tree(group);
        let instances: Vec<InstanceId> = all.iter().filter_map(instance).collect();
        let (tree, mut items) = if is_flat(world, group, &instances, groups) {
            let mut items: Vec<Item> = all.iter().map(Item::from).collect();
            (Binary::new(&tree, &mut items, |item| item.bounds(world)), items)
        } else {
            let mut boxed = paths::items(world, group, &all, groups)?;
            (Binary::over(&mut boxed), boxed.into_iter().map(|(_, item)| item).collect())
        };
        let (spheres, more) = world.sphere_tree(group);
        let mut more: Vec<Item> = more.iter().map(Item::from).collect();
        let spheres = Binary::new(&spheres, &mut more, |item| item.bounds(world));
        let tree = tree.and(&spheres, items.len());
        items.extend(more);
        bounds = bounds.union(tree.bounds());
        let first = self.items.len() / item::QUADRUPLES;
        // A ray within an instance has the two roots there on its stack, and the rest of the leaf
        // waits.
        let inner = if group == GroupId::TOP { &groups[1..] } else { &[] };
        let of_leaf = inner.iter().map(|group| group.stack).max().unwrap_or(0);
        let mut writer = Writer::new(&mut self.nodes, node::ITEMS, first, of_leaf);
        let item_root = writer.root(&tree).ok_or(BvhError::TooLarge)?;
        // Three roots wait together.
        let stack = 3 + of_triangles.max(writer.stack);
        self.bounded = first..first + items.len();
        // Instances without bounds are refused where their group is.
        let unbounded: Vec<&PlainItem> = unbounded.iter().filter(|item| instance(item).is_none()).collect();
        let open = node::leaf(node::ITEMS, first + items.len(), unbounded.len()).ok_or(BvhError::TooLarge)?;
        if let (Some(PlainItem::Shape(geometry, _)), true) = (unbounded.first(), group != GroupId::TOP) {
            return Err(BvhError::Unbounded(*geometry));
        }
        items.extend(unbounded.into_iter().map(Item::from));
        self.add_items(world, items, groups, is_marked)?;
        let size = largest_coordinate(&bounds);
        Ok(Group { roots: [root, item_root], unbounded: open, size, bounds, instances, stack })
    }

    fn add_triangles(&mut self, triangles: Vec<PlainTriangle>, is_marked: &dyn Fn(GeometryId) -> bool) {
        for triangle in triangles {
            let ids = [triangle.geometry.0, triangle.primitive, is_marked(triangle.geometry).into()];
            let corners = triangle.corners.iter().zip(ids);
            self.triangles.extend(corners.map(|(p, id)| [p.x.to_bits(), p.y.to_bits(), p.z.to_bits(), id]));
        }
    }

    /// Adds items, and after them the keys of those that move.
    fn add_items(
        &mut self,
        world: &World,
        items: Vec<Item>,
        groups: &[Group],
        is_marked: &dyn Fn(GeometryId) -> bool,
    ) -> Result<(), BvhError> {
        let mut keys = Vec::new();
        let first_key = self.items.len() / item::QUADRUPLES + items.len();
        for item in items {
            let words = match item {
                Item::Shape(geometry, primitive) => {
                    item::shape(world, geometry, primitive, is_marked(geometry))?
                }
                Item::Instance(path) => {
                    let at = (first_key + keys.len()) as u32;
                    let motions = item::motions(world, &path);
                    keys.extend(motions.iter().flat_map(item::keys));
                    self.instances.push((path, (self.items.len() / item::QUADRUPLES) as u32));
                    item::instance(world, &path, groups, [at, motions.len() as u32])
                }
            };
            self.items.extend(words);
        }
        self.has_motion |= !keys.is_empty();
        self.items.extend(keys.into_iter().flatten());
        Ok(())
    }

    /// Says which light is the first of the shapes in an instance.
    pub(crate) fn set_first_light(&mut self, item: u32, light: u32) {
        self.items[item::QUADRUPLES * item as usize + item::QUADRUPLES - 1][3] = light;
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
        if !node::is_leaf(root) {
            self.nodes.truncate(6 * root as usize);
        }
        self.top.roots[1] = self.add_room(nodes);
        self.top.roots[1]
    }

    /// Room for another tree, of at most so many nodes. The index of its root.
    pub(crate) fn add_room(&mut self, nodes: usize) -> u32 {
        let first = self.nodes.len() / 6;
        self.nodes.resize(6 * (first + nodes), [0; 4]);
        first as u32
    }

    /// The entries of the stack that a ray needs within any instance. It begins there with both
    /// roots, of which that of items is the last.
    pub(crate) fn stack_within(&self) -> u32 {
        let placed = if self.instances.is_empty() { &[] } else { &self.groups[1..] };
        placed.iter().map(|group| group.stack.saturating_sub(2).max(2)).max().unwrap_or(0) as u32
    }
}

/// A group in the buffers.
#[derive(Clone, Debug)]
struct Group {
    /// The references of its triangles and of its items.
    roots: [u32; 2],
    /// That of its items without bounds.
    unbounded: u32,
    /// The largest coordinate of its boxes.
    size: f32,
    /// The box of what is in the buffers: instances within it are items of the top group.
    bounds: Bounds3,
    /// Its instances.
    instances: Vec<InstanceId>,
    /// The entries that a ray's stack needs within it.
    stack: usize,
}

impl Group {
    /// Nothing.
    const EMPTY: Self = Self {
        roots: [node::EMPTY; 2],
        unbounded: node::EMPTY,
        size: 0.0,
        bounds: Bounds3::EMPTY,
        instances: Vec::new(),
        stack: 0,
    };
}

/// Whether the items of a group are those of the CPU: shapes, and instances of shapes in the top
/// group.
fn is_flat(world: &World, group: GroupId, instances: &[InstanceId], groups: &[Group]) -> bool {
    let places_shapes = |&id: &InstanceId| {
        let placed = world.group_of_instance(id).0 as usize;
        group == GroupId::TOP && groups[placed].instances.is_empty()
    };
    instances.iter().all(places_shapes)
}

fn instance(item: &PlainItem) -> Option<InstanceId> {
    match *item {
        PlainItem::Shape(..) => None,
        PlainItem::Instance(id) => Some(id),
    }
}

/// The largest coordinate of a box; 0 of an empty one.
fn largest_coordinate(bounds: &Bounds3) -> f32 {
    if bounds.is_empty() { 0.0 } else { bounds.min.abs().max(bounds.max.abs()).max_element() }
}
