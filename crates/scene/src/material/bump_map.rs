//! Normals of a surface that is raised by a texture, its displacement d(u, v), along its normal n.
//!
//! The raised surface p′ = p + d·n has the tangents
//!
//! ```text
//! ∂p′/∂u = ∂p/∂u + ∂d/∂u·n + d·∂n/∂u        ∂p′/∂v likewise
//! ```
//!
//! and their vector product as its normal. Only shading sees them: the surface stays where it is,
//! so that its silhouette and its shadows are smooth. ∂d/∂u is a difference over half of the
//! footprint of the pixel along u, less than which the pixel cannot show, or over 0.0005 where the
//! footprint is a point. The normal keeps to the side of the geometric one.
//!
//! Sources: [Blinn 1978]; [Pharr 2023 §10.5.3].

use crate::texture::{FloatTextureId, TextureContext, Textures};
use geometry::Shading;
use lanes::Real;
use math::{Vec2, Vec3, Vector3, face_forward};

/// A bump map.
#[derive(Clone, Copy, Debug)]
pub struct BumpMap {
    /// The displacement, a length in render space.
    pub displacement: FloatTextureId,
}

impl BumpMap {
    /// The shading geometry at a point, with the tangents and the normal of the raised surface.
    /// Where these are degenerate it stays as it is.
    #[inline(always)]
    pub fn perturb<R: Real>(
        &self,
        shading: &Shading<R>,
        context: &TextureContext<R>,
        textures: &Textures,
    ) -> Shading<R> {
        let Shading { n, dpdu, dpdv, dndu, dndv } = *shading;
        let (zero, one, footprint) = (R::zero(), R::one(), &context.footprint);
        let here = textures.float(self.displacement, context);
        let widths =
            [footprint.dudx.abs() + footprint.dudy.abs(), footprint.dvdx.abs() + footprint.dvdy.abs()];
        let sides = [(dpdu, Vec2::new(one, zero)), (dpdv, Vec2::new(zero, one))];
        let mut slopes = [zero; 2];
        for ((slope, width), (dp, duv)) in slopes.iter_mut().zip(widths).zip(sides) {
            let step = R::select(width.gt(zero), R::splat(0.5) * width, R::splat(0.0005));
            let moved = TextureContext { p: context.p + dp * step, uv: context.uv + duv * step, ..*context };
            *slope = (textures.float(self.displacement, &moved) - here) / step;
        }
        let raised: [Vector3<R>; 2] =
            [dpdu + n * slopes[0] + dndu * here, dpdv + n * slopes[1] + dndv * here];
        let (ns, is_regular) = raised[0].cross(raised[1]).normalize_masked();
        Shading {
            n: Vec3::select(is_regular, face_forward(ns, context.n), n),
            dpdu: Vec3::select(is_regular, raised[0], dpdu),
            dpdv: Vec3::select(is_regular, raised[1], dpdv),
            ..*shading
        }
    }
}
