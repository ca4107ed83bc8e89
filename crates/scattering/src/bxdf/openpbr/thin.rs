//! Thin walls: sheets of glass, of paper, of leaves, the same on both sides and without an inside.
//!
//! Light that glass transmits goes on in its direction; between the sides of the sheet it is
//! reflected again and again. With the reflectance F of a side and the transmittance a of what is
//! between them, the sheet
//!
//! ```text
//! reflects R = F + a² F (1 − F)²/(1 − a² F²)        and transmits T = a (1 − F)²/(1 − a² F²)
//! ```
//!
//! by facets as `Stack::sheet` has them. The share of the base that scatters under its surface
//! reflects (1 − g)/2 and transmits (1 + g)/2 of it diffusely. Metal and the rest of the base are
//! opaque. Coat and fuzz lie on both sides, but take light only once, as for reflection: by what
//! they pass on in the direction in which they pass less. Source: [OpenPBR 2024].

use super::diffuse::oren_nayar;
use super::mirror::Mirror;
use super::{OpenPbr, View, flip};
use crate::{BsdfSample, BxdfFlags, TransportMode};
use math::{Vec2, Vector3, same_hemisphere};
use spectrum::SampledSpectrum;
use std::f32::consts::PI;

/// A direction mirrored by the sheet.
fn turned(w: Vector3) -> Vector3 {
    Vector3::new(w.x, w.y, -w.z)
}

impl OpenPbr<'_> {
    /// What a smooth sheet reflects and transmits of light at a cosine.
    pub(super) fn sheet_shares(&self, cosine: f32) -> [SampledSpectrum; 2] {
        let one = SampledSpectrum::ONE;
        let f = self.stack.dielectrics(cosine, &self.waves);
        let a = self.transmission_color;
        let passed = (one - f) * (one - f);
        // Both are 1 where a side reflects everything.
        let sum = (one - a * a * f * f).map(|x| x.max(1e-6));
        [f + a * a * f * passed / sum, a * passed / sum]
    }

    /// The value of a share of what is scattered within the wall, for two directions above.
    pub(super) fn scattered(&self, share: f32, wo: Vector3, wi: Vector3) -> SampledSpectrum {
        self.scattered * oren_nayar(SampledSpectrum::ONE, self.diffuse_roughness, wo, wi) * share
    }

    /// The value of a thin wall for two directions off the horizon.
    pub(super) fn thin_value(
        &self,
        view: &View,
        wo: Vector3,
        wi: Vector3,
        mode: TransportMode,
    ) -> SampledSpectrum {
        let [wo, wi] = [wo, wi].map(|w| flip(wo.z < 0.0, w));
        match same_hemisphere(wo, wi) {
            true => self.reflected(view, wo, wi, mode, &self.weights(1.0)),
            false => self.passed_through(view, wo, turned(wi)),
        }
    }

    /// The value for directions on both sides, of which the second is mirrored by the sheet.
    fn passed_through(&self, view: &View, wo: Vector3, wi: Vector3) -> SampledSpectrum {
        let (o, i, rests) = (&view.shares, &self.shares(-turned(wi)), &view.rests);
        let weights = self.weights(1.0);
        let mut f = SampledSpectrum::ZERO;
        if weights.glass > 0.0 {
            if let Some(mirror) = Mirror::new(&self.stack.sheet(), wo, wi) {
                let white = mirror.f * o.taken.below_coat.min(i.taken.below_coat);
                f += self.sheet_shares(mirror.cosine)[1] * (white * weights.glass);
            }
            if rests.glass[0] > 0.0 {
                let left = o.glass_rest * i.glass_rest / (PI * rests.glass[0]);
                f += self.transmission_color * (left * rests.through[0] * weights.glass);
            }
        }
        if weights.diffuse > 0.0 && self.transmits_diffusely() {
            let left = (o.diffuse_rest * i.diffuse_rest).safe_div(rests.diffuse);
            f += self.scattered(self.forward, wo, wi) * left * self.darkening * weights.diffuse;
        }
        f * self.absorbed(self.coat_length(wo.z) + self.coat_length(wi.z))
    }

    /// A direction in which a sheet of glass transmits light, without its value, and of the density
    /// only that of a smooth sheet.
    pub(super) fn sample_sheet(&self, wo: Vector3, u: Vec2) -> BsdfSample {
        let below = wo.z < 0.0;
        let sample = super::mirrored(&self.stack.sheet(), flip(below, wo), u);
        let flags = match sample.flags.is_specular() {
            true => BxdfFlags::SPECULAR_TRANSMISSION,
            false => BxdfFlags::GLOSSY_TRANSMISSION,
        };
        BsdfSample { wi: flip(below, turned(sample.wi)), flags, ..sample }
    }

    /// The density of [`Self::sample_sheet`] for directions on both sides.
    pub(super) fn pdf_sheet(&self, wo: Vector3, wi: Vector3) -> f32 {
        let [wo, wi] = [wo, wi].map(|w| flip(wo.z < 0.0, w));
        Mirror::new(&self.stack.sheet(), wo, turned(wi)).map_or(0.0, |mirror| mirror.pdf)
    }
}
