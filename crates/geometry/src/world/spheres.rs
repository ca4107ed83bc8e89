//! The spheres of a group's sets: a tree over blocks of eight.
//!
//! A block is tested in floats for the spheres that the ray may hit; these few candidates are then
//! tested in doubles. With m = c − o, unit direction d and b = m·d, the ray passes the centre at
//! distance |m − b·d|. A sphere is rejected only where that exceeds r + E, or where the range b ±
//! (r + E) lies outside of the ray's; E is more than twice the rounding error of m, d, b and the
//! distance, each of which is a few ε·|m|.

#![allow(unsafe_code)]

use super::geometry::{Geometry, GeometryId};
use crate::bvh::{BuildQuality, Bvh, Extent, Primitives, Reference};
use crate::sphere_set::SphereSet;
use lanes::Vector;
use math::{Bounds3, MACHINE_EPSILON, Ray, Vec3};

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

/// A ray prepared for tests against spheres, the same in every lane.
pub(super) struct UnitRay<V> {
    o: [V; 3],
    /// Of unit length.
    d: [V; 3],
    /// The length of the original direction.
    length: f32,
}

impl<V: Vector<{ SphereBlock::WIDTH }>> UnitRay<V> {
    /// # Safety
    /// The processor must have the instruction set of `V`.
    #[inline(always)]
    pub unsafe fn new(ray: &Ray) -> Self {
        let d = ray.d.as_dvec3();
        let length = d.length();
        // SAFETY: as the caller promises.
        let lanes = |v: Vec3| v.to_array().map(|x| unsafe { V::splat(x) });
        Self { o: lanes(ray.o), d: lanes((d / length).as_vec3().into()), length: length as f32 }
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

    /// A bit for each sphere that the ray may meet up to `t_max`.
    #[inline(always)]
    pub fn candidates<V: Vector<{ Self::WIDTH }>>(&self, ray: &UnitRay<V>, t_max: f32) -> u32 {
        const ERROR: f32 = 16.0 * MACHINE_EPSILON;
        let end = t_max * ray.length * (1.0 + ERROR);
        // SAFETY: `ray` is the proof of the instruction set.
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
