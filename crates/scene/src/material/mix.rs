//! One of two materials, chosen at each point with a given probability.
//!
//! The choice is a hash of the point and the outgoing direction: the same for the same hit on any
//! thread, and on average over many hits in the given proportion. Parameter: the probability of the
//! second material, default 0.5.

use super::MaterialId;
use crate::interaction::SurfaceInteraction;
use crate::texture::{FloatTextureId, Textures};
use sampling::hash_float;

/// A stochastic mixture.
#[derive(Clone, Debug)]
pub struct MixMaterial {
    /// The two materials.
    pub materials: [MaterialId; 2],
    /// Probability of the second.
    pub amount: FloatTextureId,
}

impl MixMaterial {
    pub(super) fn choose(&self, interaction: &SurfaceInteraction, textures: &Textures) -> MaterialId {
        let amount = textures.float(self.amount, &interaction.texture_context());
        if amount <= 0.0 {
            return self.materials[0];
        }
        if amount >= 1.0 {
            return self.materials[1];
        }
        let (p, wo) = (interaction.surface.p.p, interaction.surface.wo);
        let [px, py, pz, wx, wy, wz] = [p.x, p.y, p.z, wo.x, wo.y, wo.z].map(f32::to_bits);
        let u = hash_float(&[px, py, pz, wx, wy, wz, self.materials[0].0, self.materials[1].0]);
        self.materials[usize::from(u < amount)]
    }
}
