//! Roughness of a microfacet surface: two textures and the meaning of their values.

use crate::texture::{FloatTextureId, TextureContext, Textures};
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
    #[inline]
    pub(super) fn distribution(&self, textures: &Textures, context: &TextureContext) -> TrowbridgeReitz {
        let alpha = |texture| {
            let roughness = textures.float(texture, context);
            if self.remap { TrowbridgeReitz::roughness_to_alpha(roughness) } else { roughness }
        };
        let u = alpha(self.u);
        TrowbridgeReitz::new(u, if self.v == self.u { u } else { alpha(self.v) })
    }
}
