//! Blocks of four triangles, which are tested at once, or those of two blocks.
//!
//! Neighbouring triangles share vertices; each vertex is stored, translated and sheared only once.
//! Four triangles with more than eight vertices are put into two blocks.

#![allow(unsafe_code)]

use super::hit::Hit;
use super::instance::InstancePath;
use super::triangle_numbering::TriangleNumbering;
use crate::bvh::Extent;
use crate::watertight::{LaneHits, Sheared, ShearedLanes};
use lanes::{Each, Simd, Vector, first_equal};
use math::{Bounds3, Vec3};

/// Four triangles of any geometries, in two cache lines.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct TriangleBlock {
    /// x, y and z of the vertices.
    vertices: [[f32; TriangleBlock::VERTICES]; 3],
    /// The vertex indices of the triangle in each lane: a byte for each corner.
    corners: [u32; TriangleBlock::WIDTH],
    /// The number of the triangle in each lane.
    numbers: [u32; TriangleBlock::WIDTH],
}

impl TriangleBlock {
    /// Triangles in a block.
    pub const WIDTH: usize = 4;

    /// The most vertices of a block.
    pub const VERTICES: usize = 8;

    /// The number of an unused lane.
    const UNUSED: u32 = u32::MAX;

    /// A block of the first of `len` triangles, as many as their vertices allow, with their number
    /// and the box around them. `triangle` gives number, vertex ids and positions of a triangle.
    #[inline(always)]
    pub fn new(len: usize, triangle: impl Fn(usize) -> (u32, [u32; 3], [Vec3; 3])) -> (Self, usize, Extent) {
        const CORNERS: usize = 3 * TriangleBlock::WIDTH;
        let mut positions = [Vec3::ZERO; CORNERS + 1];
        let mut ids = [u32::MAX; 16];
        let mut numbers = [Self::UNUSED; Self::WIDTH];
        for lane in 0..len {
            let (number, triangle_ids, triangle_positions) = triangle(lane);
            for corner in 0..3 {
                positions[3 * lane + corner] = triangle_positions[corner];
                ids[3 * lane + corner] = triangle_ids[corner];
            }
            numbers[lane] = number;
        }
        // For unused vertices.
        positions[CORNERS] = positions[0];
        // For each corner the first one with the same vertex, and a bit where that is itself.
        let mut firsts = [0; CORNERS];
        let mut is_first: u32 = 0;
        for (corner, first) in firsts.iter_mut().enumerate() {
            *first = first_equal(&ids, corner);
            is_first |= ((*first == corner) as u32) << corner;
        }
        let vertices_before = |corner: usize| (is_first & ((1 << corner) - 1)).count_ones();
        let mut taken = len;
        while vertices_before(3 * taken) as usize > Self::VERTICES {
            taken -= 1;
        }
        let mut block = Self {
            vertices: [[0.0; Self::VERTICES]; 3],
            corners: [0; Self::WIDTH],
            numbers: [Self::UNUSED; Self::WIDTH],
        };
        let mut extent = Extent::EMPTY;
        let mut left = is_first & ((1 << (3 * taken)) - 1) | 1 << CORNERS;
        for vertex in 0..Self::VERTICES {
            let corner = left.trailing_zeros();
            left &= left - (corner < CORNERS as u32) as u32;
            let position = positions[corner as usize];
            block.set_vertex(vertex, position);
            extent = extent.union(Extent::point(position.extend(0.0)));
        }
        block.numbers[..taken].copy_from_slice(&numbers[..taken]);
        for (lane, corners) in block.corners.iter_mut().enumerate() {
            // Unused lanes repeat the first triangle, so that the test ends as early for them.
            let triangle = if lane < taken { lane } else { 0 };
            let [a, b, c] = [0, 1, 2].map(|corner| vertices_before(firsts[3 * triangle + corner]));
            *corners = a | b << 8 | c << 16;
        }
        (block, taken, extent)
    }

    #[inline(always)]
    fn set_vertex(&mut self, vertex: usize, position: Vec3) {
        for axis in 0..3 {
            self.vertices[axis][vertex] = position[axis];
        }
    }

    /// The vertex index of a corner of the triangle in a lane.
    #[inline(always)]
    fn vertex(&self, lane: usize, corner: usize) -> usize {
        (self.corners[lane] >> (8 * corner)) as usize % Self::VERTICES
    }

    /// Reloads all vertices and returns the box around the triangles. Triangles that are not finite
    /// are never hit.
    pub fn reload(&mut self, corners: impl Fn(u32) -> Option<[Vec3; 3]>) -> Bounds3 {
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

    /// The number of lanes in use.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.numbers.iter().map(|&number| (number != Self::UNUSED) as u32).sum::<u32>() as usize
    }

    /// The numbers of the triangles, in the order of lanes.
    pub fn numbers(&self) -> impl Iterator<Item = u32> {
        self.numbers.into_iter().take(self.len())
    }

    /// The corners of the triangle in a lane.
    pub fn triangle(&self, lane: usize) -> [Vec3; 3] {
        let [xs, ys, zs] = &self.vertices;
        let mut corners = [Vec3::ZERO; 3];
        for (corner, position) in corners.iter_mut().enumerate() {
            let vertex = self.vertex(lane, corner);
            *position = Vec3::new(xs[vertex], ys[vertex], zs[vertex]);
        }
        corners
    }

    /// Tests the ray against all triangles up to `t_max`.
    #[inline(always)]
    pub fn intersect<S: Simd>(&self, ray: &ShearedLanes<S::F32x8>, t_max: f32) -> Option<LaneHits<S::F32x4>> {
        let vertices = self.sheared(ray);
        let corners = [
            vertices.each(|v| S::permute::<0>(v, &self.corners)),
            vertices.each(|v| S::permute::<1>(v, &self.corners)),
            vertices.each(|v| S::permute::<2>(v, &self.corners)),
        ];
        // SAFETY: `ray` is the proof of the instruction set.
        LaneHits::of(corners, unsafe { S::F32x4::splat(t_max) })
    }

    /// The same for two blocks at once: the triangles of the first are in the low half of the
    /// lanes.
    #[inline(always)]
    pub fn intersect_both<S: Simd>(
        blocks: [&Self; 2],
        ray: &ShearedLanes<S::F32x8>,
        t_max: f32,
    ) -> Option<LaneHits<S::F32x8>> {
        let [a, b] = blocks.each(|block| block.sheared(ray));
        let (vertices, corners) =
            ([0, 1, 2].each(|axis: usize| [a[axis], b[axis]]), blocks.each(|block| &block.corners));
        let corners = [
            vertices.each(|v| S::permute_both::<0>(v, corners)),
            vertices.each(|v| S::permute_both::<1>(v, corners)),
            vertices.each(|v| S::permute_both::<2>(v, corners)),
        ];
        // SAFETY: `ray` is the proof of the instruction set.
        LaneHits::of(corners, unsafe { S::F32x8::splat(t_max) })
    }

    /// The vertices, translated and sheared.
    #[inline(always)]
    fn sheared<V: Vector<{ TriangleBlock::VERTICES }>>(&self, ray: &ShearedLanes<V>) -> [V; 3] {
        // SAFETY: axes are below 3; `ray` is the proof of the instruction set.
        ray.shear(|axis| unsafe { V::load(self.vertices.get_unchecked(axis)) })
    }

    /// Tests several rays against the triangle in a lane, each up to its `t_max`.
    #[inline(always)]
    pub fn intersect_rays<const N: usize, V: Vector<N>>(
        &self,
        lane: usize,
        rays: &ShearedLanes<V>,
        t_max: V,
    ) -> Option<LaneHits<V>> {
        let corner = |corner: usize| {
            let vertex = self.vertex(lane, corner);
            // SAFETY: `rays` is the proof of the instruction set.
            rays.shear(|axis| unsafe { V::splat(self.vertices[axis][vertex]) })
        };
        LaneHits::of([corner(0), corner(1), corner(2)], t_max)
    }

    /// The hit in lane `of` of `found` on the triangle in `lane`; `None` where that lane is unused,
    /// or where the hit was uncertain and turns out to be a miss.
    #[inline(always)]
    pub fn hit<const N: usize, V: Vector<N>>(
        &self,
        lane: usize,
        found: &LaneHits<V>,
        of: usize,
        ray: &Sheared,
        numbering: &TriangleNumbering,
        instance: InstancePath,
    ) -> Option<Hit> {
        if self.numbers[lane] == Self::UNUSED {
            return None;
        }
        let (mut t, mut uv) = found.at(of);
        if found.uncertain >> of & 1 != 0 {
            (t, uv) = ray.resolve(&self.triangle(lane))?;
        }
        let (geometry, primitive) = numbering.id(self.numbers[lane]);
        Some(Hit { t, uv, geometry, primitive, instance })
    }
}
