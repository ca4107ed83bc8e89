//! A thin pane: both interfaces in one surface, which light passes without changing direction.
//!
//! Parameter: index of refraction over wavelength, default 1.5.

use super::dispersed_index;
use scattering::ThinDielectric;
use spectrum::{SampledWavelengths, Spectrum};

/// A pane of glass without thickness.
#[derive(Clone, Debug)]
pub struct ThinDielectricMaterial {
    /// Index of refraction.
    pub eta: Spectrum,
}

impl ThinDielectricMaterial {
    #[inline]
    pub(super) fn bxdf(&self, lambda: &mut SampledWavelengths) -> ThinDielectric {
        ThinDielectric { eta: dispersed_index(&self.eta, lambda) }
    }
}
