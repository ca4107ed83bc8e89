//! Points, vectors, bounds, transforms, rays, frames and float-error intervals.
//!
//! Points, vectors and normals are one type, [`Vec3`]; the alias in a signature says how the value transforms.

pub use glam::{DMat4, DVec3, Mat3, Mat4, Vec2, Vec3};

/// A point in the plane, or a pair of sample values.
pub type Point2 = Vec2;
/// A position; moves with [`Vec3`] translation.
pub type Point3 = Vec3;
/// A difference of positions or a direction; does not move with translation.
pub type Vector3 = Vec3;
/// A surface normal; transforms by the inverse transpose.
pub type Normal3 = Vec3;
