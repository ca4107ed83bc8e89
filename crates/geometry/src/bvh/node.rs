//! Wide nodes: sixteen children, whose boxes are tested together ([Wald et al. 2008]).
//!
//! Traversal is bound by latency: each step depends on the one before, and takes the same time for
//! eight boxes as for sixteen. With sixteen there are fewer steps, which is faster even where
//! vectors are shorter.
//!
//! A ray enters a slab at t = p·(1/d) − o/d, one fused multiply-add; everything but the plane p is
//! precomputed. Boxes are widened by the rounding error, and by that of the watertight triangle
//! test: it rounds vertices after translating them to the ray's origin, so that it may hit a
//! triangle that the exact ray misses by γ(8) times the distance. Without this margin such a ray
//! could pass through a closed surface.
//!
//! Distances are compared as integers, which takes a quarter of the time on Intel's processors.
//! The largest of the entries and zero is right, as it is not negative; the smallest of the exits
//! and `t_max` has the right sign at least, and a negative one is a miss. NaN is excluded: rays
//! with which a product could overflow visit every node.

#![allow(unsafe_code)]

use lanes::{Each, Vector};
use math::{Bounds3, Ray, Vec3, gamma};

/// Children of a node, and rays of a packet.
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
    pub const EMPTY: Self = Self(Self::LEAF);

    /// The node at an index.
    #[inline(always)]
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

    /// The index of the node.
    #[inline(always)]
    pub fn index(self) -> usize {
        self.0 as usize
    }

    /// The blocks of the leaf.
    #[inline(always)]
    pub fn blocks(self) -> std::ops::Range<usize> {
        let first = ((self.0 & !Self::LEAF) >> Self::BLOCK_BITS) as usize;
        first..first + (self.0 as usize & Self::MAX_BLOCKS)
    }
}

/// A node: the six planes of each child's box (low x, y, z, high x, y, z), and the children.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct WideNode {
    pub(super) planes: [[f32; WIDTH]; 6],
    children: [Child; WIDTH],
    len: u32,
}

/// A ray prepared for slab tests: numbers, or the same in every lane.
#[derive(Clone, Copy)]
pub(crate) struct RaySlabs<V> {
    /// The offsets in bytes of the planes that are crossed first and last along each axis.
    pub first: [usize; 3],
    pub last: [usize; 3],
    pub inverse: [V; 3],
    /// o/d, with the origin moved forward for near planes and back for far planes, which widens the
    /// boxes.
    pub near: [V; 3],
    pub far: [V; 3],
}

impl RaySlabs<f32> {
    /// `bounds` are those of the tree.
    #[inline(always)]
    pub fn new(ray: &Ray, bounds: &Bounds3) -> Self {
        let size = size(ray.o, bounds);
        let largest = ray.d.abs().max_element();
        if is_moderate(size, largest) {
            Self::along(&ray.d, inverse(ray.d, largest), [ray.o; 2], size * MARGIN)
        } else {
            Self::everywhere()
        }
    }

    /// A ray that meets every box.
    #[inline(always)]
    pub fn everywhere() -> Self {
        let [first, last] = planes_along(&Vec3::ONE);
        Self { first, last, inverse: [f32::MIN_POSITIVE; 3], near: [1e30; 3], far: [-1e30; 3] }
    }

    /// A ray that crosses first planes from `front` and last planes from `back`.
    #[inline(always)]
    pub fn along(d: &Vec3, inverse: Vec3, [front, back]: [Vec3; 2], margin: f32) -> Self {
        let shift = Vec3::splat(margin).copysign(inverse);
        let [first, last] = planes_along(d);
        let (near, far) = ((front + shift) * inverse, (back - shift) * inverse);
        Self { first, last, inverse: inverse.into(), near: near.into(), far: far.into() }
    }

    /// The same in every lane.
    ///
    /// # Safety
    /// The processor must have the instruction set of `V`.
    #[inline(always)]
    pub unsafe fn lanes<V: Vector<WIDTH>>(&self) -> RaySlabs<V> {
        let Self { first, last, inverse, near, far } = *self;
        // SAFETY: as the caller promises.
        let splat = |v: [f32; 3]| unsafe { [V::splat(v[0]), V::splat(v[1]), V::splat(v[2])] };
        RaySlabs { first, last, inverse: splat(inverse), near: splat(near), far: splat(far) }
    }
}

/// 1/d, finite along every axis.
#[inline(always)]
fn inverse(d: Vec3, largest: f32) -> Vec3 {
    // A ray parallel to a slab is inside of it or outside for all its length; a direction that is
    // almost parallel gives the same answer within the margin, and has an inverse.
    let least = Vec3::splat(largest * 1e-12);
    d.zip(least, |d, least| if d.abs() < least { least.copysign(d) } else { d }).recip()
}

/// Whether nothing overflows in slab tests, and no inverse is too small for floats, given a bound
/// of all coordinates and the largest component of the direction.
#[inline(always)]
pub(super) fn is_moderate(size: f32, largest: f32) -> bool {
    size < 1e30 && size < 1e20 * largest && 1e-25 < largest && largest < 1e37
}

/// Bytes of the planes of one side of all boxes.
pub(super) const PLANE: usize = size_of::<[f32; WIDTH]>();

/// The offsets in bytes of the planes that a ray crosses first and last along each axis.
#[inline(always)]
fn planes_along(d: &Vec3) -> [[usize; 3]; 2] {
    let [x, y, z] = d.to_array().each(|d| 3 * PLANE * (d.to_bits() >> 31) as usize);
    [[x, PLANE + y, 2 * PLANE + z], [3 * PLANE - x, 4 * PLANE - y, 5 * PLANE - z]]
}

/// The distance that planes are moved by, relative to the bound of coordinates.
pub(super) const MARGIN: f32 = gamma(8);

/// A bound of the coordinates of an origin and of a tree.
#[inline(always)]
pub(super) fn size(o: Vec3, bounds: &Bounds3) -> f32 {
    (bounds.min.abs().max(bounds.max.abs()) + o.abs()).max_element()
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
        children: [Child::EMPTY; WIDTH],
        len: 0,
    };

    /// The number of children.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.len as usize
    }

    /// The children, filled up with [`Child::EMPTY`].
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

    /// Replaces all children.
    pub fn replace_children(&mut self, replaced: impl Fn(Child) -> Child) {
        self.children = self.children.map(replaced);
    }

    /// Replaces the box of a child.
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

    /// The children with their boxes.
    pub fn boxes(&self) -> impl Iterator<Item = (Bounds3, Child)> {
        (0..self.len()).map(|lane| (self.bounds_of(lane), self.children[lane]))
    }

    /// The box of a child.
    pub fn bounds_of(&self, lane: usize) -> Bounds3 {
        let corner = |first: usize| [0, 1, 2].map(|axis| self.planes[first + axis][lane]).into();
        Bounds3 { min: corner(0), max: corner(3) }
    }

    /// Where the ray crosses the planes of each box along an axis, first and last.
    #[inline(always)]
    fn slabs<V: Vector<WIDTH>>(&self, ray: &RaySlabs<V>, axis: usize) -> [V; 2] {
        let planes = (&raw const self.planes).cast::<u8>();
        // SAFETY: offsets are those of planes; `ray` is the proof of the instruction set.
        unsafe {
            let first = V::load(&*planes.add(ray.first[axis]).cast());
            let last = V::load(&*planes.add(ray.last[axis]).cast());
            [
                first.relaxed_mul_sub(ray.inverse[axis], ray.near[axis]),
                last.relaxed_mul_sub(ray.inverse[axis], ray.far[axis]),
            ]
        }
    }

    /// Where the ray enters each box, and a bit for each box that it enters before `t_max`.
    #[inline(always)]
    pub fn intersect<V: Vector<WIDTH>>(&self, ray: &RaySlabs<V>, t_max: V, zero: V) -> (V, u32) {
        let ([x, last_x], [y, last_y], [z, last_z]) =
            (self.slabs(ray, 0), self.slabs(ray, 1), self.slabs(ray, 2));
        let near = x.max_int(y).max_int(z.max_int(zero));
        let far = last_x.min_int(last_y).min_int(last_z.min_int(t_max));
        (near, near.le(far))
    }
}
