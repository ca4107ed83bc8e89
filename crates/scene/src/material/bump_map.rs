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

use crate::interaction::SurfaceInteraction;
use crate::texture::{FloatTextureId, TextureContext, Textures};
use geometry::Shading;
use math::{Point2, Vec2, Vector3, face_forward};

/// A bump map.
#[derive(Clone, Copy, Debug)]
pub struct BumpMap {
    /// The displacement, a length in render space.
    pub displacement: FloatTextureId,
}

impl BumpMap {
    /// The shading geometry at a point, with the tangents and the normal of the raised surface.
    /// Where these are degenerate it stays as it is.
    pub fn perturb(&self, interaction: &SurfaceInteraction, textures: &Textures) -> Shading {
        let (surface, footprint) = (&interaction.surface, &interaction.footprint);
        let shading = surface.shading;
        let context = interaction.texture_context();
        let here = textures.float(self.displacement, &context);
        let slope = |dp: Vector3, duv: Point2, width: f32| {
            let step = if width > 0.0 { 0.5 * width } else { 0.0005 };
            let moved = TextureContext { p: context.p + dp * step, uv: context.uv + duv * step, ..context };
            (textures.float(self.displacement, &moved) - here) / step
        };
        let along_u = slope(shading.dpdu, Vec2::X, footprint.dudx.abs() + footprint.dudy.abs());
        let along_v = slope(shading.dpdv, Vec2::Y, footprint.dvdx.abs() + footprint.dvdy.abs());
        let dpdu = shading.dpdu + shading.n * along_u + shading.dndu * here;
        let dpdv = shading.dpdv + shading.n * along_v + shading.dndv * here;
        let Some(n) = dpdu.cross(dpdv).try_normalize() else { return shading };
        Shading { n: face_forward(n, surface.n), dpdu, dpdv, ..shading }
    }
}
