//! Nodes of sixteen children, whose boxes are tested together.
//!
//! The idea is that of [Wald et al. 2008]. What a ray waits for on its way down is one answer after
//! another, each the same time whether of eight boxes or of sixteen, and with sixteen there are
//! fewer: that pays even where vectors are shorter.
//!
//! A ray enters a slab at t = p·(1/d) − o/d, which is one fused product; everything but the plane p
//! is known beforehand. Boxes are widened by what that rounds, and by what the watertight triangle
//! test may err: that test rounds vertices after moving them to the ray's origin, so that it may
//! meet a triangle that the exact ray misses by γ(8) times the distance; a box that is not as
//! generous would let such a ray slip through a closed surface.

#![allow(unsafe_code)]

use lanes::Vector;
use math::{Bounds3, Ray, Vec3, gamma};

/// Children of a node, and rays that pass together.
pub(crate) const WIDTH: usize = 16;

/// A child in 32 bits: a node, or a range of blocks of primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Child(pub u32);

impl Child {
    const LEAF: u32 = 1 << 31;
    const BLOCK_BITS: u32 = 4;
    /// The most blocks that a leaf may hold.
    pub const MAX_BLOCKS: usize = (1 << Self::BLOCK_BITS) - 1;
    /// A leaf without blocks.
    pub const NOTHING: Self = Self(Self::LEAF);

    /// The node at an index.
    pub fn node(index: usize) -> Self {
        assert!(index < Self::LEAF as usize, "too many nodes for an index of 31 bits");
        Self(index as u32)
    }

    /// Blocks `first` to `first + blocks`.
    pub fn leaf(first: usize, blocks: usize) -> Self {
        assert!(
            first < (1 << (31 - Self::BLOCK_BITS)) - 1 && blocks <= Self::MAX_BLOCKS,
            "too many primitives"
        );
        Self(Self::LEAF | (first as u32) << Self::BLOCK_BITS | blocks as u32)
    }

    #[inline(always)]
    pub fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    /// Where the node is.
    #[inline(always)]
    pub fn index(self) -> usize {
        self.0 as usize
    }

    /// Which blocks the leaf holds.
    #[inline(always)]
    pub fn blocks(self) -> std::ops::Range<usize> {
        let first = ((self.0 & !Self::LEAF) >> Self::BLOCK_BITS) as usize;
        first..first + (self.0 as usize & Self::MAX_BLOCKS)
    }
}

/// A node: the six planes of each child's box (low x, y, z, high x, y, z), and where the children
/// are.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct WideNode {
    planes: [[f32; WIDTH]; 6],
    children: [Child; WIDTH],
    len: u32,
}

/// A ray made ready for many boxes, the same in every lane.
#[derive(Clone, Copy)]
pub(crate) struct Slabs<V> {
    /// Which plane is met first along each axis; the other is met last.
    first: [usize; 3],
    inverse: [V; 3],
    /// o/d, with the origin moved forth so that boxes seem to begin earlier, and back so that they
    /// seem to end later.
    near: [V; 3],
    far: [V; 3],
}

impl<V: Vector<WIDTH>> Slabs<V> {
    /// # Safety
    /// The processor must have the instructions that `V` takes.
    #[inline(always)]
    pub unsafe fn new(ray: &Ray, bounds: &Bounds3) -> Self {
        let slack = slack(ray.o, bounds);
        // SAFETY: as the caller promises.
        unsafe { Self::along(inverse(ray.d), ray.o, slack) }
    }

    /// # Safety
    /// The processor must have the instructions that `V` takes.
    #[inline(always)]
    unsafe fn along(inverse: Vec3, o: Vec3, slack: f32) -> Self {
        let shift = Vec3::splat(slack).copysign(inverse);
        // SAFETY: as the caller promises.
        let splat = |v: Vec3| v.to_array().map(|x| unsafe { V::splat(x) });
        Self {
            first: first_planes(inverse),
            inverse: splat(inverse),
            near: splat((o + shift) * inverse),
            far: splat((o - shift) * inverse),
        }
    }
}

/// Rays from one point, and an interval around their directions [Reshetov et al. 2005].
#[derive(Clone, Copy)]
pub(crate) struct Beam<V> {
    /// One in each lane.
    rays: Slabs<V>,
    /// Two, each in all lanes, whose inverse directions have the least and the greatest size along
    /// each axis, so that they meet each plane before and after all others.
    least: Slabs<V>,
    greatest: Slabs<V>,
}

impl<V: Vector<WIDTH>> Beam<V> {
    /// All rays must come from the same point, and all directions must have the same signs.
    ///
    /// # Safety
    /// The processor must have the instructions that `V` takes.
    #[inline(always)]
    pub unsafe fn new(rays: &[(Ray, f32); WIDTH], bounds: &Bounds3) -> Self {
        let o = rays[0].0.o;
        let slack = slack(o, bounds);
        let mut lanes = [[0.0; WIDTH]; 3];
        let (mut least, mut greatest) = (Vec3::INFINITY, Vec3::ZERO);
        for (lane, (ray, _)) in rays.iter().enumerate() {
            let inverse = inverse(ray.d);
            for axis in 0..3 {
                lanes[axis][lane] = inverse[axis];
            }
            least = least.min(inverse.abs());
            greatest = greatest.max(inverse.abs());
        }
        // SAFETY: as the caller promises.
        unsafe {
            let [mut rays, least, greatest] =
                [greatest, least, greatest].map(|size| Slabs::along(size.copysign(rays[0].0.d), o, slack));
            for axis in 0..3 {
                let shift = slack.copysign(lanes[axis][0]);
                rays.inverse[axis] = V::load(&lanes[axis]);
                rays.near[axis] = rays.inverse[axis].mul(V::splat(o[axis] + shift));
                rays.far[axis] = rays.inverse[axis].mul(V::splat(o[axis] - shift));
            }
            Self { rays, least, greatest }
        }
    }
}

/// 1/d, along every axis a number.
#[inline(always)]
fn inverse(d: Vec3) -> Vec3 {
    // A ray along a slab is in it or not for all its length; a direction that is just not along it
    // says the same within the slack, and has an inverse.
    let least = Vec3::splat(d.abs().max_element() * 1e-12);
    Vec3::select(d.abs().cmplt(least), least.copysign(d), d).recip()
}

#[inline(always)]
fn first_planes(inverse: Vec3) -> [usize; 3] {
    let inverse = inverse.to_array();
    [0, 1, 2].map(|axis| axis + 3 * (inverse[axis] < 0.0) as usize)
}

/// How far planes are moved.
#[inline(always)]
fn slack(o: Vec3, bounds: &Bounds3) -> f32 {
    (bounds.min.abs().max(bounds.max.abs()) + o.abs()).max_element() * gamma(8)
}

impl WideNode {
    pub const EMPTY: Self = Self {
        planes: [
            [f32::INFINITY; WIDTH],
            [f32::INFINITY; WIDTH],
            [f32::INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
        ],
        children: [Child::NOTHING; WIDTH],
        len: 0,
    };

    /// How many children there are.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.len as usize
    }

    /// The children, filled up with [`Child::NOTHING`].
    #[inline(always)]
    pub fn children(&self) -> &[Child; WIDTH] {
        &self.children
    }

    /// Adds a child.
    pub fn push(&mut self, bounds: &Bounds3, child: Child) {
        let lane = self.len();
        self.set_bounds(lane, bounds);
        self.children[lane] = child;
        self.len += 1;
    }

    /// Puts others in the place of all children.
    pub fn renew_children(&mut self, renewed: impl Fn(Child) -> Child) {
        self.children = self.children.map(renewed);
    }

    pub fn set_bounds(&mut self, lane: usize, bounds: &Bounds3) {
        for axis in 0..3 {
            self.planes[axis][lane] = bounds.min[axis];
            self.planes[axis + 3][lane] = bounds.max[axis];
        }
    }

    /// The box around all children.
    pub fn bounds(&self) -> Bounds3 {
        let min = |axis: usize| self.planes[axis].into_iter().fold(f32::INFINITY, f32::min);
        let max = |axis: usize| self.planes[axis].into_iter().fold(f32::NEG_INFINITY, f32::max);
        Bounds3 { min: [0, 1, 2].map(min).into(), max: [3, 4, 5].map(max).into() }
    }

    #[cfg(test)]
    pub fn bounds_of(&self, lane: usize) -> Bounds3 {
        let corner = |first: usize| [0, 1, 2].map(|axis| self.planes[first + axis][lane]).into();
        Bounds3 { min: corner(0), max: corner(3) }
    }

    /// Where each ray enters the box of a child, and a bit for each that does up to its `t_max`.
    #[inline(always)]
    pub fn intersect_rays<V: Vector<WIDTH>>(
        &self,
        lane: usize,
        beam: &Beam<V>,
        t_max: V,
        zero: V,
    ) -> (V, u32) {
        let rays = &beam.rays;
        let (mut near, mut far) = (zero, t_max);
        for axis in 0..3 {
            let first = rays.first[axis];
            // SAFETY: `first` is `axis` or `axis + 3`, and so is the other; lanes are below
            // [`WIDTH`]; whoever has `rays` has the instructions.
            let [enter, leave] = unsafe {
                let first_plane = V::splat(*self.planes.get_unchecked(first).get_unchecked(lane));
                let last_plane =
                    V::splat(*self.planes.get_unchecked(2 * axis + 3 - first).get_unchecked(lane));
                [
                    first_plane.relaxed_mul_sub(rays.inverse[axis], rays.near[axis]),
                    last_plane.relaxed_mul_sub(rays.inverse[axis], rays.far[axis]),
                ]
            };
            near = enter.max(near);
            far = leave.min(far);
        }
        (near, near.le(far))
    }

    /// Where the first of the rays may enter each box, and a bit for each box that any may enter up
    /// to `t_max`.
    #[inline(always)]
    pub fn intersect_beam<V: Vector<WIDTH>>(&self, beam: &Beam<V>, t_max: V, zero: V) -> (V, u32) {
        let Beam { least, greatest, .. } = beam;
        let (mut near, mut far) = (zero, t_max);
        for axis in 0..3 {
            let first = least.first[axis];
            // SAFETY: `first` is `axis` or `axis + 3`, and so is the other; whoever has `beam` has
            // the instructions.
            let [first_plane, last_plane] = unsafe {
                [
                    V::load(self.planes.get_unchecked(first)),
                    V::load(self.planes.get_unchecked(2 * axis + 3 - first)),
                ]
            };
            // Should one of two be no number, then the second is.
            let enter = first_plane
                .relaxed_mul_sub(least.inverse[axis], least.near[axis])
                .min(first_plane.relaxed_mul_sub(greatest.inverse[axis], greatest.near[axis]));
            let leave = last_plane
                .relaxed_mul_sub(least.inverse[axis], least.far[axis])
                .max(last_plane.relaxed_mul_sub(greatest.inverse[axis], greatest.far[axis]));
            near = enter.max(near);
            far = leave.min(far);
        }
        (near, near.le(far))
    }

    /// Where the ray enters each box, and a bit for each box that it enters up to `t_max`.
    /// Comparisons keep the old value beside a NaN, which numbers beyond floats make.
    #[inline(always)]
    pub fn intersect<V: Vector<WIDTH>>(&self, ray: &Slabs<V>, t_max: V, zero: V) -> (V, u32) {
        let mut near = zero;
        let mut far = t_max;
        for axis in 0..3 {
            let first = ray.first[axis];
            // SAFETY: `first` is `axis` or `axis + 3`, and so is the other; whoever has `ray` has
            // the instructions.
            let [enter, leave] = unsafe {
                let first_plane = V::load(self.planes.get_unchecked(first));
                let last_plane = V::load(self.planes.get_unchecked(2 * axis + 3 - first));
                [
                    first_plane.relaxed_mul_sub(ray.inverse[axis], ray.near[axis]),
                    last_plane.relaxed_mul_sub(ray.inverse[axis], ray.far[axis]),
                ]
            };
            near = enter.max(near);
            far = leave.min(far);
        }
        (near, near.le(far))
    }
}
