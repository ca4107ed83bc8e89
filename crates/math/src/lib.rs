//! Points, vectors, bounds, transforms, rays, frames and float-error intervals.
//!
//! Points, vectors and normals are one type, [`Vec3`]; the alias in a signature says how the value
//! transforms ([`Transform::point`], [`Transform::vector`], [`Transform::normal`]).

mod animated;
mod balance;
mod bounds;
mod closed_set;
mod cone;
mod elementary;
mod error;
mod float;
mod frame;
mod interval;
mod octahedral;
mod quadratic;
mod ray;
mod spherical;
mod transform;
mod vector;

pub use animated::{AnimatedTransform, MotionKeys};
pub use balance::balance;
pub use bounds::{Bounds2, Bounds2i, Bounds3};
pub use cone::{DirectionCone, bound_subtended_directions};
pub use elementary::map_lanes;
pub use error::{Point3Error, offset_ray_origin};
pub use float::*;
pub use frame::{Frame, coordinate_system};
pub use glam::{DAffine2, DMat2, DMat3, DMat4, DQuat, DVec2, DVec3, DVec4, Mat3, Mat4, Vec4};
pub use interval::Interval;
pub use lanes::{exp, ln, sin_cos};
pub use octahedral::{equal_area_sphere_to_square, equal_area_square_to_sphere, wrap_equal_area_square};
pub use quadratic::solve_quadratic;
pub use ray::{CameraEnd, Differentials, Ray, RayDifferential};
pub use spherical::*;
pub use transform::{Transform, affine_ray};
pub use vector::{Vec2, Vec3};

/// A point in the plane, or a pair of sample values.
pub type Point2<R = f32> = Vec2<R>;
/// A position.
pub type Point3<R = f32> = Vec3<R>;
/// A difference of positions, or a direction.
pub type Vector3<R = f32> = Vec3<R>;
/// A surface normal; transforms by the inverse transpose.
pub type Normal3<R = f32> = Vec3<R>;
