//! The spheres of a group's sets: a tree over packets of eight.
//!
//! A packet says in floats which of its spheres the ray may meet; each of those few is then put to the test in doubles, which
//! has the last word. With m = c − o, unit direction d and b = m·d the ray passes the centre at the distance |m − b·d|. A
//! sphere is refused only when that exceeds r + E, or when the range b ± (r + E) lies outside of the ray's; E is above twice the
//! rounding of m, d, b and the distance, each of which is within a few ε·|m|.

use super::group::{Trace, Verdict, judge};
use super::{Geometry, GeometryId, Hit};
use crate::bvh::{BuildQuality, Bvh, Reference};
use crate::sphere_set::SphereSet;
use math::{MACHINE_EPSILON, Ray, Vec2, Vec3};
use rayon::prelude::*;
use std::ops::ControlFlow;

/// All spheres of a group.
#[derive(Clone, Debug)]
pub(super) struct Spheres {
    pub tree: Bvh,
    packets: Vec<Packet>,
}

impl Spheres {
    pub fn build(members: &[GeometryId], geometries: &[Geometry], quality: BuildQuality) -> Self {
        let mut references = Vec::new();
        for &id in members {
            if let Geometry::Spheres(set) = &geometries[id.0 as usize] {
                let finite = |i: usize| {
                    let bounds = set.bounds(i);
                    let finite = bounds.min.is_finite() && bounds.max.is_finite();
                    finite.then(|| Reference::new(&bounds, id.0, i as u32))
                };
                references.par_extend((0..set.len()).into_par_iter().filter_map(finite));
            }
        }
        let pack = |block: &[Reference]| Packet::new(block, geometries);
        let (tree, packets) = Bvh::build(references, quality, Packet::WIDTH, pack);
        Self { tree, packets }
    }

    /// Bytes of memory that tree and packets take.
    pub fn bytes(&self) -> usize {
        self.tree.bytes() + size_of_val(&*self.packets)
    }

    /// Shows hits to `accept`; breaks when it says stop. Their parameters are zero: only the surface knows them.
    pub fn trace(
        &self,
        trace: &mut Trace,
        t_max: &mut f32,
        accept: &mut impl FnMut(Hit) -> Verdict,
    ) -> ControlFlow<()> {
        if self.packets.is_empty() {
            return ControlFlow::Continue(());
        }
        let ray = UnitRay::new(trace.ray);
        let (mut extents, mut primitives) = (0, 0);
        let flow = self.tree.traverse(trace.ray, t_max, &mut extents, |blocks, t_max| {
            for packet in &self.packets[blocks] {
                primitives += packet.len() as u64;
                let mut candidates = packet.candidates(&ray, *t_max);
                while candidates != 0 {
                    let lane = candidates.trailing_zeros() as usize;
                    candidates &= candidates - 1;
                    let (center, radius) = packet.sphere(lane);
                    if let Some(t) = SphereSet::intersect(center, radius, trace.ray, *t_max) {
                        let (geometry, primitive) = packet.ids[lane];
                        let geometry = GeometryId(geometry);
                        let hit = Hit { t, uv: Vec2::ZERO, geometry, primitive, instance: trace.instance };
                        judge(hit, t_max, accept)?;
                    }
                }
            }
            ControlFlow::Continue(())
        });
        trace.stats.extents += extents;
        trace.stats.primitives += primitives;
        flow
    }
}

/// A ray made ready for many spheres.
struct UnitRay {
    o: [f32; 3],
    /// Of unit length.
    d: [f32; 3],
    /// The length that it had.
    length: f32,
}

impl UnitRay {
    fn new(ray: &Ray) -> Self {
        let d = ray.d.as_dvec3();
        let length = d.length();
        Self { o: ray.o.to_array(), d: (d / length).as_vec3().to_array(), length: length as f32 }
    }
}

/// Spheres of one set or of many, axis by axis.
#[derive(Clone, Debug)]
#[repr(align(32))]
struct Packet {
    center: [[f32; Packet::WIDTH]; 3],
    radius: [f32; Packet::WIDTH],
    /// Whose sphere each lane holds: geometry and primitive.
    ids: [(u32, u32); Packet::WIDTH],
}

impl Packet {
    /// Spheres in a packet.
    const WIDTH: usize = 8;

    /// Lanes that are not in use have a centre that nothing is near to.
    fn new(block: &[Reference], geometries: &[Geometry]) -> Self {
        let mut packet = Self {
            center: [[f32::NAN; Self::WIDTH]; 3],
            radius: [0.0; Self::WIDTH],
            ids: [(u32::MAX, u32::MAX); Self::WIDTH],
        };
        for (lane, reference) in block.iter().enumerate() {
            let id = (reference.geometry(), reference.primitive());
            if let Geometry::Spheres(set) = &geometries[id.0 as usize] {
                let center = set.center(id.1 as usize);
                (0..3).for_each(|axis| packet.center[axis][lane] = center[axis]);
                packet.radius[lane] = set.radius(id.1 as usize);
                packet.ids[lane] = id;
            }
        }
        packet
    }

    /// How many lanes are in use.
    fn len(&self) -> usize {
        self.ids.iter().filter(|id| id.0 != u32::MAX).count()
    }

    #[inline]
    fn sphere(&self, lane: usize) -> (Vec3, f32) {
        (Vec3::from(self.center.map(|axis| axis[lane])), self.radius[lane])
    }

    /// A bit for each sphere that the ray may meet before `t_max`.
    #[inline]
    fn candidates(&self, ray: &UnitRay, t_max: f32) -> u32 {
        const ERROR: f32 = 16.0 * MACHINE_EPSILON;
        let UnitRay { o, d, length } = ray;
        let end = t_max * length * (1.0 + ERROR);
        let mut may_hit = [0u32; Self::WIDTH];
        for i in 0..Self::WIDTH {
            let m = [0, 1, 2].map(|axis| self.center[axis][i] - o[axis]);
            let b = m[0].mul_add(d[0], m[1].mul_add(d[1], m[2] * d[2]));
            let passing = [0, 1, 2].map(|axis| (-b).mul_add(d[axis], m[axis]));
            let radius = self.radius[i];
            let size = m[0].abs() + m[1].abs() + m[2].abs() + radius;
            let reach = size.mul_add(ERROR, radius);
            let distance2 =
                passing[0].mul_add(passing[0], passing[1].mul_add(passing[1], passing[2] * passing[2]));
            // Squares may underflow.
            let meets = distance2 <= reach.mul_add(reach, f32::MIN_POSITIVE);
            may_hit[i] = (meets & (b + reach >= 0.0) & (b - reach <= end)) as u32;
        }
        may_hit.iter().enumerate().fold(0, |bits, (i, hit)| bits | hit << i)
    }
}
