//! Texture coordinates of surface points, with their derivatives by film position.
//!
//! The footprint follows by the chain rule: for (s, t) a function of the point p in texture space,
//! ∂s/∂x = ∇s·∂p/∂x. With ρ² = x² + y² and r² = ρ² + z²:
//!
//! ```text
//! uv            (s, t) = (scale_u·u + delta_u, scale_v·v + delta_v)
//! affine        (s, t) = u·c₀ + v·c₁ + c₂
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
use super::context::ContextArrays;
use lanes::{Each, MAX_LANES, Real};
use math::{Point2, Point3, Transform, Vec2, Vec3, Vector3, spherical_phi, spherical_theta, sqr};
use std::f32::consts::{PI, TAU};

/// Texture coordinates in two dimensions, for each lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexCoord2d<R = f32> {
    /// (s, t).
    pub st: Point2<R>,
    /// Derivative by film x.
    pub dstdx: Vec2<R>,
    /// Derivative by film y.
    pub dstdy: Vec2<R>,
}

/// Texture coordinates in three dimensions, for each lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexCoord3d<R = f32> {
    /// The point in texture space.
    pub p: Point3<R>,
    /// Derivative by film x.
    pub dpdx: Vector3<R>,
    /// Derivative by film y.
    pub dpdy: Vector3<R>,
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
    /// A linear function of the surface's own parameters.
    Affine {
        /// What u, v and 1 are multiplied by.
        columns: [Vec2; 3],
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
    /// The texture coordinates of a point. Only those of the surface's own parameters are computed
    /// in lanes.
    #[inline(always)]
    pub fn map<R: Real>(&self, ctx: &TextureContext<R>) -> TexCoord2d<R> {
        if let Self::Uv { scale, delta } = self {
            let [scale, delta] = [scale, delta].each(|v| Vec2::broadcast(*v));
            return TexCoord2d {
                st: scale * ctx.uv + delta,
                dstdx: scale * Vec2::new(ctx.footprint.dudx, ctx.footprint.dvdx),
                dstdy: scale * Vec2::new(ctx.footprint.dudy, ctx.footprint.dvdy),
            };
        }
        if let Self::Affine { columns } = self {
            let [u, v, delta] = columns.each(Vec2::broadcast);
            let along = |du: R, dv: R| u * du + v * dv;
            return TexCoord2d {
                st: along(ctx.uv.x, ctx.uv.y) + delta,
                dstdx: along(ctx.footprint.dudx, ctx.footprint.dvdx),
                dstdy: along(ctx.footprint.dudy, ctx.footprint.dvdy),
            };
        }
        if R::LANES == 1 {
            let TexCoord2d { st, dstdx, dstdy } = self.map_one(&ctx.lane(0));
            let [st, dstdx, dstdy] = [st, dstdx, dstdy].each(Vec2::broadcast);
            return TexCoord2d { st, dstdx, dstdy };
        }
        let contexts = ContextArrays::new(ctx);
        let mut numbers = [[[0.0; MAX_LANES]; 2]; 3];
        for lane in 0..R::LANES {
            let TexCoord2d { st, dstdx, dstdy } = self.map_one(&contexts.lane(lane));
            for (pair, v) in numbers.iter_mut().zip([st, dstdx, dstdy]) {
                (pair[0][lane], pair[1][lane]) = (v.x, v.y);
            }
        }
        let [st, dstdx, dstdy] = numbers.each(|[x, y]| Vec2::new(R::load(&x), R::load(&y)));
        TexCoord2d { st, dstdx, dstdy }
    }

    #[inline(never)]
    fn map_one(&self, ctx: &TextureContext) -> TexCoord2d {
        match self {
            Self::Uv { .. } | Self::Affine { .. } => unreachable!("invariant: these are mapped in lanes"),
            Self::Spherical { texture_from_render } => {
                let at = Mapping3d { texture_from_render: *texture_from_render }.map(ctx);
                let p = at.p;
                let (rho2, rho) = (sqr(p.x) + sqr(p.y), lanes::hypot(p.x, p.y));
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
                at.onto(Vec2::new((PI + lanes::atan2(p.y, p.x)) / TAU, p.z), [dsdp, Vec3::Z])
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
    #[inline(always)]
    pub fn map<R: Real>(&self, ctx: &TextureContext<R>) -> TexCoord3d<R> {
        let t = &self.texture_from_render;
        let (dpdx, dpdy) = (ctx.footprint.dpdx, ctx.footprint.dpdy);
        TexCoord3d { p: t.point_lanes(ctx.p), dpdx: t.vector_lanes(dpdx), dpdy: t.vector_lanes(dpdy) }
    }
}

impl<R: Real> TexCoord3d<R> {
    /// The same point in a texture space that is scaled by `factor`.
    #[inline(always)]
    pub(super) fn scaled(&self, factor: R) -> Self {
        Self { p: self.p * factor, dpdx: self.dpdx * factor, dpdy: self.dpdy * factor }
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
