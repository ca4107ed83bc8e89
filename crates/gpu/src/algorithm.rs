//! The algorithms that kernels have.

use description::{AmbientOcclusionDesc, LightSamplerDesc, PathDesc};
use spectrum::RgbColorSpace;

/// An algorithm with its settings.
#[derive(Clone, Debug)]
pub enum Algorithm {
    /// Camera rays, without shadow rays.
    RayCasting,
    /// Visibility over the hemisphere; unoccluded points are the white of the colour space.
    AmbientOcclusion(AmbientOcclusionDesc, &'static RgbColorSpace),
    /// Path tracing.
    Path(PathDesc),
}

impl Algorithm {
    /// How it chooses a light.
    pub fn light_sampler(&self) -> LightSamplerDesc {
        match self {
            Self::RayCasting | Self::AmbientOcclusion(..) => LightSamplerDesc::Uniform,
            Self::Path(desc) => desc.light_sampler,
        }
    }
}
