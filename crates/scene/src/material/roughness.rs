//! Roughness of a microfacet surface: two textures and the meaning of their values.

use crate::texture::{FloatTextureId, TextureContext, Textures};
use lanes::Real;
use scattering::TrowbridgeReitz;

/// Roughness of a surface along its two tangents.
#[derive(Clone, Copy, Debug)]
pub struct Roughness {
    /// Along ∂p/∂u.
    pub u: FloatTextureId,
    /// Along ∂p/∂v.
    pub v: FloatTextureId,
    /// The values are perceptual: α is their square root. Else they are α itself.
    pub remap: bool,
}

impl Roughness {
    #[inline(always)]
    pub(super) fn distribution<R: Real>(
        &self,
        textures: &Textures,
        context: &TextureContext<R>,
    ) -> TrowbridgeReitz<R> {
        let u = self.alpha(self.u, textures, context);
        TrowbridgeReitz::new(u, if self.v == self.u { u } else { self.alpha(self.v, textures, context) })
    }

    #[inline(always)]
    fn alpha<R: Real>(&self, id: FloatTextureId, textures: &Textures, context: &TextureContext<R>) -> R {
        let roughness = textures.float(id, context);
        if self.remap { TrowbridgeReitz::roughness_to_alpha(roughness) } else { roughness }
    }
}
