//! Transparent bases: what is reflected inside, and what passes.

use super::{OpenPbr, View};
use crate::{BsdfSample, Directions, Scatter, TransportMode};
use math::{Vec2, Vector3, same_hemisphere, sqr};
use spectrum::SampledSpectrum;
use std::f32::consts::PI;

impl OpenPbr<'_> {
    /// The cosine outside of light that meets glass from inside at a cosine; `None` if all of it is
    /// reflected.
    pub(super) fn outer_cosine(&self, cosine: f32) -> Option<f32> {
        let squared = 1.0 - (1.0 - sqr(cosine)) * sqr(self.stack.index);
        (squared > 0.0).then(|| squared.sqrt())
    }

    /// The reflectance of facets of glass from inside: what the base reflects, and what the layers
    /// outside do of the rest.
    pub(super) fn inner_reflectance(&self, cosine: f32) -> SampledSpectrum {
        let Some(outer) = self.outer_cosine(cosine) else { return SampledSpectrum::ONE };
        let reflected = self.stack.dielectrics(outer, &self.waves);
        if !self.stack.has_layers() {
            return reflected;
        }
        let kept = 1.0 - self.passed(outer);
        reflected + (SampledSpectrum::ONE - reflected) * kept
    }

    /// The probability that a sample of glass with facets of normal `wm` is reflected.
    pub(super) fn reflects(&self, wo: Vector3, wm: Vector3, directions: Directions) -> f32 {
        match directions {
            Directions::Reflection => 1.0,
            Directions::Transmission => 0.0,
            Directions::All if wo.z > 0.0 => self.stack.dielectrics(wo.dot(wm).abs(), &self.waves).average(),
            Directions::All => self.inner_reflectance(wo.dot(wm).abs()).average(),
        }
    }

    /// A direction sampled by the facets of glass.
    pub(super) fn sample_glass(
        &self,
        wo: Vector3,
        uc: f32,
        u: Vec2,
        mode: TransportMode,
        directions: Directions,
    ) -> BsdfSample {
        let smooth = self.stack.base.effectively_smooth();
        let wm = if smooth { Vector3::Z } else { self.stack.base.sample_wm(wo, u) };
        let reflects = self.reflects(wo, wm, directions);
        let (chance, directions) = match uc < reflects {
            true => (reflects, Directions::Reflection),
            false => (1.0 - reflects, Directions::Transmission),
        };
        let sample = self.boundary().sample_f(wo, 0.5, u, mode, directions);
        BsdfSample { pdf: sample.pdf * chance, ..sample }
    }

    /// The density of [`Self::sample_glass`].
    pub(super) fn pdf_glass(
        &self,
        wo: Vector3,
        wi: Vector3,
        mode: TransportMode,
        directions: Directions,
    ) -> f32 {
        let boundary = self.boundary();
        let (facet, is_met) = boundary.facet(wo, wi);
        if !is_met {
            return 0.0;
        }
        let reflects = self.reflects(wo, facet.wm, directions);
        let (chance, directions) = match same_hemisphere(wo, wi) {
            true => (reflects, Directions::Reflection),
            false => (1.0 - reflects, Directions::Transmission),
        };
        chance * boundary.pdf(wo, wi, mode, directions)
    }

    /// The value of glass for two directions below.
    pub(super) fn reflected_inside(&self, view: &View, wo: Vector3, wi: Vector3) -> SampledSpectrum {
        let boundary = self.boundary();
        let (facet, is_met) = boundary.facet(wo, wi);
        let mut f = SampledSpectrum::ZERO;
        if is_met {
            let white = boundary.f_facet(wo, wi, &facet, 1.0, TransportMode::Radiance);
            f += self.inner_reflectance(wo.dot(facet.wm).abs()) * white;
        }
        if view.rests.glass[1] > 0.0 {
            let [o, i] = [wo, wi].map(|w| self.inside(w).left());
            let left = o * i;
            f += SampledSpectrum::splat(left / (PI * view.rests.glass[1]) * (1.0 - view.rests.through[1]));
        }
        f * self.glass()
    }

    /// The value of glass for directions on both sides.
    pub(super) fn transmitted(
        &self,
        view: &View,
        wo: Vector3,
        wi: Vector3,
        mode: TransportMode,
    ) -> SampledSpectrum {
        let outside = if wo.z > 0.0 { wo } else { wi };
        let inside = if wo.z > 0.0 { wi } else { wo };
        let shares = match wo.z > 0.0 {
            true => view.shares,
            false => self.shares(outside),
        };
        let boundary = self.boundary();
        let (facet, is_met) = boundary.facet(wo, wi);
        let mut f = SampledSpectrum::ZERO;
        if is_met {
            let outer = outside.dot(facet.wm).abs();
            // At least what `inner_reflectance` sends back does not pass.
            let passed = match self.stack.has_layers() {
                true => shares.taken.below_coat.min(self.passed(outer)),
                false => 1.0,
            };
            let white = boundary.f_facet(wo, wi, &facet, 0.0, mode) * passed;
            let reflected = self.stack.dielectrics(outer, &self.waves);
            f += (SampledSpectrum::ONE - reflected) * white;
        }
        if view.rests.glass[1] > 0.0 {
            // The rest of one side to that of the other, as energy from above to below.
            let left = shares.glass_rest * self.inside(inside).left();
            let down = left * view.rests.through[0] / (PI * view.rests.glass[1]);
            let scale = match (mode, wo.z > 0.0) {
                (TransportMode::Importance, true) | (TransportMode::Radiance, false) => 1.0,
                _ => 1.0 / sqr(self.stack.index),
            };
            f += SampledSpectrum::splat(down * scale);
        }
        f * self.transmission_color * self.absorbed(self.coat_length(outside.z)) * self.glass()
    }
}
