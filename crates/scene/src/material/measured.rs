//! A surface whose reflectance was measured, from a file: alike on both sides, without parameters.

use std::sync::Arc;

use super::MaterialModel;
use crate::texture::{TextureContext, Textures};
use lanes::Real;
use scattering::{Measured, MeasuredTable};
use spectrum::SampledWavelengths;

/// A measured surface.
#[derive(Clone, Debug)]
pub struct MeasuredMaterial {
    /// The measurements.
    pub table: Arc<MeasuredTable>,
}

impl MaterialModel for MeasuredMaterial {
    type Bxdf<'a, R: Real> = Measured<'a, R>;

    #[inline(always)]
    fn bxdf<'a, R: Real>(
        &'a self,
        _: &Textures,
        _: &TextureContext<R>,
        lambda: &mut SampledWavelengths<R>,
    ) -> Measured<'a, R> {
        Measured::new(&self.table, lambda)
    }
}
