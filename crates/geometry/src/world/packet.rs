//! What a leaf tests: several triangles at once.
//!
//! A packet only says which of its triangles the ray may hit; each of those few is then put to the scalar
//! test, which has the last word. Both compute the same numbers, so that a packet refuses nothing that the
//! scalar test would keep.

use crate::watertight::{Sheared, is_vanishing, weighted};
use math::{Vec3, difference_of_products};

/// Triangles of one geometry or of many, corner by corner, axis by axis.
#[derive(Clone, Debug)]
#[repr(align(32))]
pub(crate) struct Packet {
    corners: [[[f32; Packet::WIDTH]; 3]; 3],
    /// Whose triangle each lane holds: geometry and primitive.
    pub ids: [(u32, u32); Packet::WIDTH],
    /// How many lanes are in use.
    pub len: usize,
}

impl Packet {
    /// Triangles in a packet.
    pub const WIDTH: usize = 4;

    /// Unused lanes hold a triangle that nothing hits.
    pub const EMPTY: Self =
        Self { corners: [[[0.0; Self::WIDTH]; 3]; 3], ids: [(u32::MAX, u32::MAX); Self::WIDTH], len: 0 };

    pub fn push(&mut self, corners: [Vec3; 3], id: (u32, u32)) {
        for (lanes, corner) in self.corners.iter_mut().zip(corners) {
            for axis in 0..3 {
                lanes[axis][self.len] = corner[axis];
            }
        }
        self.ids[self.len] = id;
        self.len += 1;
    }

    #[inline]
    pub fn triangle(&self, lane: usize) -> [Vec3; 3] {
        self.corners.map(|corner| Vec3::new(corner[0][lane], corner[1][lane], corner[2][lane]))
    }

    /// A bit for each triangle that the ray may hit before `t_max`.
    #[inline]
    pub fn candidates(&self, ray: &Sheared, t_max: f32) -> u32 {
        let [ax, ay, az] = ray.axes;
        let [sx, sy, sz] = ray.shear;
        let o = [ray.o[ax], ray.o[ay], ray.o[az]];
        let mut sheared = [[[0f32; Self::WIDTH]; 3]; 3];
        for (out, corner) in sheared.iter_mut().zip(&self.corners) {
            let [x, y, z] = [&corner[ax], &corner[ay], &corner[az]];
            for i in 0..Self::WIDTH {
                let vz = z[i] - o[2];
                out[0][i] = sx.mul_add(vz, x[i] - o[0]);
                out[1][i] = sy.mul_add(vz, y[i] - o[1]);
                out[2][i] = vz * sz;
            }
        }
        let [a, b, c] = &sheared;
        let mut hits = [0u32; Self::WIDTH];
        for i in 0..Self::WIDTH {
            let edge = |p: &[[f32; Self::WIDTH]; 3], q: &[[f32; Self::WIDTH]; 3]| {
                difference_of_products(p[0][i], q[1][i], p[1][i], q[0][i])
            };
            let e = [edge(b, c), edge(c, a), edge(a, b)];
            let determinant = e[0] + e[1] + e[2];
            let t = weighted(e, [a[2][i], b[2][i], c[2][i]]) * (1.0 / determinant);
            let mixed =
                ((e[0] < 0.0) | (e[1] < 0.0) | (e[2] < 0.0)) & ((e[0] > 0.0) | (e[1] > 0.0) | (e[2] > 0.0));
            let unsure = is_vanishing(e[0]) | is_vanishing(e[1]) | is_vanishing(e[2]);
            hits[i] = ((!mixed & (t < t_max)) | unsure) as u32;
        }
        let mut bits = 0;
        for (i, hit) in hits.iter().enumerate() {
            bits |= hit << i;
        }
        bits & ((1 << self.len) - 1)
    }
}
