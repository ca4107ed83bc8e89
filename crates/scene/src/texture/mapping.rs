//! Texture coordinates of surface points, with their derivatives by film position.
//!
//! The footprint follows by the chain rule: for (s, t) a function of the point p in texture space,
//! ∂s/∂x = ∇s·∂p/∂x. With ρ² = x² + y² and r² = ρ² + z²:
//!
//! ```text
//! uv            (s, t) = (scale_u·u + delta_u, scale_v·v + delta_v)
//! spherical     s = θ/π = acos(z/r)/π         ∇s = (xz/ρ, yz/ρ, −ρ)/(π·r²)
//!               t = φ/2π, φ ∈ [0, 2π)         ∇t = (−y, x, 0)/(2π·ρ²)
//! cylindrical   s = (π + atan2(y, x))/2π      ∇s = (−y, x, 0)/(2π·ρ²)
//!               t = z                         ∇t = (0, 0, 1)
//! planar        s = p·v₁ + delta_u            ∇s = v₁
//!               t = p·v₂ + delta_v            ∇t = v₂
//! ```
//!
//! On the axis of the spherical and cylindrical mappings derivatives are infinite or undefined;
//! lookups treat that as a very wide footprint. pbrt-v4 exchanges the derivatives of s and t in its
//! spherical mapping; here they are not exchanged.
//!
//! Source: [Pharr 2023 §10.2].

use super::TextureContext;
use math::{Point2, Point3, Transform, Vec2, Vec3, Vector3, spherical_phi, spherical_theta, sqr};
use std::f32::consts::{PI, TAU};

/// Texture coordinates in two dimensions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexCoord2d {
    /// (s, t).
    pub st: Point2,
    /// Derivative by film x.
    pub dstdx: Vec2,
    /// Derivative by film y.
    pub dstdy: Vec2,
}

/// Texture coordinates in three dimensions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexCoord3d {
    /// The point in texture space.
    pub p: Point3,
    /// Derivative by film x.
    pub dpdx: Vector3,
    /// Derivative by film y.
    pub dpdy: Vector3,
}

/// A map to the plane.
#[derive(Clone, Debug, PartialEq)]
pub enum Mapping2d {
    /// The surface's own parameters.
    Uv {
        /// Factors on u and v.
        scale: Vec2,
        /// Offsets, added after scaling.
        delta: Vec2,
    },
    /// Polar angles about the origin of texture space.
    Spherical {
        /// From render to texture space.
        texture_from_render: Transform,
    },
    /// Angle about, and height along, the z axis of texture space.
    Cylindrical {
        /// From render to texture space.
        texture_from_render: Transform,
    },
    /// Dot products with two vectors of texture space.
    Planar {
        /// From render to texture space.
        texture_from_render: Transform,
        /// The vectors, for s and t.
        axes: [Vector3; 2],
        /// Offsets, added to both.
        delta: Vec2,
    },
}

impl Mapping2d {
    /// The texture coordinates of a point.
    pub fn map(&self, ctx: &TextureContext) -> TexCoord2d {
        match self {
            Self::Uv { scale, delta } => TexCoord2d {
                st: *scale * ctx.uv + *delta,
                dstdx: *scale * Vec2::new(ctx.dudx, ctx.dvdx),
                dstdy: *scale * Vec2::new(ctx.dudy, ctx.dvdy),
            },
            Self::Spherical { texture_from_render } => {
                let at = Mapping3d { texture_from_render: *texture_from_render }.map(ctx);
                let p = at.p;
                let (rho2, rho) = (sqr(p.x) + sqr(p.y), p.x.hypot(p.y));
                let dsdp = Vec3::new(p.x * p.z / rho, p.y * p.z / rho, -rho) / (PI * p.length_squared());
                let dtdp = Vec3::new(-p.y, p.x, 0.0) / (TAU * rho2);
                let direction = p.normalize_or_zero();
                let st = Vec2::new(spherical_theta(direction) / PI, spherical_phi(direction) / TAU);
                at.onto(st, [dsdp, dtdp])
            }
            Self::Cylindrical { texture_from_render } => {
                let at = Mapping3d { texture_from_render: *texture_from_render }.map(ctx);
                let p = at.p;
                let dsdp = Vec3::new(-p.y, p.x, 0.0) / (TAU * (sqr(p.x) + sqr(p.y)));
                at.onto(Vec2::new((PI + p.y.atan2(p.x)) / TAU, p.z), [dsdp, Vec3::Z])
            }
            Self::Planar { texture_from_render, axes, delta } => {
                let at = Mapping3d { texture_from_render: *texture_from_render }.map(ctx);
                at.onto(Vec2::new(at.p.dot(axes[0]), at.p.dot(axes[1])) + *delta, *axes)
            }
        }
    }
}

/// A map to texture space.
#[derive(Clone, Debug, PartialEq)]
pub struct Mapping3d {
    /// From render to texture space.
    pub texture_from_render: Transform,
}

impl Mapping3d {
    /// The texture coordinates of a point.
    pub fn map(&self, ctx: &TextureContext) -> TexCoord3d {
        let t = &self.texture_from_render;
        TexCoord3d { p: t.point(ctx.p), dpdx: t.vector(ctx.dpdx), dpdy: t.vector(ctx.dpdy) }
    }
}

impl TexCoord3d {
    /// The texture coordinates `st` of this point, with derivatives by the chain rule from their
    /// gradients.
    fn onto(&self, st: Point2, [dsdp, dtdp]: [Vector3; 2]) -> TexCoord2d {
        let along = |dp: Vector3| Vec2::new(dsdp.dot(dp), dtdp.dot(dp));
        TexCoord2d { st, dstdx: along(self.dpdx), dstdy: along(self.dpdy) }
    }
}
