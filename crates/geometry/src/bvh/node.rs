//! Nodes of eight children, whose boxes are tested together.
//!
//! The idea is that of [Wald et al. 2008]. The slab test is the one of [`Bounds3::intersect`], with one
//! difference: it widens boxes by what the watertight triangle test may err. That test rounds vertices after
//! moving them to the ray's origin, so that it may meet a triangle that the exact ray misses by γ(8) times
//! the distance; a box that is not as generous would let such a ray slip through a closed surface.

use math::{Bounds3, Ray, gamma};

/// Children of a node.
pub(crate) const WIDTH: usize = 8;

/// A child: blocks of primitives, or (when there are none) the node `first`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Child {
    pub first: u32,
    pub blocks: u32,
}

/// A node: the six planes of each child's box (low x, y, z, high x, y, z), and where the children are.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(crate) struct WideNode {
    planes: [[f32; WIDTH]; 6],
    first: [u32; WIDTH],
    blocks: [u8; WIDTH],
    len: u8,
}

/// A ray made ready for many boxes.
pub(crate) struct Slabs {
    /// Which plane is met first, and which last, along each axis.
    planes: [[usize; 2]; 3],
    /// The origin, moved forth and back so that boxes seem wider.
    origins: [[f32; 2]; 3],
    /// 1/d; the second a little longer, to cover the rounding of the test.
    inverse: [[f32; 2]; 3],
}

impl Slabs {
    pub fn new(ray: &Ray, bounds: &Bounds3) -> Self {
        let reach = (bounds.min - ray.o).abs().max((bounds.max - ray.o).abs()).max_element();
        let slack = reach * gamma(8);
        let inverse = ray.d.recip();
        let backwards = [0, 1, 2].map(|axis| inverse[axis] < 0.0);
        Self {
            planes: [0, 1, 2].map(|axis| if backwards[axis] { [axis + 3, axis] } else { [axis, axis + 3] }),
            origins: [0, 1, 2].map(|axis| {
                let slack = if backwards[axis] { -slack } else { slack };
                [ray.o[axis] + slack, ray.o[axis] - slack]
            }),
            inverse: [0, 1, 2].map(|axis| [inverse[axis], inverse[axis] * (1.0 + 2.0 * gamma(3))]),
        }
    }
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
        first: [0; WIDTH],
        blocks: [0; WIDTH],
        len: 0,
    };

    #[inline]
    pub fn len(&self) -> usize {
        self.len as usize
    }

    #[inline]
    pub fn child(&self, lane: usize) -> Child {
        Child { first: self.first[lane], blocks: self.blocks[lane] as u32 }
    }

    pub fn push(&mut self, bounds: &Bounds3, child: Child) {
        let lane = self.len();
        for axis in 0..3 {
            self.planes[axis][lane] = bounds.min[axis];
            self.planes[axis + 3][lane] = bounds.max[axis];
        }
        self.first[lane] = child.first;
        self.blocks[lane] = child.blocks as u8;
        self.len += 1;
    }

    /// Where the ray enters each box, and a bit for each box that it enters before `t_max`.
    /// Comparisons keep the old value beside a NaN, which 0 · ∞ makes when the ray runs along a slab.
    #[inline]
    pub fn intersect(&self, ray: &Slabs, t_max: f32) -> ([f32; WIDTH], u32) {
        let mut near = [0f32; WIDTH];
        let mut far = [t_max; WIDTH];
        for axis in 0..3 {
            let [first, last] = ray.planes[axis].map(|plane| &self.planes[plane]);
            let [o_near, o_far] = ray.origins[axis];
            let [inverse_near, inverse_far] = ray.inverse[axis];
            for lane in 0..WIDTH {
                let enter = (first[lane] - o_near) * inverse_near;
                let leave = (last[lane] - o_far) * inverse_far;
                near[lane] = if enter > near[lane] { enter } else { near[lane] };
                far[lane] = if leave < far[lane] { leave } else { far[lane] };
            }
        }
        let mut hits = 0;
        for lane in 0..WIDTH {
            hits |= ((near[lane] <= far[lane]) as u32) << lane;
        }
        (near, hits & ((1 << self.len) - 1))
    }
}
