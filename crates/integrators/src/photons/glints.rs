//! Glints: lamps that the camera sees in mirrors and through smooth glass.
//!
//! What comes to the camera by specular surfaces alone is found by camera rays alone, since nothing
//! can be connected to such a surface or merged at it. The image of a small lamp may be much
//! smaller than a pixel: one ray in thousands meets it, and makes its pixel as many times too
//! bright. Only more rays help. They cost little beside a sample of all strategies, as they are
//! followed no further than to the first surface that is not specular.
//!
//! A pixel is looked at again if its own camera ray came to a specular surface first, which costs
//! nothing where there are none, and if there is any light that rays can meet. Let S₁ be that
//! event, and g₁ the light that the ray then finds by specular surfaces alone; S_i and g_i those of
//! further rays, which have nothing to do with the first but its pixel, and w their weights in the
//! filter. Then the pixel's sample is
//!
//! ```text
//! (w₁g₁ + Σ w_i·g_i·[S_i]) / (1 + Σ [S_i])   if S₁, else 0
//! ```
//!
//! Further rays of which S_i does not hold are thrown away. Given S₁ and how many others are left,
//! all that are summed have the same mean E[w·g | S], and so has their average. As S₁ has the
//! probability P(S), the whole has the mean P(S)·E[w·g | S] = E[w·g·[S]], which is that of a single
//! ray: nothing is biased.

use sampling::sampler::PaddedSobol;
use sampling::{Randomize, Sampler};
use scene::Scene;
use spectrum::SampledSpectrum;

use crate::bidirectional::{Bidirectional, Found, OnTheWay, Vertex};
use crate::transport::Tracer;
use crate::transport::pixel_samples::{PixelSample, PixelSamples};
use crate::transport::shutter_sample::ShutterSample;

/// Further rays for a sample of a pixel that sees something specular.
const FURTHER_LOOKS: u32 = 4;

/// What a camera subpath has seen by specular surfaces alone.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Look {
    /// Whether its first vertex is specular.
    is_specular: bool,
    /// Whether it has come to a vertex that is not.
    is_over: bool,
    l: SampledSpectrum,
}

impl Look {
    /// The subpath comes to a vertex.
    pub fn meet(&mut self, vertex: &Vertex) {
        self.is_over |= vertex.is_connectible();
        self.is_specular |= !self.is_over;
    }

    /// The subpath has found light; `false` if that is none of the look's.
    pub fn take(&mut self, found: &Found) -> bool {
        let is_glint = self.is_specular && !self.is_over;
        if is_glint {
            self.l += found.weighted();
        }
        is_glint
    }
}

/// Looks at pixels again.
#[derive(Clone, Debug)]
pub(crate) struct Glints {
    sampler: Sampler,
    /// Whether the scene has lights that rays can meet.
    are_possible: bool,
}

impl Glints {
    /// For as many samples of a pixel, with a seed that has nothing in common with that of other
    /// samplers.
    pub fn new(samples_per_pixel: u32, seed: u32) -> Self {
        let samples = samples_per_pixel.saturating_mul(FURTHER_LOOKS);
        let sampler = Sampler::PaddedSobol(PaddedSobol::new(samples, Randomize::FastOwen, seed));
        Self { sampler, are_possible: true }
    }

    /// Looks at the scene, once, before the first pass.
    pub fn prepare(&mut self, scene: &Scene) {
        self.are_possible = scene.lights().iter().any(|light| !light.is_delta());
    }

    /// The glints of a sample whose camera subpath has seen `first`.
    pub fn seen(
        &self,
        first: &Look,
        sample: &PixelSample,
        pixels: &PixelSamples,
        shutter: &ShutterSample,
        paths: &Bidirectional,
        tracer: &mut Tracer,
    ) -> SampledSpectrum {
        let (mut l, mut looks) = (first.l, 1.0);
        if !(first.is_specular && self.are_possible) {
            return l;
        }
        let mut sampler = self.sampler.clone();
        for i in 0..FURTHER_LOOKS {
            let pixels =
                PixelSamples { index: pixels.index * FURTHER_LOOKS + i, sampler: &self.sampler, ..*pixels };
            let again = pixels.begin(Some(shutter), sample.pixel, &mut sampler);
            let Some(camera_ray) = &again.camera_ray else { continue };
            let (is_end, lambda, mut look) = (Vertex::is_connectible, &again.lambda, Look::default());
            tracer.with_sampler(&mut sampler, |tracer| {
                paths.camera_subpath_to(
                    is_end,
                    camera_ray,
                    lambda,
                    tracer,
                    |on_the_way, _| match on_the_way {
                        OnTheWay::Light(found) => _ = look.take(&found),
                        OnTheWay::Vertex(vertex) => look.meet(vertex),
                    },
                );
            });
            if look.is_specular {
                l += look.l * (again.filter_weight / sample.filter_weight);
                looks += 1.0;
            }
        }
        l / looks
    }
}
