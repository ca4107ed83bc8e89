//! What a leaf tests: four triangles at once.
//!
//! Neighbours share vertices, and each is stored, moved and sheared only once. Four triangles that
//! have more than eight between them are put into two packets.

#![allow(unsafe_code)]

use super::numbers::Numbers;
use super::{Geometry, Hit, InstancePath};
use crate::TriangleMesh;
use crate::bvh::{Extent, Primitives, Reference};
use crate::watertight::{LaneHits, Sheared, ShearedLanes};
use lanes::{Simd, Vector, first_equal};
use math::{Bounds3, Vec2, Vec3};

/// Triangles of one geometry or of many: two lines of the cache.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Packet {
    /// Axis by axis.
    vertices: [[f32; Packet::VERTICES]; 3],
    /// Which vertices are the corners of the triangle in each lane: a byte for each corner.
    corners: [u32; Packet::WIDTH],
    /// The number of the triangle that each lane holds.
    numbers: [u32; Packet::WIDTH],
}

impl Packet {
    /// Triangles in a packet.
    pub const WIDTH: usize = 4;

    /// Vertices that these may have.
    pub const VERTICES: usize = 8;

    /// The number of a lane that is not in use.
    const NOTHING: u32 = u32::MAX;

    #[inline(always)]
    fn set_vertex(&mut self, vertex: usize, position: Vec3) {
        for axis in 0..3 {
            self.vertices[axis][vertex] = position[axis];
        }
    }

    /// Which vertex is a corner of the triangle in a lane.
    #[inline(always)]
    fn vertex(&self, lane: usize, corner: usize) -> usize {
        (self.corners[lane] >> (8 * corner)) as usize % Self::VERTICES
    }

    /// Fetches all vertices again; gives the box around the triangles. Nothing hits those that are
    /// not finite.
    pub fn renew(&mut self, corners: impl Fn(u32) -> Option<[Vec3; 3]>) -> Bounds3 {
        let mut bounds = Bounds3::EMPTY;
        for lane in 0..self.len() {
            let corners = corners(self.numbers[lane]).unwrap_or([Vec3::NAN; 3]);
            let is_finite = corners.iter().all(|p| p.is_finite());
            bounds = if is_finite { bounds.union(Bounds3::around(corners)) } else { bounds };
            for (corner, position) in corners.into_iter().enumerate() {
                let position = if position.is_finite() { position } else { Vec3::NAN };
                self.set_vertex(self.vertex(lane, corner), position);
            }
        }
        bounds
    }

    /// How many lanes are in use.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.numbers.iter().map(|&number| (number != Self::NOTHING) as u32).sum::<u32>() as usize
    }

    pub fn triangle(&self, lane: usize) -> [Vec3; 3] {
        [0, 1, 2].map(|corner| Vec3::from(self.vertices.map(|axis| axis[self.vertex(lane, corner)])))
    }

    /// The triangles that the ray hits up to `t_max`.
    #[inline(always)]
    pub fn intersect<S: Simd>(
        &self,
        ray: &ShearedLanes<S::F32x8>,
        t_max: f32,
    ) -> Option<LaneHits<{ Self::WIDTH }>> {
        // SAFETY: axes are below 3, and whoever has `ray` has the instructions.
        let (vertices, t_max) = unsafe {
            let coordinate = |axis: usize| S::F32x8::load(self.vertices.get_unchecked(axis));
            (ray.shear(coordinate), S::F32x4::splat(t_max))
        };
        let corners = [
            vertices.map(|v| S::permute::<0>(v, &self.corners)),
            vertices.map(|v| S::permute::<1>(v, &self.corners)),
            vertices.map(|v| S::permute::<2>(v, &self.corners)),
        ];
        LaneHits::of(corners, t_max)
    }

    /// Those of several rays that hit one triangle up to `t_max`.
    #[inline(always)]
    pub fn intersect_rays<const N: usize, V: Vector<N>>(
        &self,
        lane: usize,
        rays: &ShearedLanes<V>,
        t_max: V,
    ) -> Option<LaneHits<N>> {
        let corner = |corner: usize| {
            let vertex = self.vertex(lane, corner);
            // SAFETY: whoever has `rays` has the instructions.
            rays.shear(|axis| unsafe { V::splat(self.vertices[axis][vertex]) })
        };
        LaneHits::of([corner(0), corner(1), corner(2)], t_max)
    }

    /// What lane `of` of `found` says of the triangle in `lane`: its hit, unless there is no such
    /// triangle or a doubt is decided against it.
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
        if self.numbers[lane] == Self::NOTHING {
            return None;
        }
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
    meshes: Vec<Numbered<'a>>,
}

/// A mesh, and the numbers of its first triangle and vertex.
struct Numbered<'a> {
    mesh: &'a TriangleMesh,
    first: u32,
    first_vertex: u32,
}

impl<'a> MeshTriangles<'a> {
    /// Those that have numbers.
    pub fn new(numbers: &Numbers, geometries: &'a [Geometry]) -> Self {
        let (mut meshes, mut vertices) = (Vec::new(), 0);
        for (id, first) in numbers.meshes() {
            if let Geometry::Mesh(mesh) = &geometries[id.0 as usize] {
                meshes.push(Numbered { mesh, first, first_vertex: vertices as u32 });
                vertices += mesh.vertices();
                assert!(vertices < u32::MAX as usize, "too many vertices for numbers of 32 bits");
            }
        }
        Self { meshes }
    }

    #[inline(always)]
    fn mesh(&self, index: u32) -> &TriangleMesh {
        self.meshes[index as usize].mesh
    }
}

impl Primitives for MeshTriangles<'_> {
    type Block = Packet;
    const COST: f32 = 0.2;

    fn width(&self) -> usize {
        Packet::WIDTH
    }

    fn geometries(&self) -> Vec<(u32, usize)> {
        (0..).zip(self.meshes.iter().map(|numbered| numbered.mesh.len())).collect()
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
    fn block(&self, triangles: &[Reference]) -> (Packet, usize, Extent) {
        const CORNERS: usize = 3 * Packet::WIDTH;
        let mut positions = [Vec3::ZERO; CORNERS + 1];
        let mut keys = [u32::MAX; 16];
        let mut numbers = [Packet::NOTHING; Packet::WIDTH];
        for (lane, r) in triangles.iter().enumerate() {
            let Numbered { mesh, first, first_vertex } = &self.meshes[r.geometry() as usize];
            let indices = mesh.indices(r.primitive() as usize);
            for corner in 0..3 {
                positions[3 * lane + corner] = mesh.position(indices[corner]);
                keys[3 * lane + corner] = first_vertex + indices[corner];
            }
            numbers[lane] = first + r.primitive();
        }
        // For vertices that are not in use.
        positions[CORNERS] = positions[0];
        // For each corner the first one with the same vertex, and a bit for each that is the first.
        let mut firsts = [0; CORNERS];
        let mut new: u32 = 0;
        for (corner, first) in firsts.iter_mut().enumerate() {
            *first = first_equal(&keys, corner);
            new |= ((*first == corner) as u32) << corner;
        }
        let before = |corner: usize| (new & ((1 << corner) - 1)).count_ones();
        let mut taken = triangles.len();
        while before(3 * taken) as usize > Packet::VERTICES {
            taken -= 1;
        }
        let mut packet = Packet {
            vertices: [[0.0; Packet::VERTICES]; 3],
            corners: [0; Packet::WIDTH],
            numbers: [Packet::NOTHING; Packet::WIDTH],
        };
        let mut extent = Extent::EMPTY;
        let mut left = new & ((1 << (3 * taken)) - 1) | 1 << CORNERS;
        for vertex in 0..Packet::VERTICES {
            let corner = left.trailing_zeros();
            left &= left - (corner < CORNERS as u32) as u32;
            let position = positions[corner as usize];
            packet.set_vertex(vertex, position);
            extent = extent.union(Extent::point(position.extend(0.0)));
        }
        packet.numbers[..taken].copy_from_slice(&numbers[..taken]);
        for (lane, corners) in packet.corners.iter_mut().enumerate() {
            // Lanes that are not in use repeat the first triangle, so that the test ends for them
            // as soon as for that one.
            let triangle = if lane < taken { lane } else { 0 };
            let [a, b, c] = [0, 1, 2].map(|corner| before(firsts[3 * triangle + corner]));
            *corners = a | b << 8 | c << 16;
        }
        (packet, taken, extent)
    }
}
