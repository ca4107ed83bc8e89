//! Shapes as plain data, for engines that trace rays elsewhere.

use math::{DMat4, Normal3, Point3, Vector3};

/// A shape at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlainShape {
    /// p(u, v) = corner + u·side₀ + v·side₁ + uv·twist for u and v in [0, 1], which are its texture
    /// coordinates.
    Patch {
        /// p(0, 0).
        corner: Point3,
        /// To p(1, 0) and to p(0, 1).
        sides: [Vector3; 2],
        /// Zero where it is a parallelogram.
        twist: Vector3,
        /// Whether the outside is not on the side of side₀ × side₁.
        flips: bool,
    },
    /// A surface around the z axis of object space.
    Revolved {
        /// Which one.
        kind: RevolvedKind,
        /// From object to render space.
        render_from_object: DMat4,
        /// Whether the outside is not on the side of ∂p/∂u × ∂p/∂v as transformed.
        flips: bool,
        /// The numbers that its kind has, then zeros.
        numbers: [f32; 4],
    },
    /// A part of a curve: a cubic Bézier segment with a line across it.
    Curve {
        /// What the line is.
        kind: CurveKind,
        /// Control points.
        points: [Point3; 4],
        /// The length of the line at both ends, between which it changes linearly.
        widths: [f32; 2],
        /// The texture coordinate u at both ends.
        range: [f32; 2],
        /// Of a ribbon the unit normals at both ends; else zero.
        normals: [Normal3; 2],
        /// Whether the outside is not on the side of the ray.
        flips: bool,
    },
}

/// The lines across curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveKind {
    /// It faces the ray.
    Flat,
    /// It faces the ray, with the normals of a tube.
    Cylinder,
    /// It is perpendicular to normals.
    Ribbon,
}

/// The kinds of surfaces around an axis, with their numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RevolvedKind {
    /// Radius, least and largest z, and largest φ.
    Sphere,
    /// Radius, least and largest z, and largest φ.
    Cylinder,
    /// Height, radius, radius of the hole, and largest φ.
    Disk,
    /// None: all of z = 0.
    Plane,
}
