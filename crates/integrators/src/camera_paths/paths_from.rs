//! Path tracing of the paths of some length or more.

use math::RayDifferential;
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::{RayIntegrator, Tracer};

/// Path tracing that can leave out short paths.
pub(crate) trait PathsFrom: RayIntegrator + std::fmt::Debug {
    /// The radiance along the ray of paths that scatter at least `min_depth` times.
    fn li_from(
        &self,
        min_depth: u32,
        tracer: &mut Tracer,
        ray: RayDifferential,
        lambda: &mut SampledWavelengths,
    ) -> SampledSpectrum;
}
