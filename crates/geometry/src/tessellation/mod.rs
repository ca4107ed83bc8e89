//! Meshes that are made finer before they are drawn: [`loop_subdivision`] for the smooth surface
//! that a coarse mesh stands for, [`displaced`] for a surface moved along its normals.

mod displacement;
mod loop_subdivision;

pub use displacement::displaced;
pub use loop_subdivision::loop_subdivision;

use math::{Normal3, Point3, Vec2};

/// No mesh is refined to more triangles than this.
const MOST_TRIANGLES: usize = 1 << 25;

/// What a mesh is made of, in object space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshArrays {
    /// Where its vertices are.
    pub positions: Vec<Point3>,
    /// The three vertices of each triangle.
    pub indices: Vec<[u32; 3]>,
    /// A normal for each vertex, of any length.
    pub normals: Vec<Normal3>,
    /// Texture coordinates of each vertex, or none at all.
    pub uvs: Vec<Vec2>,
}
