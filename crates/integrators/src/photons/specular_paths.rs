//! Additional camera rays for purely specular paths.
//!
//! No vertex of a specular path can be connected or merged, so it is found by camera rays only. The
//! image of a small light in a mirror may be much smaller than a pixel: few rays hit it, and those
//! are fireflies. Only more rays help. They cost little compared with a sample of all strategies,
//! because they end at the first surface that is not specular.
//!
//! A pixel gets further rays if its own camera ray hits a specular surface first, and if there are
//! lights that rays can hit. Let S₁ be that first event, and g₁ the radiance of the ray's purely
//! specular paths; S_i and g_i are those of the further rays, which are independent samples of the
//! same pixel, and w their filter weights. The estimate for the pixel is
//!
//! ```text
//! (w₁g₁ + Σ w_i·g_i·[S_i]) / (1 + Σ [S_i])   if S₁, else 0
//! ```
//!
//! Further rays without S_i are discarded. Given S₁ and the number of the remaining rays, all terms
//! have the same mean E[w·g | S], and so has their average. As S₁ has the probability P(S), the
//! estimate has the mean P(S)·E[w·g | S] = E[w·g·[S]], that of a single ray: it is unbiased.

use sampling::sampler::PaddedSobol;
use sampling::{Randomize, Sampler};
use scene::{Scene, ShutterSample};
use spectrum::SampledSpectrum;

use crate::bidirectional::{Bidirectional, Encounter, Found, Vertex};
use crate::transport::Tracer;
use crate::transport::pixel_samples::{PixelSample, PixelSamples};

/// Further rays for a sample of a pixel that sees a specular surface.
const FURTHER_RAYS: u32 = 4;

/// The initial specular vertices of a camera subpath, and the light found through them.
#[derive(Clone, Debug, Default)]
pub(crate) struct SpecularChain {
    /// Whether its first vertex is specular.
    is_specular: bool,
    /// Whether a vertex was not specular.
    is_over: bool,
    found: Vec<Found>,
}

impl SpecularChain {
    /// Visits the next vertex of the subpath.
    pub fn visit(&mut self, vertex: &Vertex) {
        self.is_over |= vertex.is_connectible();
        self.is_specular |= !self.is_over;
    }

    /// Adds light that the subpath has hit; `false` if other vertices than those of the chain come
    /// before it.
    pub fn add(&mut self, found: &Found) -> bool {
        let belongs = self.is_specular && !self.is_over;
        if belongs {
            self.found.push(*found);
        }
        belongs
    }
}

/// Traces the further rays.
#[derive(Clone, Debug)]
pub(crate) struct SpecularPaths {
    sampler: Sampler,
    /// Whether the scene has lights that rays can hit.
    are_possible: bool,
}

impl SpecularPaths {
    /// The seed must differ from those of other samplers.
    pub fn new(samples_per_pixel: u32, seed: u32) -> Self {
        let samples = samples_per_pixel.saturating_mul(FURTHER_RAYS);
        let sampler = Sampler::PaddedSobol(PaddedSobol::new(samples, Randomize::FastOwen, seed));
        Self { sampler, are_possible: true }
    }

    /// Called once, before the first pass.
    pub fn prepare(&mut self, scene: &Scene) {
        self.are_possible = scene.lights().iter().any(|light| !light.is_delta());
    }

    /// The radiance of purely specular paths of a sample whose camera subpath began with `first`.
    pub fn radiance(
        &self,
        first: SpecularChain,
        sample: &PixelSample,
        pixels: &PixelSamples,
        shutter: &ShutterSample,
        paths: &Bidirectional,
        tracer: &mut Tracer,
    ) -> SampledSpectrum {
        let more = if first.is_specular && self.are_possible { FURTHER_RAYS } else { 0 };
        // Light with its weight in the sum.
        let mut all: Vec<(Found, f32)> = first.found.into_iter().map(|found| (found, 1.0)).collect();
        let (mut rays, mut sampler) = (1.0, self.sampler.clone());
        for i in 0..more {
            let pixels =
                PixelSamples { index: pixels.index * FURTHER_RAYS + i, sampler: &self.sampler, ..*pixels };
            let again = pixels.begin(Some(shutter), sample.pixel, &mut sampler);
            let Some(camera_ray) = &again.camera_ray else { continue };
            let (is_end, lambda, mut chain) =
                (Vertex::is_connectible, &again.lambda, SpecularChain::default());
            tracer.with_sampler(&mut sampler, |tracer| {
                paths.camera_subpath_to(is_end, camera_ray, lambda, tracer, |encounter, _| match encounter {
                    Encounter::Light(found) => _ = chain.add(&found),
                    Encounter::Vertex(vertex) => chain.visit(vertex),
                });
            });
            if chain.is_specular {
                let weight = again.filter_weight / sample.filter_weight;
                all.extend(chain.found.into_iter().map(|found| (found, weight)));
                rays += 1.0;
            }
        }
        let mut sum = SampledSpectrum::ZERO;
        for (found, weight) in all {
            let l = found.weighted() * weight;
            sum += l;
            tracer.take_part(found.light, &found.first, found.events(), l / rays);
        }
        sum / rays
    }
}
