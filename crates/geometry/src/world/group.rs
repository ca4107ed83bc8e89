//! What stands together: triangles in a tree of packets, other shapes and instances in a tree of single
//! items, and whatever has no bounds in a list.

#![allow(unsafe_code)]

use super::packet::Packet;
use super::query::Query;
use super::{Geometry, GeometryId, Hit, InstanceId, Placed, RayStats, World};
use crate::bvh::{Bvh, Leaves, Primitive};
use crate::simd::{Simd, Task, Vector};
use crate::watertight::{Sheared, ShearedLanes};
use math::{Bounds3, Ray, Vec2, gamma};
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
    /// Through which instance it came.
    pub instance: Option<InstanceId>,
    pub stats: &'a mut RayStats,
}

#[derive(Clone, Debug)]
pub(super) struct Group {
    triangles: Bvh,
    packets: Vec<Packet>,
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
    ) -> Self {
        let mut triangles = Vec::new();
        let mut ids = Vec::new();
        let mut items = Vec::new();
        let mut unbounded = Vec::new();
        let mut boxes = Vec::new();
        let mut add_item = |item, bounds: Bounds3| {
            if is_finite(&bounds) {
                boxes.push(Primitive { bounds, index: items.len() as u32 });
                items.push(item);
            }
        };
        for &id in members {
            match &geometries[id.0 as usize] {
                Geometry::Mesh(mesh) => {
                    for i in 0..mesh.len() {
                        let bounds = Bounds3::around(mesh.corners(i));
                        if mesh.corners(i).iter().all(|p| p.is_finite()) {
                            triangles.push(Primitive { bounds, index: ids.len() as u32 });
                            ids.push((id.0, i as u32));
                        }
                    }
                }
                Geometry::Shapes(shapes) => {
                    for (i, shape) in shapes.iter().enumerate() {
                        let item = Item::Shape(id, i as u32);
                        match shape.bounds() {
                            Some(bounds) => add_item(item, bounds),
                            None => unbounded.push(item),
                        }
                    }
                }
            }
        }
        for &(id, placed, group) in instances {
            if !group.bounds().is_empty() {
                add_item(Item::Instance(id), placed_bounds(placed, &group.bounds()));
            }
            if !group.unbounded.is_empty() {
                unbounded.push(Item::Instance(id));
            }
        }
        let triangles = Bvh::build(triangles, Packet::WIDTH);
        let packets = pack(&triangles, &ids, geometries);
        let boxes = Bvh::build(boxes, 1);
        let item_list = boxes.order().iter().flatten().map(|&i| items[i as usize]).collect();
        Self { triangles, packets, items: boxes, item_list, unbounded }
    }

    /// A box around all that has bounds.
    pub fn bounds(&self) -> Bounds3 {
        self.triangles.bounds().union(self.items.bounds())
    }

    /// Shows hits to the query; whether it wants no more.
    pub fn trace<Q: Query>(&self, trace: &mut Trace, query: &mut Q) -> bool {
        // Finite directions too short to have an inverse go nowhere.
        if !(trace.ray.o.is_finite()
            && trace.ray.d.is_finite()
            && trace.ray.d.abs().max_element().recip().is_finite())
        {
            return false;
        }
        for &item in &self.unbounded {
            if trace.item(item, query) {
                return true;
            }
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
        if !self.item_list.is_empty() {
            let set = trace.world.instruction_set;
            // SAFETY: worlds are only given sets that the processor has.
            let (extents, stop) = unsafe { set.run(TraceItems { group: self, trace, query }) };
            trace.stats.extents += extents;
            return stop;
        }
        false
    }
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
            let lanes = sheared.lanes::<{ Packet::WIDTH }, S::Four>();
            let mut t_max = query.t_max();
            let mut leaves =
                Triangles { group, instance: trace.instance, sheared: &sheared, lanes, query, primitives: 0 };
            let (extents, stop) = if Q::ANY {
                group.triangles.traverse::<S, true>(trace.ray, &mut t_max, &mut leaves)
            } else {
                group.triangles.traverse::<S, false>(trace.ray, &mut t_max, &mut leaves)
            };
            (extents, leaves.primitives, stop)
        }
    }
}

struct Triangles<'a, V, Q> {
    group: &'a Group,
    instance: Option<InstanceId>,
    sheared: &'a Sheared,
    lanes: ShearedLanes<V>,
    query: &'a mut Q,
    primitives: u64,
}

impl<V: Vector<{ Packet::WIDTH }>, Q: Query> Leaves for Triangles<'_, V, Q> {
    #[inline(always)]
    unsafe fn test(&mut self, blocks: Range<usize>, t_max: &mut f32) -> bool {
        // SAFETY: the tree was built over these packets.
        for packet in unsafe { self.group.packets.get_unchecked(blocks) } {
            self.primitives += packet.len() as u64;
            let Some(found) = packet.intersect(&self.lanes, *t_max) else { continue };
            let mut hits = found.hits;
            while hits != 0 {
                let lane = hits.trailing_zeros() as usize % Packet::WIDTH;
                hits &= hits - 1;
                let (mut t, mut uv) = (found.t[lane], Vec2::new(found.b1[lane], found.b2[lane]));
                if found.doubts >> lane & 1 != 0 {
                    let Some(decided) = self.sheared.decide(&packet.triangle(lane)) else { continue };
                    (t, uv) = decided;
                }
                let (geometry, primitive) = packet.id(lane);
                let geometry = GeometryId(geometry);
                if self.query.offer(Hit { t, uv, geometry, primitive, instance: self.instance }) {
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
        let ray = trace.ray;
        let mut t_max = query.t_max();
        let mut leaves = Items { group, trace, query };
        // SAFETY: the caller promises the instructions.
        unsafe {
            if Q::ANY {
                group.items.traverse::<S, true>(ray, &mut t_max, &mut leaves)
            } else {
                group.items.traverse::<S, false>(ray, &mut t_max, &mut leaves)
            }
        }
    }
}

struct Items<'a, 'b, Q> {
    group: &'a Group,
    trace: &'a mut Trace<'b>,
    query: &'a mut Q,
}

impl<Q: Query> Leaves for Items<'_, '_, Q> {
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

impl Trace<'_> {
    #[inline(never)]
    fn item<Q: Query>(&mut self, item: Item, query: &mut Q) -> bool {
        match item {
            Item::Shape(geometry, primitive) => {
                self.stats.primitives += 1;
                let Geometry::Shapes(shapes) = self.world.geometry(geometry) else { return false };
                let hit = shapes[primitive as usize].intersect(self.ray, query.end());
                hit.is_some_and(|hit| {
                    query.offer(Hit { t: hit.t, uv: hit.uv, geometry, primitive, instance: self.instance })
                })
            }
            Item::Instance(id) => {
                let placed = &self.world.instances[id.0 as usize];
                let ray = placed.with_placement(self.ray.time, |placement| placement.ray(self.ray));
                let mut inner =
                    Trace { world: self.world, ray: &ray, instance: Some(id), stats: &mut *self.stats };
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

fn pack(tree: &Bvh, ids: &[(u32, u32)], geometries: &[Geometry]) -> Vec<Packet> {
    let fill = |block: &[Option<u32>]| {
        let mut packet = Packet::EMPTY;
        for &index in block.iter().flatten() {
            let id = ids[index as usize];
            if let Geometry::Mesh(mesh) = &geometries[id.0 as usize] {
                packet.push(mesh.corners(id.1 as usize), id);
            }
        }
        packet
    };
    tree.order().chunks(Packet::WIDTH).map(fill).collect()
}
