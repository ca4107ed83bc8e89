//! A surface whose reflectance was measured, from a file: alike on both sides, without parameters.

use std::sync::Arc;

use scattering::{Measured, MeasuredTable};
use spectrum::SampledWavelengths;

/// A measured surface.
#[derive(Clone, Debug)]
pub struct MeasuredMaterial {
    /// The measurements.
    pub table: Arc<MeasuredTable>,
}

impl MeasuredMaterial {
    /// Its BxDF.
    #[inline]
    pub fn bxdf(&self, lambda: &SampledWavelengths) -> Measured<'_> {
        Measured::new(&self.table, lambda)
    }
}
