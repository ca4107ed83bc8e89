//! Triangles of a group's meshes as numbers of 32 bits, half the size of geometry and primitive.
//!
//! Numbers run through the meshes in order. The mesh of a number is found by a table with the mesh
//! of every 256th number, and a short linear search from there.

use super::geometry::{Geometry, GeometryId};
use math::Vec3;

/// The numbering of all triangles of a group.
#[derive(Clone, Debug)]
pub(super) struct TriangleNumbering {
    geometries: Vec<GeometryId>,
    /// The first number of each geometry, then the number of all triangles.
    firsts: Vec<u32>,
    /// The index in `geometries` of every 256th number.
    guide: Vec<u32>,
}

impl TriangleNumbering {
    const GUIDE_STEP: usize = 256;

    /// Numbers the triangles of those members that are meshes.
    pub fn new(members: &[GeometryId], geometries: &[Geometry]) -> Self {
        let mut numbering = Self { geometries: Vec::new(), firsts: vec![0], guide: Vec::new() };
        let mut all = 0;
        for &id in members {
            if let Geometry::Mesh(mesh) = &geometries[id.0 as usize]
                && !mesh.is_empty()
            {
                all += mesh.len();
                assert!(all < u32::MAX as usize, "too many triangles for numbers of 32 bits");
                numbering.guide.resize(all.div_ceil(Self::GUIDE_STEP), numbering.geometries.len() as u32);
                numbering.geometries.push(id);
                numbering.firsts.push(all as u32);
            }
        }
        numbering
    }

    /// The geometries that have triangles, each with the number of its first.
    pub fn meshes(&self) -> impl Iterator<Item = (GeometryId, u32)> {
        self.geometries.iter().copied().zip(self.firsts.iter().copied())
    }

    /// Geometry and primitive of a number.
    #[inline(always)]
    pub fn id(&self, number: u32) -> (GeometryId, u32) {
        let mut geometry = self.guide[number as usize / Self::GUIDE_STEP] as usize;
        while self.firsts[geometry + 1] <= number {
            geometry += 1;
        }
        (self.geometries[geometry], number - self.firsts[geometry])
    }

    /// The corners of a triangle; `None` where the geometry is no longer a mesh.
    #[inline]
    pub fn corners(&self, number: u32, geometries: &[Geometry]) -> Option<[Vec3; 3]> {
        let (geometry, primitive) = self.id(number);
        match &geometries[geometry.0 as usize] {
            Geometry::Mesh(mesh) => Some(mesh.corners(primitive as usize)),
            Geometry::Shapes(_) | Geometry::Spheres(_) | Geometry::Curves(_) => None,
        }
    }

    /// Bytes of memory.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.geometries) + size_of_val(&*self.firsts) + size_of_val(&*self.guide)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MeshAttributes, TriangleMesh};
    use math::Transform;

    #[test]
    fn each_number_finds_its_triangle() {
        let mesh = |triangles: usize| -> Geometry {
            let positions = [Vec3::ZERO, Vec3::X, Vec3::Y].into();
            let (indices, attributes) = (vec![[0, 1, 2]; triangles].into(), MeshAttributes::default());
            TriangleMesh::new(positions, indices, attributes, &Transform::IDENTITY, false)
                .expect("a mesh")
                .into()
        };
        let lens = [3, 0, 1, 200, 64, 1, 1, 0, 63, 5];
        let geometries = lens.map(mesh);
        let members: Vec<_> = (0..lens.len() as u32).rev().map(GeometryId).collect();
        let numbering = TriangleNumbering::new(&members, &geometries);
        let expected = members.iter().flat_map(|&id| (0..lens[id.0 as usize] as u32).map(move |i| (id, i)));
        for (number, id) in expected.enumerate() {
            assert_eq!(numbering.id(number as u32), id);
        }
        let first = |(id, first)| numbering.id(first) == (id, 0);
        assert_eq!(numbering.meshes().filter(|&mesh| first(mesh)).count(), 8);
    }
}
