//! What a leaf tests: four triangles at once.

#![allow(unsafe_code)]

use super::numbers::Numbers;
use super::{Geometry, GeometryId, Hit, InstancePath};
use crate::TriangleMesh;
use crate::bvh::{Extent, Primitives, Reference};
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

    /// Fills a lane. Lanes are filled in order, so that those in use come first.
    #[inline]
    pub fn set(&mut self, lane: usize, corners: [Vec3; 3], number: u32) {
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

/// The triangles of a group's meshes.
pub(super) struct MeshTriangles<'a> {
    /// Each with the number of its first triangle.
    meshes: Vec<(u32, &'a TriangleMesh)>,
}

impl<'a> MeshTriangles<'a> {
    /// Those that have numbers.
    pub fn new(numbers: &Numbers, geometries: &'a [Geometry]) -> Self {
        let mesh = |(id, first): (GeometryId, u32)| match &geometries[id.0 as usize] {
            Geometry::Mesh(mesh) => Some((first, &**mesh)),
            Geometry::Shapes(_) | Geometry::Spheres(_) | Geometry::Curves(_) => None,
        };
        Self { meshes: numbers.meshes().filter_map(mesh).collect() }
    }

    #[inline(always)]
    fn mesh(&self, index: u32) -> &TriangleMesh {
        self.meshes[index as usize].1
    }
}

impl Primitives for MeshTriangles<'_> {
    type Block = Packet;

    fn width(&self) -> usize {
        Packet::WIDTH
    }

    fn geometries(&self) -> Vec<(u32, usize)> {
        (0..).zip(self.meshes.iter().map(|(_, mesh)| mesh.len())).collect()
    }

    #[inline(always)]
    fn extent(&self, mesh: u32, triangle: u32) -> Option<Extent> {
        Extent::around_finite(self.mesh(mesh).corners(triangle as usize))
    }

    #[inline(always)]
    fn prefetch_indices(&self, mesh: u32, triangle: u32) {
        self.mesh(mesh).prefetch_indices(triangle as usize);
    }

    #[inline(always)]
    fn prefetch(&self, mesh: u32, triangle: u32) {
        self.mesh(mesh).prefetch_corners(triangle as usize);
    }

    #[inline(always)]
    fn corners(&self, mesh: u32, triangle: u32) -> Option<[Vec3; 3]> {
        Some(self.mesh(mesh).corners(triangle as usize))
    }

    #[inline(always)]
    fn block(&self, triangles: &[Reference]) -> (Packet, Extent) {
        // Nothing but loads, so that many are under way at once.
        let mut corners = [[Vec3::NAN; 3]; Packet::WIDTH];
        for (corners, r) in corners.iter_mut().zip(triangles) {
            *corners = self.mesh(r.geometry()).corners(r.primitive() as usize);
        }
        let mut packet = Packet::EMPTY;
        let mut extent = Extent::EMPTY;
        for (lane, (r, corners)) in triangles.iter().zip(corners).enumerate() {
            packet.set(lane, corners, self.meshes[r.geometry() as usize].0 + r.primitive());
            extent = extent.union(Extent::around_finite(corners).unwrap_or(Extent::EMPTY));
        }
        (packet, extent)
    }
}
