//! What stands together: triangles in a tree of packets, other shapes and instances in a tree of single
//! items, and whatever has no bounds in a list.

use super::packet::Packet;
use super::{Geometry, GeometryId, Hit, InstanceId, Placed, RayStats, World};
use crate::bvh::{Bvh, Primitive};
use crate::watertight::Sheared;
use math::{Bounds3, Ray, gamma};
use std::ops::ControlFlow;

/// Everything in a group but its triangles.
#[derive(Clone, Copy, Debug)]
enum Item {
    Shape(GeometryId, u32),
    Instance(InstanceId),
}

/// What is to be done after a hit.
pub(super) enum Verdict {
    /// Forget it.
    Refuse,
    /// Look for nearer ones only.
    Keep,
    /// Look no further.
    Stop,
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

    /// Shows hits to `accept`; breaks when it says stop.
    pub fn trace<F: FnMut(Hit) -> Verdict>(
        &self,
        trace: &mut Trace,
        t_max: &mut f32,
        accept: &mut F,
    ) -> ControlFlow<()> {
        for &item in &self.unbounded {
            trace.item(item, t_max, accept)?;
        }
        if !self.packets.is_empty() {
            let sheared = Sheared::new(trace.ray);
            let (mut extents, mut primitives) = (0, 0);
            let flow = self.triangles.traverse(trace.ray, t_max, &mut extents, |blocks, t_max| {
                for packet in &self.packets[blocks] {
                    primitives += packet.len as u64;
                    trace.packet(packet, &sheared, t_max, accept)?;
                }
                ControlFlow::Continue(())
            });
            trace.stats.extents += extents;
            trace.stats.primitives += primitives;
            flow?;
        }
        if !self.item_list.is_empty() {
            let mut extents = 0;
            let flow = self.items.traverse(trace.ray, t_max, &mut extents, |blocks, t_max| {
                for &item in &self.item_list[blocks] {
                    trace.item(item, t_max, accept)?;
                }
                ControlFlow::Continue(())
            });
            trace.stats.extents += extents;
            flow?;
        }
        ControlFlow::Continue(())
    }
}

impl Trace<'_> {
    #[inline]
    fn packet(
        &self,
        packet: &Packet,
        sheared: &Sheared,
        t_max: &mut f32,
        accept: &mut impl FnMut(Hit) -> Verdict,
    ) -> ControlFlow<()> {
        let mut candidates = packet.candidates(sheared, *t_max);
        while candidates != 0 {
            let lane = candidates.trailing_zeros() as usize;
            candidates &= candidates - 1;
            if let Some((t, uv)) = sheared.triangle(&packet.triangle(lane), *t_max) {
                let (geometry, primitive) = packet.ids[lane];
                let geometry = GeometryId(geometry);
                judge(Hit { t, uv, geometry, primitive, instance: self.instance }, t_max, accept)?;
            }
        }
        ControlFlow::Continue(())
    }

    fn item<F: FnMut(Hit) -> Verdict>(
        &mut self,
        item: Item,
        t_max: &mut f32,
        accept: &mut F,
    ) -> ControlFlow<()> {
        match item {
            Item::Shape(geometry, primitive) => {
                self.stats.primitives += 1;
                let hit = match self.world.geometry(geometry) {
                    Geometry::Shapes(shapes) => shapes[primitive as usize].intersect(self.ray, *t_max),
                    Geometry::Curves(curves) => curves.intersect(primitive, self.ray, *t_max),
                    Geometry::Mesh(_) => None,
                };
                match hit {
                    Some(hit) => judge(
                        Hit { t: hit.t, uv: hit.uv, geometry, primitive, instance: self.instance },
                        t_max,
                        accept,
                    ),
                    None => ControlFlow::Continue(()),
                }
            }
            Item::Instance(id) => {
                let placed = &self.world.instances[id.0 as usize];
                let ray = placed.with_placement(self.ray.time, |placement| placement.ray(self.ray));
                if !(ray.o.is_finite() && ray.d.is_finite()) {
                    return ControlFlow::Continue(());
                }
                let mut inner =
                    Trace { world: self.world, ray: &ray, instance: Some(id), stats: &mut *self.stats };
                self.world.groups[placed.group as usize].trace(&mut inner, t_max, accept)
            }
        }
    }
}

fn judge(hit: Hit, t_max: &mut f32, accept: &mut impl FnMut(Hit) -> Verdict) -> ControlFlow<()> {
    match accept(hit) {
        Verdict::Refuse => ControlFlow::Continue(()),
        Verdict::Keep => {
            *t_max = hit.t;
            ControlFlow::Continue(())
        }
        Verdict::Stop => ControlFlow::Break(()),
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
