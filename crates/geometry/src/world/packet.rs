//! What a leaf tests: four triangles at once.

#![allow(unsafe_code)]

use super::numbers::Numbers;
use super::{Hit, InstancePath};
use crate::simd::Vector;
use crate::watertight::{LaneHits, Sheared, ShearedLanes};
use math::{Vec2, Vec3};

/// Triangles of one geometry or of many, corner by corner, axis by axis.
#[derive(Clone, Debug)]
#[repr(C, align(32))]
pub(crate) struct Packet {
    corners: [[[f32; Packet::WIDTH]; 3]; 3],
    /// The number of the triangle that each lane holds.
    numbers: [u32; Packet::WIDTH],
}

impl Packet {
    /// Triangles in a packet.
    pub const WIDTH: usize = 4;

    /// The number of a lane that is not in use.
    const NOTHING: u32 = u32::MAX;

    /// Unused lanes hold a triangle that nothing hits.
    pub const EMPTY: Self =
        Self { corners: [[[f32::NAN; Self::WIDTH]; 3]; 3], numbers: [Self::NOTHING; Self::WIDTH] };

    pub fn push(&mut self, corners: [Vec3; 3], number: u32) {
        let lane = self.len();
        for (lanes, corner) in self.corners.iter_mut().zip(corners) {
            for axis in 0..3 {
                lanes[axis][lane] = corner[axis];
            }
        }
        self.numbers[lane] = number;
    }

    /// How many lanes are in use.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.numbers.iter().map(|&number| (number != Self::NOTHING) as u32).sum::<u32>() as usize
    }

    /// The numbers of the triangles.
    pub fn numbers(&self) -> &[u32] {
        &self.numbers[..self.len()]
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
        // SAFETY: corners and axes are below 3, and whoever has `ray` has the instructions.
        unsafe {
            let corner = |k: usize, axis: usize| V::load(self.corners.get_unchecked(k).get_unchecked(axis));
            ray.intersect(corner, V::splat(t_max))
        }
    }

    /// Those of several rays that hit one triangle up to `t_max`.
    #[inline(always)]
    pub fn intersect_rays<const N: usize, V: Vector<N>>(
        &self,
        lane: usize,
        rays: &ShearedLanes<V>,
        t_max: V,
    ) -> Option<LaneHits<N>> {
        // SAFETY: whoever has `rays` has the instructions.
        unsafe { rays.intersect(|k, axis| V::splat(self.corners[k][axis][lane]), t_max) }
    }

    /// What lane `of` of `found` says of the triangle in `lane`: its hit, unless a doubt is decided against it.
    #[inline(always)]
    pub fn hit<const N: usize>(
        &self,
        lane: usize,
        found: &LaneHits<N>,
        of: usize,
        ray: &Sheared,
        numbers: &Numbers,
        instance: InstancePath,
    ) -> Option<Hit> {
        let (mut t, mut uv) = (found.t[of], Vec2::new(found.b1[of], found.b2[of]));
        if found.doubts >> of & 1 != 0 {
            (t, uv) = ray.decide(&self.triangle(lane))?;
        }
        let (geometry, primitive) = numbers.id(self.numbers[lane]);
        Some(Hit { t, uv, geometry, primitive, instance })
    }
}
