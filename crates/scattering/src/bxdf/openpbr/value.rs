//! Values of the lobes from above, and of specular ones.

use super::chances::Lobe;
use super::diffuse::oren_nayar;
use super::fuzz::{self, Scattered};
use super::mirror::Mirror;
use super::shares::{Rests, Shares};
use super::{OpenPbr, View, Weights, flip, is_off_horizon};
use crate::{BsdfSample, Scatter, TransportMode};
use math::{Vector3, same_hemisphere, sqr};
use spectrum::SampledSpectrum;
use std::f32::consts::PI;

impl OpenPbr<'_> {
    /// Absorption in the coat on paths of these lengths, in units of its thickness.
    pub(super) fn absorbed(&self, lengths: f32) -> SampledSpectrum {
        if self.stack.coat_weight == 0.0 || self.coat_color == SampledSpectrum::ONE {
            return SampledSpectrum::ONE;
        }
        SampledSpectrum::ONE.lerp(self.coat_color.powf(0.5 * lengths), self.stack.coat_weight)
    }

    /// The length of a path through the coat.
    pub(super) fn coat_length(&self, cosine: f32) -> f32 {
        1.0 / (1.0 - (1.0 - sqr(cosine)) / sqr(self.stack.coat_ior)).sqrt().max(1e-3)
    }

    /// The reflectance of the facets of the base met from above at a cosine.
    pub(super) fn reflectance(&self, cosine: f32, weights: &Weights) -> SampledSpectrum {
        let mut reflected = SampledSpectrum::ZERO;
        if weights.glass > 0.0 && self.stack.is_thin {
            reflected += self.sheet_shares(cosine)[0] * self.specular_color * weights.glass;
            return reflected + self.reflectance(cosine, &Weights { glass: 0.0, ..*weights });
        }
        if weights.metal > 0.0 {
            reflected += self.metal(cosine) * self.darkening * weights.metal;
        }
        if weights.diffuse + weights.glass > 0.0 {
            let dielectric = self.stack.dielectrics(cosine, &self.waves) * self.specular_color;
            reflected +=
                dielectric * (self.darkening * weights.diffuse + SampledSpectrum::splat(weights.glass));
        }
        reflected
    }

    /// The value for two directions above of what `weights` say.
    pub(super) fn reflected(
        &self,
        view: &View,
        wo: Vector3,
        wi: Vector3,
        mode: TransportMode,
        weights: &Weights,
    ) -> SampledSpectrum {
        let (o, i, rests) = (&view.shares, &self.shares(wi), &view.rests);
        let mut f = SampledSpectrum::ZERO;
        if self.stack.fuzz_weight > 0.0 {
            f += self.fuzz([o, i], rests, [wo, wi], weights);
        }
        if self.stack.coat_weight > 0.0 {
            let coat = self.coat(wo, wi, mode) * o.below_fuzz().min(i.below_fuzz());
            f += SampledSpectrum::splat(coat * self.stack.coat_weight * weights.layers);
        }
        let mut base = SampledSpectrum::ZERO;
        if let Some(mirror) = Mirror::new(&self.stack.base, wo, wi) {
            let white = mirror.f * o.taken.below_coat.min(i.taken.below_coat);
            base += self.reflectance(mirror.cosine, weights) * white;
        }
        if weights.diffuse > 0.0 {
            base += self.diffuse([o, i], rests, [wo, wi], weights);
        }
        if weights.metal > 0.0 && rests.metal > 0.0 {
            let left = o.metal_rest() * i.metal_rest() / (PI * rests.metal);
            base += self.metal_again * self.darkening * (left * weights.metal);
        }
        if weights.glass > 0.0 && rests.glass[0] > 0.0 {
            let left = o.glass_rest * i.glass_rest / (PI * rests.glass[0]);
            base += SampledSpectrum::splat(left * (1.0 - rests.through[0]) * weights.glass);
        }
        if self.stack.coat_weight > 0.0 {
            base *= self.absorbed(self.coat_length(wo.z) + self.coat_length(wi.z));
        }
        f + base
    }

    /// The value of the fibres.
    #[inline]
    fn fuzz(
        &self,
        shares: [&Shares; 2],
        rests: &Rests,
        directions: [Vector3; 2],
        weights: &Weights,
    ) -> SampledSpectrum {
        let fibres = shares.map(|w| Scattered { once: w.taken.fuzz_once, more: w.taken.fuzz_more });
        let fuzz = fuzz::value(self.fuzz_color, self.stack.fuzz_roughness, rests.fuzz, directions, fibres);
        fuzz * (self.stack.fuzz_weight * weights.layers)
    }

    /// The value of the diffuse base, below the coat.
    #[inline]
    fn diffuse(
        &self,
        [o, i]: [&Shares; 2],
        rests: &Rests,
        [wo, wi]: [Vector3; 2],
        weights: &Weights,
    ) -> SampledSpectrum {
        let left = (o.diffuse_rest * i.diffuse_rest).safe_div(rests.diffuse);
        let color = if weights.under > 0.0 { self.base_color } else { self.diffuse_color };
        let mut diffuse = oren_nayar(color, self.diffuse_roughness, wo, wi) * (1.0 - weights.under);
        if self.stack.is_thin {
            diffuse = diffuse * self.diffuse_weight + self.scattered(1.0 - self.forward, wo, wi);
        }
        diffuse * left * self.darkening * weights.diffuse
    }

    /// The value of fibres and the diffuse base alone, for two directions on the same side.
    pub(in super::super) fn diffused(&self, wo: Vector3, wi: Vector3) -> SampledSpectrum {
        if !(is_off_horizon(wo) && is_off_horizon(wi)) {
            return SampledSpectrum::ZERO;
        }
        if self.is_lobe() {
            return self.f(wo, wi, TransportMode::Radiance);
        }
        let (below, weights) = (wo.z < 0.0, self.weights(wo.z));
        let directions @ [wo, wi] = [flip(below, wo), flip(below, wi)];
        let (o, i, rests) = (self.shares(wo), self.shares(wi), self.rests());
        let absorbed = self.absorbed(self.coat_length(wo.z) + self.coat_length(wi.z));
        let mut f = SampledSpectrum::ZERO;
        if self.stack.fuzz_weight > 0.0 {
            f += self.fuzz([&o, &i], &rests, directions, &weights);
        }
        if weights.diffuse > 0.0 {
            f += self.diffuse([&o, &i], &rests, directions, &weights) * absorbed;
        }
        f
    }

    /// The value for two directions off the horizon.
    pub(super) fn value(
        &self,
        view: &View,
        wo: Vector3,
        wi: Vector3,
        mode: TransportMode,
    ) -> SampledSpectrum {
        if self.stack.is_thin {
            return self.thin_value(view, wo, wi, mode);
        }
        let glass = self.glass() > 0.0;
        match (same_hemisphere(wo, wi), wo.z > 0.0) {
            (true, true) => self.reflected(view, wo, wi, mode, &self.weights(1.0)),
            (true, false) => {
                let mut f = SampledSpectrum::ZERO;
                if self.glass() < 1.0 {
                    f += self.reflected(view, -wo, -wi, mode, &self.weights(-1.0));
                }
                if glass { f + self.reflected_inside(view, wo, wi) } else { f }
            }
            (false, _) if glass => self.transmitted(view, wo, wi, mode),
            (false, _) => SampledSpectrum::ZERO,
        }
    }

    /// A specular sample with the value of the lobe that it chose.
    pub(super) fn specular(
        &self,
        shares: &Shares,
        wo: Vector3,
        (lobe, sample): (Lobe, BsdfSample),
        mode: TransportMode,
    ) -> BsdfSample {
        let cosine = wo.z.abs();
        let weights = self.weights(wo.z);
        let value = match lobe {
            Lobe::Coat => {
                let [wo, wi] = [wo, sample.wi].map(|w| flip(wo.z < 0.0, w));
                let coat = self.specular_coat(wo, wi, mode) * shares.below_fuzz();
                SampledSpectrum::splat(coat * self.stack.coat_weight * weights.layers)
            }
            Lobe::Glass if self.stack.is_thin => {
                let tint = self.absorbed(2.0 * self.coat_length(cosine));
                self.sheet_shares(cosine)[1] * tint * (shares.taken.below_coat * self.glass())
            }
            Lobe::Glass if sample.flags.is_transmissive() => {
                let outside = if wo.z > 0.0 { cosine } else { sample.wi.z };
                let refracted = SampledSpectrum::ONE - self.stack.dielectrics(outside, &self.waves);
                let tint = self.transmission_color * self.absorbed(self.coat_length(outside));
                let passed = match wo.z > 0.0 {
                    true => shares.taken.below_coat,
                    false if self.is_tilted() => self.shares(sample.wi).taken.below_coat,
                    false => self.passed(outside),
                };
                refracted * tint * (passed * self.glass())
            }
            Lobe::Glass if wo.z < 0.0 => self.inner_reflectance(cosine) * self.glass(),
            _ => {
                let tint = self.absorbed(2.0 * self.coat_length(cosine)) * shares.taken.below_coat;
                let weights = match lobe {
                    Lobe::Glass => Weights { metal: 0.0, diffuse: 0.0, ..weights },
                    _ if self.stack.is_thin => weights,
                    _ => Weights { glass: 0.0, ..weights },
                };
                self.reflectance(cosine, &weights) * tint
            }
        };
        let scale = match mode {
            TransportMode::Radiance => 1.0 / sqr(sample.eta),
            TransportMode::Importance => 1.0,
        };
        BsdfSample { f: value * (scale / sample.wi.z.abs()), ..sample }
    }
}
