//! The surface of a body that scatters light under it, as if light left where it entered: the
//! reflection by the boundary, and a diffuse base that reflects the effective albedo ρ,
//!
//! ```text
//! f = f_boundary + (1 − Fr(ωo)) ρ (1 − Fr(ωi))/(c π)
//! ```
//!
//! the limit of a short mean free path. This body is opaque from inside.
//!
//! Algorithms that follow paths under the surface take its parts apart. Then light passes the
//! boundary by refraction from outside to inside only, to be seen from there: what comes out has
//! been scattered under the surface ([`Bssrdf`]). For random walks a rough boundary lets in all
//! light that it does not reflect; for diffusion it is pbrt-v4's, which loses what meets a second
//! facet.

use super::{BsdfSample, Dielectric, NormalizedFresnel, Scatter};
use crate::{Bssrdf, BxdfFlags, Directions, SubsurfaceMethod, TransportMode, fr_dielectric};
use math::{Vec2, Vector3, same_hemisphere};
use sampling::HashSequence;
use sampling::warp::{cosine_hemisphere_pdf, sample_cosine_hemisphere};
use spectrum::SampledSpectrum;
use std::f32::consts::FRAC_1_PI;

/// What of a body scatters light at a point of its surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SubsurfacePart {
    /// All of it, as if light left where it entered.
    #[default]
    Whole,
    /// The boundary. A direction that is sampled from above to below, for radiance, is the
    /// beginning of a path under the surface; as light does not pass there by refraction, the value
    /// is zero.
    Boundary,
    /// The boundary where light leaves that has been diffused under it: its transmission from all
    /// directions inside over π, which is estimated by one of them.
    Diffused,
    /// The boundary where light leaves that comes from a direction inside. It can only be sampled,
    /// for importance; the value is zero.
    Leaving,
}

/// A boundary and what is under it.
#[derive(Clone, Copy, Debug)]
pub struct Subsurface<'a> {
    /// The boundary.
    pub boundary: Dielectric,
    /// Scattering under it, of a medium with the boundary's index of refraction.
    pub bssrdf: Bssrdf<'a>,
    /// How light is followed under it.
    pub method: SubsurfaceMethod,
    /// What of it scatters light.
    pub part: SubsurfacePart,
    /// Chooses the estimates of diffused light, see [`Scatter::seed`].
    pub seed: u32,
}

impl Subsurface<'_> {
    /// The base with its albedo.
    fn base(&self) -> (NormalizedFresnel, SampledSpectrum) {
        (self.bssrdf.exit(), self.bssrdf.effective_albedo())
    }

    /// The probability to sample the boundary, and not the base, of an albedo.
    fn boundary_probability(&self, wo: Vector3, albedo: SampledSpectrum) -> f32 {
        if self.part == SubsurfacePart::Diffused || !self.boundary.flags().is_reflective() {
            return 0.0;
        }
        let reflected = fr_dielectric(wo.z, self.boundary.eta);
        let (all, _) =
            Directions::All.probability_of_reflection(reflected, (1.0 - reflected) * albedo.average());
        if reflected > 0.0 { all } else { 0.0 }
    }

    /// The value of the base.
    fn diffused(&self, wo: Vector3, wi: Vector3, mode: TransportMode) -> SampledSpectrum {
        let (lobe, albedo) = self.base();
        lobe.f(wo, wi, mode) * albedo * (1.0 - fr_dielectric(wo.z, self.boundary.eta))
    }

    /// By how much more counts what the boundary refracts between two directions, of which one is
    /// above.
    fn gain(&self, wo: Vector3, wi: Vector3) -> f32 {
        if self.method == SubsurfaceMethod::Diffusion || self.boundary.flags().is_specular() {
            return 1.0;
        }
        self.bssrdf.gain(&self.boundary.distribution, if wo.z > 0.0 { wo } else { wi })
    }

    /// A sample of the boundary.
    fn sample_boundary(
        &self,
        wo: Vector3,
        uc: f32,
        u: Vec2,
        mode: TransportMode,
        directions: Directions,
    ) -> BsdfSample {
        let sample = self.boundary.sample_f(wo, uc, u, mode, directions);
        if !(sample.valid && sample.flags.is_transmissive()) {
            return sample;
        }
        BsdfSample { f: sample.f * self.gain(wo, sample.wi), ..sample }
    }

    /// The value of the base where light leaves to `wi`: the transmission from there.
    fn left(&self, wi: Vector3) -> f32 {
        let mut sequence = HashSequence::new([self.seed, wi.x.to_bits(), wi.y.to_bits(), wi.z.to_bits()]);
        let (uc, u) = (sequence.get_1d(), sequence.get_2d());
        let mode = TransportMode::Importance;
        let sample = self.boundary.sample_f(wi, uc, u, mode, Directions::Transmission);
        let passes = if sample.valid { sample.f[0] * sample.wi.z.abs() / sample.pdf } else { 0.0 };
        passes * FRAC_1_PI
    }
}

impl Scatter for Subsurface<'_> {
    fn flags(&self) -> BxdfFlags {
        match self.part {
            SubsurfacePart::Whole => (),
            SubsurfacePart::Boundary => return self.boundary.flags(),
            SubsurfacePart::Diffused => return BxdfFlags::DIFFUSE_REFLECTION,
            SubsurfacePart::Leaving => return BxdfFlags::SPECULAR_TRANSMISSION,
        }
        let kinds = [BxdfFlags::GLOSSY_REFLECTION, BxdfFlags::SPECULAR_REFLECTION];
        let boundary = self.boundary.flags();
        let reflects = kinds.into_iter().find(|&kind| boundary.contains(kind));
        reflects.unwrap_or(BxdfFlags::NONE) | BxdfFlags::DIFFUSE_REFLECTION
    }

    fn f(&self, wo: Vector3, wi: Vector3, mode: TransportMode) -> SampledSpectrum {
        let is_above = wo.z > 0.0 && wi.z > 0.0;
        match self.part {
            SubsurfacePart::Whole if is_above => self.boundary.f(wo, wi, mode) + self.diffused(wo, wi, mode),
            SubsurfacePart::Boundary if same_hemisphere(wo, wi) => self.boundary.f(wo, wi, mode),
            SubsurfacePart::Boundary if !leaves(wo, wi, mode) => {
                self.boundary.f(wo, wi, mode) * self.gain(wo, wi)
            }
            SubsurfacePart::Diffused if is_above => SampledSpectrum::splat(self.left(wi)),
            _ => SampledSpectrum::ZERO,
        }
    }

    fn sample_f(
        &self,
        wo: Vector3,
        uc: f32,
        u: Vec2,
        mode: TransportMode,
        directions: Directions,
    ) -> BsdfSample {
        let enters = mode == TransportMode::Radiance;
        match self.part {
            SubsurfacePart::Boundary => {
                let sample = self.sample_boundary(wo, uc, u, mode, directions);
                return BsdfSample {
                    valid: sample.valid && (enters || !leaves(wo, sample.wi, mode)),
                    ..sample
                };
            }
            SubsurfacePart::Leaving if wo.z < 0.0 && !enters && directions.transmission() => {
                return self.sample_boundary(wo, uc, u, mode, Directions::Transmission);
            }
            SubsurfacePart::Leaving => return BsdfSample::invalid(),
            SubsurfacePart::Whole | SubsurfacePart::Diffused => (),
        }
        if !(wo.z > 0.0 && directions.reflection()) {
            return BsdfSample::invalid();
        }
        let p = self.boundary_probability(wo, self.bssrdf.effective_albedo());
        let (wi, lobe) = if uc < p {
            let mirrored = self.boundary.sample_f(wo, uc / p, u, mode, Directions::Reflection);
            if mirrored.flags.is_specular() || !mirrored.valid {
                return BsdfSample { pdf: mirrored.pdf * p, ..mirrored };
            }
            (mirrored.wi, mirrored.flags)
        } else {
            (sample_cosine_hemisphere(u), BxdfFlags::DIFFUSE_REFLECTION)
        };
        let pdf = self.pdf(wo, wi, mode, directions);
        BsdfSample { valid: pdf > 0.0, ..BsdfSample::new(self.f(wo, wi, mode), wi, pdf, lobe) }
    }

    fn pdf(&self, wo: Vector3, wi: Vector3, mode: TransportMode, directions: Directions) -> f32 {
        let samples = match self.part {
            SubsurfacePart::Boundary => mode == TransportMode::Radiance || !leaves(wo, wi, mode),
            SubsurfacePart::Leaving => false,
            SubsurfacePart::Whole | SubsurfacePart::Diffused => {
                wo.z > 0.0 && wi.z > 0.0 && directions.reflection()
            }
        };
        if !samples {
            return 0.0;
        }
        if self.part == SubsurfacePart::Boundary {
            return self.boundary.pdf(wo, wi, mode, directions);
        }
        let p = self.boundary_probability(wo, self.bssrdf.effective_albedo());
        let boundary = self.boundary.pdf(wo, wi, mode, Directions::Reflection);
        p * boundary + (1.0 - p) * cosine_hemisphere_pdf(wi.z)
    }

    fn regularize(&mut self, mask: bool) {
        self.boundary.regularize(mask);
    }

    fn seed(&mut self, seed: u32) {
        self.seed = seed;
    }
}

/// Whether light goes from below to above.
fn leaves(wo: Vector3, wi: Vector3, mode: TransportMode) -> bool {
    let (from, to) = match mode {
        TransportMode::Radiance => (wi, wo),
        TransportMode::Importance => (wo, wi),
    };
    from.z < 0.0 && to.z > 0.0
}
