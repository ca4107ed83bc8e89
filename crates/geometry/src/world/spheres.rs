//! The spheres of a group's sets: a tree over blocks of eight.
//!
//! A block is tested in floats for the spheres that the ray may hit; these few candidates are then
//! tested in doubles. With m = c − o and unit direction d, the point of the ray that is nearest to
//! the centre is at m·d, clamped to the ray's range, s. A sphere is rejected only where |m − s·d|,
//! its distance from the centre, exceeds r + E; E is more than twice the rounding error of m, d, s
//! and the distance, each of which is a few ε·|m|.
//!
//! A single ray is tested against the spheres of a block together, the rays of a packet against one
//! sphere after another.

#![allow(unsafe_code)]

use super::geometry::{Geometry, GeometryId};
use super::hit::Hit;
use super::instance::InstancePath;
use super::query::{Query, offer_all};
use crate::bvh::{BuildQuality, Bvh, Extent, Packet, Primitives, Reference, WIDTH};
use crate::shape::SphereRay;
use crate::sphere_set::SphereSet;
use lanes::Vector;
use math::{Bounds3, MACHINE_EPSILON, Ray, Vec2, Vec3};

/// All spheres of a group.
#[derive(Clone, Debug)]
pub(super) struct Spheres {
    pub tree: Bvh,
    pub blocks: Vec<SphereBlock>,
    /// The area of all boxes when the tree was built.
    built_area: f64,
}

impl Spheres {
    pub fn build(members: &[GeometryId], geometries: &[Geometry], quality: BuildQuality) -> Self {
        let (tree, blocks) = Bvh::build(&Sets { members, geometries }, quality);
        let built_area = tree.area();
        Self { tree, blocks, built_area }
    }

    /// The area of all boxes relative to that when the tree was built.
    pub fn growth(&self) -> f64 {
        if self.built_area > 0.0 { self.tree.area() / self.built_area } else { 1.0 }
    }

    /// Reloads blocks and boxes after spheres have moved or grown.
    pub fn refit(&mut self, geometries: &[Geometry]) {
        self.tree.refit(&mut self.blocks, |block| block.reload(geometries));
    }

    /// Bytes of memory of tree and blocks.
    pub fn bytes(&self) -> usize {
        self.tree.bytes() + size_of_val(&*self.blocks)
    }
}

/// The sphere sets of a group, as a tree is built over their spheres.
struct Sets<'a> {
    members: &'a [GeometryId],
    geometries: &'a [Geometry],
}

impl Primitives for Sets<'_> {
    type Block = SphereBlock;
    const COST: f32 = 0.25;

    fn width(&self) -> usize {
        SphereBlock::WIDTH
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

    fn block(&self, spheres: &[Reference]) -> (SphereBlock, usize, Extent) {
        let (block, bounds) = SphereBlock::new(spheres, self.geometries);
        (block, spheres.len(), Extent::from(&bounds))
    }
}

/// The largest error of positions and distances, relative to the size of what is computed with.
const ERROR: f32 = 16.0 * MACHINE_EPSILON;

/// A ray in every lane, or one ray of a packet in each, prepared for tests against spheres.
pub(super) struct ScaledRays<V> {
    o: [V; 3],
    /// Of which the largest component is one.
    d: [V; 3],
    /// 1/d².
    inverse: V,
    /// The largest component of the original direction, and more by the error.
    scale: V,
}

impl<V> ScaledRays<V> {
    /// A ray in every lane.
    ///
    /// # Safety
    /// The processor must have the instruction set of `V`.
    #[inline(always)]
    pub unsafe fn of<const N: usize>(ray: &Ray) -> Self
    where
        V: Vector<N>,
    {
        // SAFETY: as the caller promises.
        let splat = |v: Vec3| unsafe { [V::splat(v.x), V::splat(v.y), V::splat(v.z)] };
        Self::new(splat(ray.o), splat(ray.d))
    }

    /// A ray in each lane.
    ///
    /// # Safety
    /// The processor must have the instruction set of `V`.
    #[inline(always)]
    pub unsafe fn each(packet: &Packet) -> Self
    where
        V: Vector<WIDTH>,
    {
        let Packet { o, d, .. } = packet;
        // SAFETY: as the caller promises.
        let load = |v: &[[f32; WIDTH]; 3]| unsafe { [V::load(&v[0]), V::load(&v[1]), V::load(&v[2])] };
        Self::new(load(o), load(d))
    }

    #[inline(always)]
    fn new<const N: usize>(o: [V; 3], [x, y, z]: [V; 3]) -> Self
    where
        V: Vector<N>,
    {
        // SAFETY: a vector is the proof of the instruction set.
        let splat = |x| unsafe { V::splat(x) };
        let largest = x.abs().max(y.abs()).max(z.abs());
        let shrink = splat(1.0).div(largest);
        let [x, y, z] = [x.mul(shrink), y.mul(shrink), z.mul(shrink)];
        let inverse = splat(1.0).div(x.mul_add(x, y.mul_add(y, z.mul(z))));
        Self { o, d: [x, y, z], inverse, scale: largest.mul(splat(1.0 + ERROR)) }
    }

    /// A bit for each sphere that a ray may meet up to `t_max`.
    #[inline(always)]
    fn meet<const N: usize>(&self, center: [V; 3], radius: V, t_max: V) -> u32
    where
        V: Vector<N>,
    {
        // SAFETY: a vector is the proof of the instruction set.
        let splat = |x| unsafe { V::splat(x) };
        let end = t_max.mul(self.scale);
        let [dx, dy, dz] = self.d;
        let [mx, my, mz] = [center[0].sub(self.o[0]), center[1].sub(self.o[1]), center[2].sub(self.o[2])];
        let s = mx.mul_add(dx, my.mul_add(dy, mz.mul(dz))).mul(self.inverse).max(splat(0.0)).min(end);
        let [px, py, pz] = [s.neg_mul_add(dx, mx), s.neg_mul_add(dy, my), s.neg_mul_add(dz, mz)];
        let distance2 = px.mul_add(px, py.mul_add(py, pz.mul(pz)));
        let size = mx.abs().add(my.abs()).add(mz.abs()).add(radius);
        let reach = size.mul_add(splat(ERROR), radius);
        // Squares may underflow.
        distance2.le(reach.mul_add(reach, splat(f32::MIN_POSITIVE)))
    }
}

/// Eight spheres of any sets.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct SphereBlock {
    center: [[f32; SphereBlock::WIDTH]; 3],
    radius: [f32; SphereBlock::WIDTH],
    /// Geometry and primitive of each lane.
    ids: [(u32, u32); SphereBlock::WIDTH],
    /// The number of lanes in use.
    len: u32,
}

impl SphereBlock {
    /// Spheres in a block.
    pub const WIDTH: usize = 8;

    /// A block, and the box around it. Unused lanes have a centre of NaN, which no ray hits.
    fn new(references: &[Reference], geometries: &[Geometry]) -> (Self, Bounds3) {
        let mut block = Self {
            center: [[f32::NAN; Self::WIDTH]; 3],
            radius: [0.0; Self::WIDTH],
            ids: [(u32::MAX, u32::MAX); Self::WIDTH],
            len: references.len() as u32,
        };
        for (id, reference) in block.ids.iter_mut().zip(references) {
            *id = (reference.geometry(), reference.primitive());
        }
        let bounds = block.reload(geometries);
        (block, bounds)
    }

    /// Reloads the spheres from their sets and returns the box around them. Spheres that are not
    /// finite are never hit.
    fn reload(&mut self, geometries: &[Geometry]) -> Bounds3 {
        // Loads alone, so that many cache misses overlap: the spheres of a block are anywhere in
        // their arrays.
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

    /// The number of lanes in use.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.len as usize
    }

    /// Geometry and primitive of a lane.
    #[inline(always)]
    pub fn id(&self, lane: usize) -> (u32, u32) {
        self.ids[lane]
    }

    /// Centre and radius of a lane.
    #[inline]
    pub fn sphere(&self, lane: usize) -> (Vec3, f32) {
        (Vec3::from(self.center.map(|axis| axis[lane])), self.radius[lane])
    }

    /// Offers the hits on the sphere of a lane to a query; returns whether it is finished. Their
    /// parameters are zero: only the surface point has them.
    #[inline(always)]
    pub fn offer<Q: Query>(
        &self,
        lane: usize,
        ray: &SphereRay,
        instance: InstancePath,
        query: &mut Q,
    ) -> bool {
        let (center, radius) = self.sphere(lane);
        let (geometry, primitive) = self.ids[lane];
        let geometry = GeometryId(geometry);
        offer_all(query, |after, query| {
            let t = ray.meets(center, radius, [after, query.end()])?;
            Some(Hit { t, uv: Vec2::ZERO, geometry, primitive, instance })
        })
    }

    /// A bit for each sphere that the ray may meet up to `t_max`.
    #[inline(always)]
    pub fn met_by<V: Vector<{ Self::WIDTH }>>(&self, ray: &ScaledRays<V>, t_max: f32) -> u32 {
        // SAFETY: `ray` is the proof of the instruction set.
        let (splat, load) = (|x| unsafe { V::splat(x) }, |x| unsafe { V::load(x) });
        let center = [load(&self.center[0]), load(&self.center[1]), load(&self.center[2])];
        ray.meet(center, load(&self.radius), splat(t_max))
    }

    /// A bit for each ray of a packet that may meet the sphere of a lane up to its `t_max`.
    #[inline(always)]
    pub fn meeting<V: Vector<WIDTH>>(&self, lane: usize, rays: &ScaledRays<V>, t_max: V) -> u32 {
        // SAFETY: `rays` is the proof of the instruction set.
        let splat = |x: f32| unsafe { V::splat(x) };
        let center = [splat(self.center[0][lane]), splat(self.center[1][lane]), splat(self.center[2][lane])];
        rays.meet(center, splat(self.radius[lane]), t_max)
    }
}
