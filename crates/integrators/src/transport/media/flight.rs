//! Flights: where a ray interacts with a medium.

use math::{Point3, Ray};
use scattering::HenyeyGreenstein;
use scene::medium::{MediumId, MediumProperties};
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::{Heroes, Throughput, attenuation};
use crate::transport::{Step, Tracer};

/// The end of a flight.
pub(crate) enum FlightEnd {
    /// It reached the end of the ray.
    Passed,
    /// It was scattered.
    Scattered {
        /// Position.
        p: Point3,
        /// Coefficient of scattering there.
        sigma_s: SampledSpectrum,
        /// Coefficient of extinction there.
        sigma_t: SampledSpectrum,
        /// The phase function.
        phase: HenyeyGreenstein,
    },
    /// Nothing is left of it.
    Absorbed,
}

/// A flight along a ray.
pub(crate) struct Flight {
    /// Light that the medium added on the way, as an estimate of radiance.
    pub emitted: SampledSpectrum,
    /// How it ended.
    pub end: FlightEnd,
}

impl Tracer<'_> {
    /// A flight with its own hero, chosen in proportion to `beta`, which becomes the throughput at
    /// its end.
    pub(crate) fn fly_alone(
        &mut self,
        medium: MediumId,
        ray: &Ray,
        t_max: f32,
        lambda: &SampledWavelengths,
        beta: &mut SampledSpectrum,
    ) -> Flight {
        let heroes = Heroes::by_throughput(*beta, lambda.secondary_terminated(), self.sampler.get_1d());
        let mut path = Throughput { beta: *beta, ..Throughput::ONE };
        let flight = self.fly(medium, ray, t_max, lambda, &heroes, &mut path);
        *beta = path.beta / heroes.mean(path.r_u);
        flight
    }

    /// Flies along a ray of unit direction up to `t_max`, which may be infinite.
    #[doc(alias = "SampleT_maj")]
    pub(crate) fn fly(
        &mut self,
        medium: MediumId,
        ray: &Ray,
        t_max: f32,
        lambda: &SampledWavelengths,
        heroes: &Heroes,
        path: &mut Throughput,
    ) -> Flight {
        let hero = heroes.hero;
        let medium = &self.scene.media()[medium.0 as usize];
        let mut emitted = SampledSpectrum::ZERO;
        let homogeneous = medium.homogeneous(lambda);
        if let Some(properties) = &homogeneous {
            emitted = path.estimate(emission(properties, t_max.min(f32::MAX)), heroes);
        }
        // Shadow rays compute the transmittance of homogeneous media, so they pass for certain.
        let is_exact = homogeneous.is_some();
        let mut collisions = self.collisions();
        for segment in medium.majorants(ray, t_max, lambda) {
            let [mut t, end] = segment.t;
            let majorant = segment.majorant;
            if majorant[hero] == 0.0 {
                let passed = attenuation(majorant, end - t);
                path.pass(passed, if is_exact { SampledSpectrum::ONE } else { passed }, 1.0);
                continue;
            }
            loop {
                let next = t + collisions.free_path(majorant[hero]);
                if next >= end {
                    let passed = attenuation(majorant, end - t);
                    let by_shadow_rays = if is_exact { SampledSpectrum::ONE } else { passed };
                    path.pass(passed, by_shadow_rays, passed[hero]);
                    break;
                }
                let (p, passed) = (ray.at(next), attenuation(majorant, next - t));
                t = next;
                let properties = homogeneous.unwrap_or_else(|| medium.at(p, lambda));
                let (sigma_t, pdf) = (properties.sigma_t(), majorant[hero] * passed[hero]);
                if !is_exact && !properties.le.is_black() {
                    let density = path.r_u * majorant * passed / pdf;
                    let source = properties.sigma_a * properties.le;
                    emitted += path.beta * passed * source / (pdf * heroes.mean(density));
                }
                let real = if is_exact { 1.0 } else { (sigma_t[hero] / majorant[hero]).min(1.0) };
                if real == 1.0 || collisions.uniform() < real {
                    let scale = passed / (pdf * real);
                    path.beta *= properties.sigma_s * scale;
                    path.r_u *= sigma_t * scale;
                    let is_left = !path.beta.is_black() && heroes.mean(path.r_u) > 0.0;
                    let scattered =
                        FlightEnd::Scattered { p, sigma_s: properties.sigma_s, sigma_t, phase: medium.phase };
                    let end = if is_left { scattered } else { FlightEnd::Absorbed };
                    self.take_step(|_| Step::Medium { p });
                    return Flight { emitted, end };
                }
                let scale = passed / (pdf * (1.0 - real));
                let null = (majorant - sigma_t).clamp_zero();
                path.beta *= null * scale;
                path.r_u *= null * scale;
                path.r_l *= majorant * scale;
                if path.beta.is_black() || heroes.mean(path.r_u) == 0.0 || !self.may_trace() {
                    return Flight { emitted, end: FlightEnd::Absorbed };
                }
            }
        }
        Flight { emitted, end: FlightEnd::Passed }
    }
}

/// ∫ σ_a L_e exp(−σ_t t) dt over a distance in a homogeneous medium.
fn emission(properties: &MediumProperties, distance: f32) -> SampledSpectrum {
    if properties.le.is_black() {
        return SampledSpectrum::ZERO;
    }
    let sigma_t = properties.sigma_t();
    let lost = sigma_t.map(|sigma| -lanes::exp_m1(-sigma * distance));
    properties.sigma_a * properties.le * lost.safe_div(sigma_t)
}
