//! The triangles of a group's meshes: a tree over blocks of four.

use super::geometry::{Geometry, GeometryId};
use super::triangle_block::TriangleBlock;
use super::triangle_numbering::TriangleNumbering;
use crate::bvh::{BuildQuality, Bvh, Extent, Primitives, Reference};
use crate::shape::TriangleMesh;
use math::Vec3;

/// All triangles of a group.
#[derive(Clone, Debug)]
pub(super) struct Triangles {
    pub tree: Bvh,
    pub blocks: Vec<TriangleBlock>,
    pub numbering: TriangleNumbering,
}

impl Triangles {
    pub fn build(members: &[GeometryId], geometries: &[Geometry], quality: BuildQuality) -> Self {
        let numbering = TriangleNumbering::new(members, geometries);
        let (tree, blocks) = Bvh::build(&Meshes::new(&numbering, geometries), quality);
        Self { tree, blocks, numbering }
    }

    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// Reloads blocks and boxes after vertices have moved.
    pub fn refit(&mut self, geometries: &[Geometry]) {
        let numbering = &self.numbering;
        let corners = |number| numbering.corners(number, geometries);
        self.tree.refit(&mut self.blocks, |block| block.reload(corners));
    }

    /// Bytes of memory of tree and blocks.
    pub fn bytes(&self) -> usize {
        self.tree.bytes() + size_of_val(&*self.blocks) + self.numbering.bytes()
    }
}

/// The meshes of a group, as a tree is built over their triangles.
struct Meshes<'a>(Vec<NumberedMesh<'a>>);

/// A mesh, and the numbers of its first triangle and vertex.
struct NumberedMesh<'a> {
    mesh: &'a TriangleMesh,
    first_triangle: u32,
    first_vertex: u32,
}

impl<'a> Meshes<'a> {
    fn new(numbering: &TriangleNumbering, geometries: &'a [Geometry]) -> Self {
        let (mut meshes, mut vertices) = (Vec::new(), 0);
        for (id, first_triangle) in numbering.meshes() {
            if let Geometry::Mesh(mesh) = &geometries[id.0 as usize] {
                meshes.push(NumberedMesh { mesh, first_triangle, first_vertex: vertices as u32 });
                vertices += mesh.vertices();
                assert!(vertices < u32::MAX as usize, "too many vertices for numbers of 32 bits");
            }
        }
        Self(meshes)
    }

    #[inline(always)]
    fn mesh(&self, index: u32) -> &TriangleMesh {
        self.0[index as usize].mesh
    }
}

impl Primitives for Meshes<'_> {
    type Block = TriangleBlock;
    const COST: f32 = 0.2;

    fn width(&self) -> usize {
        TriangleBlock::WIDTH
    }

    fn geometries(&self) -> Vec<(u32, usize)> {
        (0..).zip(self.0.iter().map(|numbered| numbered.mesh.len())).collect()
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
    fn block(&self, triangles: &[Reference]) -> (TriangleBlock, usize, Extent) {
        TriangleBlock::new(triangles.len(), |i| {
            let reference = &triangles[i];
            let NumberedMesh { mesh, first_triangle, first_vertex } = &self.0[reference.geometry() as usize];
            let indices = mesh.indices(reference.primitive() as usize);
            let ids = indices.map(|index| first_vertex + index);
            (first_triangle + reference.primitive(), ids, indices.map(|index| mesh.position(index)))
        })
    }
}
