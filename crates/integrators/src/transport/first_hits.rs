//! The first hits of all samples of a pass.

use film::{FilmTile, Filter, FirstHit};
use geometry::RayStats;
use sampling::Sampler;
use scene::{Scene, View};
use spectrum::SampledWavelengths;

use super::Tracer;
use super::pixel_samples::PixelSamples;
use crate::Control;

/// The first hits of the samples of a pass, for an engine that estimates their radiance elsewhere.
pub struct FirstHits<'a>(PixelSamples<'a>);

impl<'a> FirstHits<'a> {
    /// Those of the samples of this index.
    pub fn new(
        index: u32,
        scene: &'a Scene,
        view: &'a View,
        filter: &'a Filter,
        sampler: &'a Sampler,
    ) -> Self {
        Self(PixelSamples { index, scene, view, filter, sampler, counts: None })
    }

    /// The first hit of a pixel's sample, if an AOV of the film needs it. The albedo is that at
    /// `lambda`. Random numbers that it takes follow those of the camera.
    pub fn of(&self, tile: &FilmTile, pixel: [i32; 2], lambda: &SampledWavelengths) -> Option<FirstHit> {
        let Self(pixels) = self;
        let mut sampler = pixels.sampler.clone();
        let sample = pixels.begin(None, pixel, &mut sampler);
        let (control, mut stats) = (Control::default(), RayStats::default());
        let mut tracer = Tracer::new(pixels.scene, pixels.view, &control, &mut sampler, &mut stats);
        pixels.first_hit(tile, &sample, lambda, &mut tracer)
    }
}
