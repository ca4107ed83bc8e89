//! Refinement of meshes before rendering: [`loop_subdivision`] for smooth limit surfaces,
//! [`displaced`] for surfaces displaced along their normals.

mod arrays;
mod displacement;
mod loop_subdivision;

pub use arrays::MeshArrays;
pub use displacement::displaced;
pub use loop_subdivision::loop_subdivision;
