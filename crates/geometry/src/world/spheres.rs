//! The spheres of a group's sets: a tree over packets of eight.
//!
//! A packet says in floats which of its spheres the ray may meet; each of those few is then put to
//! the test in doubles, which has the last word. With m = c − o, unit direction d and b = m·d the
//! ray passes the centre at the distance |m − b·d|. A sphere is refused only when that exceeds r +
//! E, or when the range b ± (r + E) lies outside of the ray's; E is above twice the rounding of m,
//! d, b and the distance, each of which is within a few ε·|m|.

#![allow(unsafe_code)]

use super::group::{Trace, visit};
use super::query::Query;
use super::{Geometry, GeometryId, Hit};
use crate::bvh::{BuildQuality, Bvh, Extent, Leaves, Primitives, Reference};
use crate::sphere_set::SphereSet;
use lanes::{Simd, Task, Vector};
use math::{Bounds3, MACHINE_EPSILON, Ray, Vec2, Vec3};
use std::ops::Range;

/// All spheres of a group.
#[derive(Clone, Debug)]
pub(super) struct Spheres {
    pub tree: Bvh,
    packets: Vec<Packet>,
}

impl Spheres {
    pub fn build(members: &[GeometryId], geometries: &[Geometry], quality: BuildQuality) -> Self {
        let (tree, packets) = Bvh::build(&Sets { members, geometries }, quality);
        Self { tree, packets }
    }

    /// Brings packets and boxes up to date after spheres have moved or grown.
    pub fn refit(&mut self, geometries: &[Geometry]) {
        self.tree.refit(&mut self.packets, |packet| packet.renew(geometries));
    }

    /// Bytes of memory that tree and packets take.
    pub fn bytes(&self) -> usize {
        self.tree.bytes() + size_of_val(&*self.packets)
    }

    /// Shows hits to the query; whether it wants no more. Their parameters are zero: only the
    /// surface knows them.
    pub fn trace<Q: Query>(&self, trace: &mut Trace, query: &mut Q) -> bool {
        if self.packets.is_empty() {
            return false;
        }
        let set = trace.world.instruction_set;
        // SAFETY: worlds are only given sets that the processor has.
        let (extents, primitives, stop) = unsafe { set.run(TraceSpheres { spheres: self, trace, query }) };
        trace.stats.extents += extents;
        trace.stats.primitives += primitives;
        stop
    }
}

/// The spheres of all sets.
struct Sets<'a> {
    members: &'a [GeometryId],
    geometries: &'a [Geometry],
}

impl Primitives for Sets<'_> {
    type Block = Packet;
    const COST: f32 = 0.25;

    fn width(&self) -> usize {
        Packet::WIDTH
    }

    fn geometries(&self) -> Vec<(u32, usize)> {
        let len = |&id: &GeometryId| match &self.geometries[id.0 as usize] {
            Geometry::Spheres(set) => Some((id.0, set.len())),
            Geometry::Mesh(_) | Geometry::Shapes(_) | Geometry::Curves(_) => None,
        };
        self.members.iter().filter_map(len).collect()
    }

    #[inline]
    fn extent(&self, geometry: u32, sphere: u32) -> Option<Extent> {
        match &self.geometries[geometry as usize] {
            Geometry::Spheres(set) => {
                let bounds = set.bounds(sphere as usize);
                (bounds.min.is_finite() && bounds.max.is_finite()).then(|| Extent::from(&bounds))
            }
            Geometry::Mesh(_) | Geometry::Shapes(_) | Geometry::Curves(_) => None,
        }
    }

    fn block(&self, spheres: &[Reference]) -> (Packet, usize, Extent) {
        let (packet, bounds) = Packet::new(spheres, self.geometries);
        (packet, spheres.len(), Extent::from(&bounds))
    }
}

/// A ray on its way through the spheres of a group.
struct TraceSpheres<'a, 'b, Q> {
    spheres: &'a Spheres,
    trace: &'a Trace<'b>,
    query: &'a mut Q,
}

impl<Q: Query> Task for TraceSpheres<'_, '_, Q> {
    type Output = (u64, u64, bool);

    #[inline(always)]
    unsafe fn run<S: Simd>(self) -> Self::Output {
        let Self { spheres, trace, query } = self;
        let mut t_max = query.t_max();
        // SAFETY: the caller promises the instructions.
        unsafe {
            let lanes = UnitRay::<S::F32x8>::new(trace.ray);
            let mut leaves = Tests { packets: &spheres.packets, trace, lanes, query, primitives: 0 };
            let all = trace.all(spheres.packets.len());
            let (extents, stop) = visit::<S, Q>(&spheres.tree, all, trace.ray, &mut t_max, &mut leaves);
            (extents, leaves.primitives, stop)
        }
    }
}

struct Tests<'a, 'b, V, Q> {
    packets: &'a [Packet],
    trace: &'a Trace<'b>,
    lanes: UnitRay<V>,
    query: &'a mut Q,
    primitives: u64,
}

impl<V: Vector<{ Packet::WIDTH }>, Q: Query> Leaves for Tests<'_, '_, V, Q> {
    type Block = Packet;

    #[inline(always)]
    fn blocks(&self) -> &[Packet] {
        self.packets
    }

    #[inline(always)]
    unsafe fn test(&mut self, blocks: Range<usize>, t_max: &mut f32) -> bool {
        for packet in &self.packets[blocks] {
            self.primitives += packet.len as u64;
            let mut candidates = packet.candidates(&self.lanes, *t_max);
            while candidates != 0 {
                let lane = candidates.trailing_zeros() as usize % Packet::WIDTH;
                candidates &= candidates - 1;
                let (center, radius) = packet.sphere(lane);
                let Some(t) = SphereSet::intersect(center, radius, self.trace.ray, self.query.end()) else {
                    continue;
                };
                let (geometry, primitive) = packet.ids[lane];
                let (geometry, instance) = (GeometryId(geometry), self.trace.instance);
                if self.query.offer(Hit { t, uv: Vec2::ZERO, geometry, primitive, instance }) {
                    return true;
                }
            }
            *t_max = self.query.t_max();
        }
        false
    }
}

/// A ray made ready for many spheres, the same in every lane.
struct UnitRay<V> {
    o: [V; 3],
    /// Of unit length.
    d: [V; 3],
    /// The length that it had.
    length: f32,
}

impl<V: Vector<{ Packet::WIDTH }>> UnitRay<V> {
    /// # Safety
    /// The processor must have the instructions that `V` takes.
    #[inline(always)]
    unsafe fn new(ray: &Ray) -> Self {
        let d = ray.d.as_dvec3();
        let length = d.length();
        // SAFETY: as the caller promises.
        let lanes = |v: Vec3| v.to_array().map(|x| unsafe { V::splat(x) });
        Self { o: lanes(ray.o), d: lanes((d / length).as_vec3()), length: length as f32 }
    }
}

/// Spheres of one set or of many, axis by axis.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
struct Packet {
    center: [[f32; Packet::WIDTH]; 3],
    radius: [f32; Packet::WIDTH],
    /// Whose sphere each lane holds: geometry and primitive.
    ids: [(u32, u32); Packet::WIDTH],
    /// How many lanes are in use.
    len: u32,
}

impl Packet {
    /// Spheres in a packet.
    const WIDTH: usize = 8;

    /// A packet, and the box around it. Lanes that are not in use have a centre that nothing is
    /// near to.
    fn new(block: &[Reference], geometries: &[Geometry]) -> (Self, Bounds3) {
        let mut packet = Self {
            center: [[f32::NAN; Self::WIDTH]; 3],
            radius: [0.0; Self::WIDTH],
            ids: [(u32::MAX, u32::MAX); Self::WIDTH],
            len: block.len() as u32,
        };
        for (id, reference) in packet.ids.iter_mut().zip(block) {
            *id = (reference.geometry(), reference.primitive());
        }
        let bounds = packet.renew(geometries);
        (packet, bounds)
    }

    /// Takes the spheres from their sets again; gives the box around them. Spheres that are not
    /// finite are met by nothing.
    fn renew(&mut self, geometries: &[Geometry]) -> Bounds3 {
        // Nothing but loads, so that many are under way at once: spheres of a packet lie anywhere
        // in their arrays.
        let mut spheres = [(Vec3::NAN, 0.0); Self::WIDTH];
        for (sphere, (geometry, primitive)) in spheres.iter_mut().zip(self.ids).take(self.len as usize) {
            if let Geometry::Spheres(set) = &geometries[geometry as usize] {
                *sphere = (set.center(primitive as usize), set.radius(primitive as usize));
            }
        }
        let mut all = Bounds3::EMPTY;
        for (lane, &(center, radius)) in spheres.iter().enumerate() {
            let bounds = SphereSet::bounds_of(center, radius);
            let finite = bounds.min.is_finite() && bounds.max.is_finite();
            all = all.union(if finite { bounds } else { Bounds3::EMPTY });
            let center = if finite { center } else { Vec3::NAN };
            (0..3).for_each(|axis| self.center[axis][lane] = center[axis]);
            self.radius[lane] = radius;
        }
        all
    }

    #[inline]
    fn sphere(&self, lane: usize) -> (Vec3, f32) {
        (Vec3::from(self.center.map(|axis| axis[lane])), self.radius[lane])
    }

    /// A bit for each sphere that the ray may meet up to `t_max`.
    #[inline(always)]
    fn candidates<V: Vector<{ Self::WIDTH }>>(&self, ray: &UnitRay<V>, t_max: f32) -> u32 {
        const ERROR: f32 = 16.0 * MACHINE_EPSILON;
        let end = t_max * ray.length * (1.0 + ERROR);
        // SAFETY: whoever has `ray` has the instructions.
        let (splat, load) = (|x| unsafe { V::splat(x) }, |x| unsafe { V::load(x) });
        let [dx, dy, dz] = ray.d;
        let [mx, my, mz] = [0, 1, 2].map(|axis| load(&self.center[axis]).sub(ray.o[axis]));
        let b = mx.mul_add(dx, my.mul_add(dy, mz.mul(dz)));
        let [px, py, pz] = [b.neg_mul_add(dx, mx), b.neg_mul_add(dy, my), b.neg_mul_add(dz, mz)];
        let distance2 = px.mul_add(px, py.mul_add(py, pz.mul(pz)));
        let radius = load(&self.radius);
        let size = mx.abs().add(my.abs()).add(mz.abs()).add(radius);
        let reach = size.mul_add(splat(ERROR), radius);
        // Squares may underflow.
        let meets = distance2.le(reach.mul_add(reach, splat(f32::MIN_POSITIVE)));
        meets & splat(0.0).le(b.add(reach)) & b.sub(reach).le(splat(end))
    }
}
