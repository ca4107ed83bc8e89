//! Ray–primitive intersections.

use super::geometry::GeometryId;
use super::instance::InstancePath;
use math::Vec2;

/// Where a ray meets a primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray, in lengths of its direction.
    pub t: f32,
    /// Where on the primitive: barycentric coordinates of corners 1 and 2 of a triangle, zero on a
    /// sphere of a set, the parameters (u, v) of other shapes.
    pub uv: Vec2,
    /// The geometry.
    pub geometry: GeometryId,
    /// The triangle, patch, sphere or curve segment within the geometry.
    pub primitive: u32,
    /// The instances that the ray entered.
    pub instance: InstancePath,
}
