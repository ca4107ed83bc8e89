//! What stands together: triangles and spheres of sets in trees of packets, other shapes and
//! instances in a tree of single items, and whatever has no bounds in a list.

#![allow(unsafe_code)]

use super::numbers::Numbers;
use super::packet::{MeshTriangles, Packet};
use super::query::Query;
use super::spheres::Spheres;
use super::{Geometry, GeometryId, Hit, InstanceId, InstancePath, Placed, RayStats, World};
use crate::bvh::{BuildQuality, Bvh, Extent, Leaves, Primitives, Reference};
use crate::watertight::{Sheared, ShearedLanes};
use lanes::{Simd, Task};
use math::{Bounds3, Ray, gamma};
use std::collections::BTreeSet;
use std::ops::Range;

/// Everything in a group but its triangles.
#[derive(Clone, Copy, Debug)]
enum Item {
    Shape(GeometryId, u32),
    Instance(InstanceId),
}

/// A ray on its way through a group.
pub(super) struct Trace<'a> {
    pub world: &'a World,
    /// In the space of the group.
    pub ray: &'a Ray,
    /// Through which instances it came.
    pub instance: InstancePath,
    pub stats: &'a mut RayStats,
}

#[derive(Clone, Debug)]
pub(super) struct Group {
    triangles: Bvh,
    packets: Vec<Packet>,
    numbers: Numbers,
    spheres: Spheres,
    items: Bvh,
    /// In the order of the leaves of `items`.
    item_list: Vec<Item>,
    unbounded: Vec<Item>,
}

impl Group {
    pub fn build(
        members: &[GeometryId],
        geometries: &[Geometry],
        instances: &[(InstanceId, &Placed, &Group)],
        quality: BuildQuality,
    ) -> Self {
        let mut items = Vec::new();
        let mut unbounded = Vec::new();
        let mut add_item = |item, bounds: Bounds3| {
            if is_finite(&bounds) {
                items.push((item, bounds));
            }
        };
        for &id in members {
            match &geometries[id.0 as usize] {
                Geometry::Mesh(_) | Geometry::Spheres(_) => {}
                Geometry::Shapes(shapes) => {
                    for (i, shape) in shapes.iter().enumerate() {
                        let item = Item::Shape(id, i as u32);
                        match shape.bounds() {
                            Some(bounds) => add_item(item, bounds),
                            None => unbounded.push(item),
                        }
                    }
                }
                Geometry::Curves(curves) => {
                    for i in 0..curves.len() as u32 {
                        add_item(Item::Shape(id, i), curves.bounds(i));
                    }
                }
            }
        }
        for &(id, placed, group) in instances {
            if !group.bounds().is_empty() {
                add_item(Item::Instance(id), placed_bounds(placed, &group.bounds()));
            }
            if group.is_endless() {
                unbounded.push(Item::Instance(id));
            }
        }
        let numbers = Numbers::new(members, geometries);
        let (triangles, packets) = Bvh::build(&MeshTriangles::new(&numbers, geometries), quality);
        let (items, item_list) = Bvh::build(&BoundedItems(items), quality);
        let spheres = Spheres::build(members, geometries, quality);
        Self { triangles, packets, numbers, spheres, items, item_list, unbounded }
    }

    /// Brings triangles and sets of spheres up to date after they have moved, but leaves their
    /// trees as they are.
    pub fn refit_meshes_and_spheres(&mut self, geometries: &[Geometry]) {
        self.spheres.refit(geometries);
        let numbers = &self.numbers;
        let corners = |number| numbers.corners(number, geometries);
        self.triangles.refit(&mut self.packets, |packet| packet.renew(corners));
    }

    /// The same for all else. `placed_groups` begin with the first one below the top group.
    pub fn refit_items(&mut self, geometries: &[Geometry], instances: &[Placed], placed_groups: &[Group]) {
        self.items.refit(&mut self.item_list, |&mut item| {
            let bounds = match item {
                Item::Shape(id, primitive) => match &geometries[id.0 as usize] {
                    Geometry::Shapes(shapes) => shapes[primitive as usize].bounds(),
                    Geometry::Curves(curves) => Some(curves.bounds(primitive)),
                    Geometry::Mesh(_) | Geometry::Spheres(_) => None,
                },
                Item::Instance(id) => {
                    let placed = &instances[id.0 as usize];
                    let bounds = placed_groups[placed.group as usize - 1].bounds();
                    (!bounds.is_empty()).then(|| placed_bounds(placed, &bounds))
                }
            };
            bounds.filter(is_finite).unwrap_or(Bounds3::EMPTY)
        });
    }

    /// Whether anything in it has no end.
    pub fn is_endless(&self) -> bool {
        !self.unbounded.is_empty()
    }

    /// Whether other groups are placed in it.
    pub fn has_instances(&self) -> bool {
        self.item_list.iter().any(|item| matches!(item, Item::Instance(_)))
    }

    /// What is placed in it and can be hit, in the order of ids.
    pub fn instances(&self) -> BTreeSet<InstanceId> {
        let items = self.item_list.iter().chain(&self.unbounded);
        let instance = |item: &Item| match item {
            Item::Instance(id) => Some(*id),
            Item::Shape(..) => None,
        };
        items.filter_map(instance).collect()
    }

    /// Bytes of memory that the trees take.
    pub fn bytes(&self) -> usize {
        let packets = size_of_val(&*self.packets) + self.numbers.bytes();
        let items = size_of_val(&*self.item_list) + size_of_val(&*self.unbounded);
        self.triangles.bytes() + packets + self.spheres.bytes() + self.items.bytes() + items
    }

    /// A box around all that has bounds.
    pub fn bounds(&self) -> Bounds3 {
        self.triangles.bounds().union(self.spheres.tree.bounds()).union(self.items.bounds())
    }

    /// Shows hits to the query; whether it wants no more.
    pub fn trace<Q: Query>(&self, trace: &mut Trace, query: &mut Q) -> bool {
        if !goes_somewhere(trace.ray) {
            return false;
        }
        if !self.packets.is_empty() {
            let set = trace.world.instruction_set;
            // SAFETY: worlds are only given sets that the processor has.
            let (extents, primitives, stop) =
                unsafe { set.run(TraceTriangles { group: self, trace, query }) };
            trace.stats.extents += extents;
            trace.stats.primitives += primitives;
            if stop {
                return true;
            }
        }
        self.trace_others(trace, query)
    }

    /// Shows the query all hits but those of triangles; whether it wants no more.
    pub fn trace_others<Q: Query>(&self, trace: &mut Trace, query: &mut Q) -> bool {
        for &item in &self.unbounded {
            if trace.item(item, query) {
                return true;
            }
        }
        if self.spheres.trace(trace, query) {
            return true;
        }
        if self.item_list.is_empty() {
            return false;
        }
        let set = trace.world.instruction_set;
        // SAFETY: worlds are only given sets that the processor has.
        let (extents, stop) = unsafe { set.run(TraceItems { group: self, trace, query }) };
        trace.stats.extents += extents;
        stop
    }

    /// The triangles, as leaves hold them.
    pub fn packets(&self) -> &[Packet] {
        &self.packets
    }

    /// Whose triangles they are.
    pub fn numbers(&self) -> &Numbers {
        &self.numbers
    }

    /// The tree of triangles.
    pub fn triangles(&self) -> &Bvh {
        &self.triangles
    }
}

/// Whether a ray can hit anything: directions that are not finite, or too short to have an inverse,
/// lead nowhere.
pub(super) fn goes_somewhere(ray: &Ray) -> bool {
    ray.o.is_finite() && ray.d.is_finite() && ray.d.abs().max_element().recip().is_finite()
}

/// Whether a tree is best passed in order of distance.
#[inline(always)]
fn in_order<Q: Query>(t_max: f32) -> bool {
    !Q::ANY || t_max < f32::INFINITY
}

/// A ray on its way through the triangles of a group.
struct TraceTriangles<'a, 'b, Q> {
    group: &'a Group,
    trace: &'a Trace<'b>,
    query: &'a mut Q,
}

impl<Q: Query> Task for TraceTriangles<'_, '_, Q> {
    type Output = (u64, u64, bool);

    #[inline(always)]
    unsafe fn run<S: Simd>(self) -> Self::Output {
        let Self { group, trace, query } = self;
        let sheared = Sheared::new(trace.ray);
        // SAFETY: the caller promises the instructions.
        unsafe {
            let lanes = sheared.lanes::<{ Packet::VERTICES }, S::F32x8>();
            let mut t_max = query.t_max();
            let mut leaves = Triangles::<S, Q> {
                group,
                instance: trace.instance,
                sheared: &sheared,
                lanes: &lanes,
                query,
                primitives: 0,
            };
            let all = trace.all(group.packets.len());
            let (extents, stop) = visit::<S, Q>(&group.triangles, all, trace.ray, &mut t_max, &mut leaves);
            (extents, leaves.primitives, stop)
        }
    }
}

/// The triangles of a group before a ray.
pub(super) struct Triangles<'a, S: Simd, Q> {
    pub group: &'a Group,
    pub instance: InstancePath,
    pub sheared: &'a Sheared,
    pub lanes: &'a ShearedLanes<S::F32x8>,
    pub query: &'a mut Q,
    /// How many were tested.
    pub primitives: u64,
}

impl<S: Simd, Q: Query> Leaves for Triangles<'_, S, Q> {
    type Block = Packet;

    #[inline(always)]
    fn blocks(&self) -> &[Packet] {
        &self.group.packets
    }

    #[inline(always)]
    unsafe fn test(&mut self, blocks: Range<usize>, t_max: &mut f32) -> bool {
        // SAFETY: the tree was built over these packets.
        for packet in unsafe { self.group.packets.get_unchecked(blocks) } {
            self.primitives += Packet::WIDTH as u64;
            let Some(found) = packet.intersect::<S>(self.lanes, *t_max) else { continue };
            let mut hits = found.hits;
            while hits != 0 {
                let lane = hits.trailing_zeros() as usize % Packet::WIDTH;
                hits &= hits - 1;
                let (numbers, instance) = (&self.group.numbers, self.instance);
                let hit = packet.hit(lane, &found, lane, self.sheared, numbers, instance);
                let Some(hit) = hit else { continue };
                if self.query.offer(hit) {
                    return true;
                }
            }
            *t_max = self.query.t_max();
        }
        false
    }
}

/// A ray on its way through the items of a group.
struct TraceItems<'a, 'b, Q> {
    group: &'a Group,
    trace: &'a mut Trace<'b>,
    query: &'a mut Q,
}

impl<Q: Query> Task for TraceItems<'_, '_, Q> {
    type Output = (u64, bool);

    #[inline(always)]
    unsafe fn run<S: Simd>(self) -> Self::Output {
        let Self { group, trace, query } = self;
        let (ray, all) = (trace.ray, trace.all(group.item_list.len()));
        let mut t_max = query.t_max();
        let mut leaves = Items { group, trace, query };
        // SAFETY: the caller promises the instructions.
        unsafe { visit::<S, Q>(&group.items, all, ray, &mut t_max, &mut leaves) }
    }
}

struct Items<'a, 'b, Q> {
    group: &'a Group,
    trace: &'a mut Trace<'b>,
    query: &'a mut Q,
}

impl<Q: Query> Leaves for Items<'_, '_, Q> {
    type Block = Item;

    #[inline(always)]
    fn blocks(&self) -> &[Item] {
        &self.group.item_list
    }

    #[inline(always)]
    unsafe fn test(&mut self, blocks: Range<usize>, t_max: &mut f32) -> bool {
        for &item in &self.group.item_list[blocks] {
            if self.trace.item(item, self.query) {
                return true;
            }
        }
        *t_max = self.query.t_max();
        false
    }
}

/// Shows `leaves` the blocks of a tree that the ray may meet, or `all` without a look at the tree.
/// Returns the number of boxes tested, and whether `leaves` broke off.
///
/// # Safety
/// The blocks must be those of the tree, and the processor must have the instructions of the set.
#[inline(always)]
pub(super) unsafe fn visit<S: Simd, Q: Query>(
    tree: &Bvh,
    all: Option<Range<usize>>,
    ray: &Ray,
    t_max: &mut f32,
    leaves: &mut impl Leaves,
) -> (u64, bool) {
    // SAFETY: the caller promises the blocks and the instructions.
    unsafe {
        match all {
            Some(blocks) => (0, leaves.test(blocks, t_max)),
            None if in_order::<Q>(*t_max) => tree.traverse::<S, false>(ray, t_max, leaves),
            None => tree.traverse::<S, true>(ray, t_max, leaves),
        }
    }
}

impl Trace<'_> {
    /// All of so many blocks, where rays are not tested against extents.
    pub fn all(&self, blocks: usize) -> Option<Range<usize>> {
        (!self.world.extents).then_some(0..blocks)
    }

    #[inline(never)]
    fn item<Q: Query>(&mut self, item: Item, query: &mut Q) -> bool {
        match item {
            Item::Shape(geometry, primitive) => {
                self.stats.primitives += 1;
                let hit = match self.world.geometry(geometry) {
                    Geometry::Shapes(shapes) => shapes[primitive as usize].intersect(self.ray, query.end()),
                    Geometry::Curves(curves) => curves.intersect(primitive, self.ray, query.end()),
                    Geometry::Mesh(_) | Geometry::Spheres(_) => None,
                };
                hit.is_some_and(|hit| {
                    query.offer(Hit { t: hit.t, uv: hit.uv, geometry, primitive, instance: self.instance })
                })
            }
            Item::Instance(id) => {
                let placed = &self.world.instances[id.0 as usize];
                let ray = placed.with_placement(self.ray.time, |placement| placement.ray(self.ray));
                let instance = self.instance.into(id);
                let mut inner = Trace { world: self.world, ray: &ray, instance, stats: &mut *self.stats };
                self.world.groups[placed.group as usize].trace(&mut inner, query)
            }
        }
    }
}

fn is_finite(bounds: &Bounds3) -> bool {
    bounds.min.is_finite() && bounds.max.is_finite()
}

/// A box around all places of a group, with room for the rounding of what is placed.
fn placed_bounds(placed: &Placed, bounds: &Bounds3) -> Bounds3 {
    let moved = placed.motion.motion_bounds(bounds);
    moved.expand(moved.min.abs().max(moved.max.abs()).max_element() * gamma(8))
}

/// What has a box of its own.
struct BoundedItems(Vec<(Item, Bounds3)>);

impl Primitives for BoundedItems {
    type Block = Item;
    const COST: f32 = 4.0;

    fn width(&self) -> usize {
        1
    }

    fn geometries(&self) -> Vec<(u32, usize)> {
        vec![(0, self.0.len())]
    }

    fn extent(&self, _: u32, item: u32) -> Option<Extent> {
        Some(Extent::from(&self.0[item as usize].1))
    }

    fn block(&self, items: &[Reference]) -> (Item, usize, Extent) {
        let (item, bounds) = &self.0[items[0].primitive() as usize];
        (*item, 1, bounds.into())
    }
}
