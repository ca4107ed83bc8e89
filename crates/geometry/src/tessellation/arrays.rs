//! The arrays of a mesh that is refined.

use math::{Normal3, Point3, Vec2};

/// No mesh is refined to more triangles than this.
pub(super) const MAX_TRIANGLES: usize = 1 << 25;

/// The arrays of a mesh in object space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshArrays {
    /// Vertex positions.
    pub positions: Vec<Point3>,
    /// The three vertex indices of each triangle.
    pub indices: Vec<[u32; 3]>,
    /// Vertex normals, of any length.
    pub normals: Vec<Normal3>,
    /// Texture coordinates of each vertex, or none at all.
    pub uvs: Vec<Vec2>,
}
