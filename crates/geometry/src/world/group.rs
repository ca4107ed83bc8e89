//! What stands together: triangles in a tree of packets, other shapes and instances in a tree of single
//! items, and whatever has no bounds in a list.

use super::packet::Packet;
use super::{Geometry, GeometryId, Hit, InstanceId, Placed, RayStats, World};
use crate::bvh::{BuildQuality, Bvh, Reference};
use crate::watertight::Sheared;
use math::{Bounds3, Ray, gamma};
use rayon::prelude::*;
use std::ops::ControlFlow;

/// Meshes with fewer triangles are not worth another thread.
const PARALLEL: usize = 4096;

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
        quality: BuildQuality,
    ) -> Self {
        let mut items = Vec::new();
        let mut unbounded = Vec::new();
        let mut boxes = Vec::new();
        let mut add_item = |item, bounds: Bounds3| {
            if is_finite(&bounds) {
                boxes.push(Reference::new(&bounds, 0, items.len() as u32));
                items.push(item);
            }
        };
        for &id in members {
            match &geometries[id.0 as usize] {
                Geometry::Mesh(_) => {}
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
        let pack = |block: &[Reference]| packet(block, geometries);
        let triangles = triangle_references(members, geometries);
        let (triangles, packets) = Bvh::build(triangles, quality, Packet::WIDTH, pack);
        let item = |block: &[Reference]| items[block[0].primitive() as usize];
        let (boxes, item_list) = Bvh::build(boxes, quality, 1, item);
        Self { triangles, packets, items: boxes, item_list, unbounded }
    }

    /// Bytes of memory that the trees take.
    pub fn bytes(&self) -> usize {
        let packets = size_of_val(&*self.packets);
        let items = size_of_val(&*self.item_list) + size_of_val(&*self.unbounded);
        self.triangles.bytes() + packets + self.items.bytes() + items
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

/// The triangles of all meshes whose corners are finite.
fn triangle_references(members: &[GeometryId], geometries: &[Geometry]) -> Vec<Reference> {
    let mut references = Vec::new();
    for &id in members {
        if let Geometry::Mesh(mesh) = &geometries[id.0 as usize] {
            let reference = |i: usize| {
                let corners = mesh.corners(i);
                match corners.iter().all(|p| p.is_finite()) {
                    true => Reference::new(&Bounds3::around(corners), id.0, i as u32),
                    false => Reference::none(),
                }
            };
            match mesh.len() {
                0..PARALLEL => references.extend((0..mesh.len()).map(reference)),
                n => references.par_extend((0..n).into_par_iter().map(reference)),
            }
        }
    }
    if references.iter().any(Reference::is_none) {
        references.retain(|r| !r.is_none());
    }
    references
}

fn packet(block: &[Reference], geometries: &[Geometry]) -> Packet {
    let mut packet = Packet::EMPTY;
    for reference in block {
        let (geometry, primitive) = (reference.geometry(), reference.primitive());
        if let Geometry::Mesh(mesh) = &geometries[geometry as usize] {
            packet.push(mesh.corners(primitive as usize), (geometry, primitive));
        }
    }
    packet
}
