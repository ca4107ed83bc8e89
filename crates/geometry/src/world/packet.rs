//! What a leaf tests: four triangles at once.

#![allow(unsafe_code)]

use crate::simd::Vector;
use crate::watertight::{LaneHits, ShearedLanes};
use math::Vec3;

/// Triangles of one geometry or of many, corner by corner, axis by axis.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct Packet {
    corners: [[[f32; Packet::WIDTH]; 3]; 3],
    /// Whose triangle each lane holds: geometry and primitive.
    ids: [(u32, u32); Packet::WIDTH],
    len: u32,
}

impl Packet {
    /// Triangles in a packet.
    pub const WIDTH: usize = 4;

    /// Unused lanes hold a triangle that nothing hits.
    pub const EMPTY: Self =
        Self { corners: [[[f32::NAN; Self::WIDTH]; 3]; 3], ids: [(u32::MAX, u32::MAX); Self::WIDTH], len: 0 };

    pub fn push(&mut self, corners: [Vec3; 3], id: (u32, u32)) {
        let lane = self.len();
        for (lanes, corner) in self.corners.iter_mut().zip(corners) {
            for axis in 0..3 {
                lanes[axis][lane] = corner[axis];
            }
        }
        self.ids[lane] = id;
        self.len += 1;
    }

    /// How many lanes are in use.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.len as usize
    }

    #[inline(always)]
    pub fn id(&self, lane: usize) -> (u32, u32) {
        self.ids[lane]
    }

    pub fn triangle(&self, lane: usize) -> [Vec3; 3] {
        self.corners.map(|corner| Vec3::new(corner[0][lane], corner[1][lane], corner[2][lane]))
    }

    /// The triangles that the ray hits up to `t_max`.
    #[inline(always)]
    pub fn intersect<V: Vector<{ Self::WIDTH }>>(
        &self,
        ray: &ShearedLanes<V>,
        t_max: f32,
    ) -> Option<LaneHits<{ Self::WIDTH }>> {
        // SAFETY: whoever has `ray` has the instructions.
        unsafe { ray.intersect(&self.corners, V::splat(t_max)) }
    }
}
