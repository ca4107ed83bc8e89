//! Light that a medium adds to a ray by itself and by one scattering event, for algorithms without
//! random paths: ray casting and Whitted's ray tracing.
//!
//! They follow the ray through the medium with its transmittance, and add what the medium emits,
//! and the light of all lights that it scatters at one random point of the ray.

use math::Ray;
use scene::medium::MediumId;
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::Tracer;
use super::direct::connect_all_in_medium;
use super::media::FlightEnd;
use super::vertex::MediumVertex;

/// What single scattering takes into account.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scattering {
    /// Emission only.
    None,
    /// Light of lights, as if nothing were in between.
    Unshadowed,
    /// Light of lights.
    Shadowed,
}

impl Tracer<'_> {
    /// The radiance that a medium adds to a ray of unit direction up to `t_max`.
    pub(crate) fn single_scattering(
        &mut self,
        medium: MediumId,
        ray: &Ray,
        t_max: f32,
        scattering: Scattering,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        let mut beta = SampledSpectrum::ONE;
        let flight = self.fly_alone(medium, ray, t_max, lambda, &mut beta);
        let FlightEnd::Scattered { p, phase, .. } = flight.end else { return flight.emitted };
        if scattering == Scattering::None {
            return flight.emitted;
        }
        let vertex = MediumVertex::new(p, ray, phase);
        let mut connections = Vec::new();
        let push = |light| connections.push(light);
        connect_all_in_medium(self.scene, self.sampler, &vertex, lambda, push);
        let mut sum = SampledSpectrum::ZERO;
        for light in connections {
            sum += match scattering {
                Scattering::Shadowed => light.arriving(Some(medium), lambda, self),
                _ => light.l,
            };
        }
        flight.emitted + beta * sum
    }
}
