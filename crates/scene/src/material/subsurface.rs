//! Skin, milk, marble, wax: a boundary under which light is scattered, and leaves elsewhere.
//!
//! Parameters: the scattering, by coefficients of absorption and scattering per unit of length, or
//! by an effective albedo, default none, and a mean free path, default 1; a factor on the
//! coefficients or the mean free path, default 1; asymmetry in (−1, 1), default 0; index of
//! refraction, default 1.33; roughness of the boundary, default 0.
//!
//! The profile is that of a flat half space of constant coefficients; textures and curved surfaces
//! take it at each point of the camera's side.

use std::sync::Arc;

use super::Roughness;
use crate::texture::{SpectrumTextureId, TextureContext, Textures};
use scattering::{Bssrdf, BssrdfTable, Dielectric, Subsurface, SubsurfaceMethod, SubsurfacePart};
use spectrum::SampledWavelengths;

/// A body that scatters light under its surface.
#[derive(Clone, Debug)]
pub struct SubsurfaceMaterial {
    /// The profiles of its asymmetry and index of refraction.
    pub table: Arc<BssrdfTable>,
    /// What is under the surface.
    pub inside: SubsurfaceInside,
    /// Roughness of the boundary.
    pub roughness: Roughness,
    /// How light is followed.
    pub method: SubsurfaceMethod,
}

/// How the scattering under a surface is given.
#[derive(Clone, Copy, Debug)]
pub enum SubsurfaceInside {
    /// By coefficients per unit of length.
    Coefficients {
        /// Absorption, without `scale`.
        sigma_a: SpectrumTextureId,
        /// Scattering, without `scale`.
        sigma_s: SpectrumTextureId,
        /// Factor on both.
        scale: f32,
    },
    /// By what leaves again.
    Reflectance {
        /// The effective albedo, in [0, 1].
        reflectance: SpectrumTextureId,
        /// The mean free path, without `scale`.
        mfp: SpectrumTextureId,
        /// Factor on the mean free path.
        scale: f32,
    },
}

impl SubsurfaceMaterial {
    /// Its BxDF.
    #[inline]
    pub fn bxdf(
        &self,
        textures: &Textures,
        context: &TextureContext,
        lambda: &SampledWavelengths,
    ) -> Subsurface<'_> {
        let spectrum = |id| textures.spectrum(id, context, lambda);
        let distribution = self.roughness.distribution(textures, context);
        let bssrdf = match self.inside {
            SubsurfaceInside::Coefficients { sigma_a, sigma_s, scale } => {
                let [a, s] = [sigma_a, sigma_s].map(|id| (spectrum(id) * scale).clamp_zero());
                Bssrdf::new(&self.table, a, s)
            }
            SubsurfaceInside::Reflectance { reflectance, mfp, scale } => {
                let (share, path) = (spectrum(reflectance).clamp(0.0, 1.0), spectrum(mfp) * scale);
                Bssrdf::from_reflectance(&self.table, self.method, &distribution, share, path)
            }
        };
        Subsurface {
            boundary: Dielectric { eta: self.table.eta(), distribution },
            bssrdf,
            method: self.method,
            part: SubsurfacePart::Whole,
            seed: 0,
        }
    }
}
