//! What is under the surface of materials.

use super::Compiler;
use crate::material::SubsurfaceInside;
use crate::texture::SpectrumType;
use description::{Origin, SpectrumDesc, Substance, SubsurfaceScattering};
use scattering::BssrdfTable;
use std::sync::Arc;

impl Compiler<'_> {
    /// The scattering, of which the coefficients or mean free path have a factor.
    pub(super) fn subsurface_inside(
        &mut self,
        scattering: &SubsurfaceScattering,
        scale: f32,
        origin: &Origin,
    ) -> SubsurfaceInside {
        if !(0.0..f32::INFINITY).contains(&scale) {
            let message = format!("scattering cannot be scaled by {scale}");
            self.error("invalid-value", message, origin.parameter("scale"));
        }
        let unbounded = SpectrumType::Unbounded;
        match scattering {
            SubsurfaceScattering::Named(name) => {
                let span = origin.parameter("name");
                let substance = Substance::named(name).unwrap_or_else(|| {
                    self.error("invalid-value", format!("there is no measured substance `{name}`"), span);
                    Substance { sigma_a: [0.0; 3], sigma_s: [0.0; 3] }
                });
                let [sigma_a, sigma_s] = [substance.sigma_a, substance.sigma_s].map(|[r, g, b]| {
                    self.spectrum_texture(&SpectrumDesc::rgb(r, g, b).into(), unbounded, span)
                });
                SubsurfaceInside::Coefficients { sigma_a, sigma_s, scale }
            }
            SubsurfaceScattering::Coefficients { sigma_a, sigma_s } => SubsurfaceInside::Coefficients {
                sigma_a: self.spectrum_texture(sigma_a, unbounded, origin.parameter("sigma_a")),
                sigma_s: self.spectrum_texture(sigma_s, unbounded, origin.parameter("sigma_s")),
                scale,
            },
            SubsurfaceScattering::Reflectance { reflectance, mfp } => SubsurfaceInside::Reflectance {
                reflectance: self.albedo(reflectance, "reflectance", origin),
                mfp: self.spectrum_texture(mfp, unbounded, origin.parameter("mfp")),
                scale,
            },
        }
    }

    /// The profiles of an asymmetry and an index of refraction, which materials share.
    pub(super) fn bssrdf_table(&mut self, g: f32, eta: f32, origin: &Origin) -> Arc<BssrdfTable> {
        let mut key = [g, eta];
        if !(-1.0..=1.0).contains(&g) || g.abs() == 1.0 {
            let message = format!("an asymmetry lies between −1 and 1, as {g} does not");
            self.error("invalid-value", message, origin.parameter("g"));
            key[0] = 0.0;
        }
        if !(eta > 0.0 && eta.is_finite()) {
            let message = format!("an index of refraction must be finite and above 0, as {eta} is not");
            self.error("invalid-value", message, origin.parameter("eta"));
            key[1] = 1.0;
        }
        if let Some((_, table)) = self.bssrdf_tables.iter().find(|(of, _)| *of == key) {
            return table.clone();
        }
        let table = Arc::new(BssrdfTable::new(key[0], key[1]));
        self.bssrdf_tables.push((key, table.clone()));
        table
    }
}
