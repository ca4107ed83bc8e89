//! Adaptive supersampling: more samples where neighbouring pixels differ.
//!
//! A ray tracer that takes as many samples everywhere spends most of them on pixels that are right
//! already. So a coarse picture is made first, a sixteenth of the samples. Where its values differ
//! among neighbours, as at edges, in fine patterns and in noise, a pixel takes more samples
//! [Whitted 1980]. The standard error of a pixel with n samples is σ/√n, and for a given number of
//! samples in all, errors are least where n is in proportion to σ. The contrast of the
//! neighbourhood stands for σ:
//!
//! ```text
//! n = N · contrast / limit,  N/16 ≤ n ≤ N
//! ```
//!
//! The samples of the coarse picture have other random numbers and are not used again: if they
//! counted, a pixel whose first samples happen to be dark and alike would keep them, and the
//! picture would be too dark at edges [Kirk & Arvo 1991]. So it has the mean of the picture with N
//! samples everywhere.

use film::{Development, Film, FilmTile, Filter};
use geometry::RayStats;
use image::{WrapMode, srgb_from_linear};
use sampling::Sampler;
use scene::{Scene, View};

use crate::transport::pixel_samples::PixelSamples;
use crate::transport::sample_counts::SampleCounts;
use crate::{Cancelled, Control, Integrator, PassError, Record};

/// The samples of the coarse picture are one of as many, and so are those that every pixel takes.
const LEAST_SHARE: u32 = 16;

/// An algorithm that estimates pixels one by one.
pub(crate) trait PixelIntegrator: Integrator {
    /// Adds the samples to the tiles of a film.
    fn add(
        &self,
        samples: &PixelSamples,
        tiles: Vec<FilmTile>,
        control: &Control,
    ) -> Result<RayStats, Cancelled>;
}

/// Takes more samples where neighbouring pixels differ.
pub(crate) struct Adaptive<I> {
    integrator: I,
    sampler: Sampler,
    /// Of the coarse picture.
    coarse: Sampler,
    /// The contrast from which a pixel takes all samples.
    limit: f32,
    counts: Option<SampleCounts>,
}

impl<I: PixelIntegrator> Adaptive<I> {
    /// For an algorithm with the sampler of its own, and another one of as many samples per pixel
    /// and other random numbers. Contrasts are differences of sRGB codes, of 0 to 1.
    pub fn new(integrator: I, samplers: [Sampler; 2], limit: f32) -> Self {
        let [sampler, coarse] = samplers;
        Self { integrator, sampler, coarse, limit, counts: None }
    }

    /// Decides how many samples each pixel of the film takes.
    fn plan(
        &self,
        scene: &Scene,
        view: &View,
        film: &Film,
        control: &Control,
    ) -> Result<(SampleCounts, RayStats), PassError> {
        let (mut coarse, filter) = (film.blank()?, film.filter().clone());
        let most = self.sampler.samples_per_pixel();
        let least = most.div_ceil(LEAST_SHARE);
        let mut stats = RayStats::default();
        for index in 0..least {
            let filter = &filter;
            let samples = PixelSamples { index, scene, view, filter, sampler: &self.coarse, counts: None };
            stats += self.integrator.add(&samples, coarse.tiles_mut()?, control)?;
        }
        let count = |contrast: f32| ((contrast / self.limit * most as f32).ceil() as u32).clamp(least, most);
        let counts = contrasts(&coarse)?.into_iter().map(count).collect();
        Ok((SampleCounts::new(film.pixel_bounds(), most, counts), stats))
    }
}

impl<I: PixelIntegrator> Integrator for Adaptive<I> {
    fn passes(&self) -> u32 {
        self.integrator.passes()
    }

    fn prepare(&mut self, scene: &Scene, view: &View, control: &Control) -> Result<(), Cancelled> {
        self.counts = None;
        self.integrator.prepare(scene, view, control)
    }

    fn pass(
        &mut self,
        pass: u32,
        scene: &Scene,
        view: &View,
        film: &mut Film,
        control: &Control,
    ) -> Result<RayStats, PassError> {
        let mut stats = RayStats::default();
        if self.counts.is_none() {
            let (counts, rays) = self.plan(scene, view, film, control)?;
            self.counts = Some(counts);
            stats += rays;
        }
        let (filter, sampler) = (&film.filter().clone(), &self.sampler);
        let counts = self.counts.as_ref();
        let samples = PixelSamples { index: pass, scene, view, filter, sampler, counts };
        stats += self.integrator.add(&samples, film.tiles_mut()?, control)?;
        Ok(stats)
    }

    fn record(
        &self,
        pixel: [i32; 2],
        index: u32,
        scene: &Scene,
        view: &View,
        filter: &Filter,
        control: &Control,
    ) -> Option<Result<Record, Cancelled>> {
        self.integrator.record(pixel, index, scene, view, filter, control)
    }

    fn summary(&self) -> Vec<(&'static str, String)> {
        let most = self.sampler.samples_per_pixel();
        let mean = self.counts.as_ref().map(SampleCounts::mean);
        let mean = mean.map(|mean| ("samples a pixel", format!("{mean:.1} of {most} planned")));
        self.integrator.summary().into_iter().chain(mean).collect()
    }
}

/// The contrast of each pixel's neighbourhood of 3 × 3 pixels, row by row: the largest difference
/// of two sRGB codes of a channel.
fn contrasts(film: &Film) -> Result<Vec<f32>, PassError> {
    let picture = Development::of_colors(film, None).to_image()?;
    let [width, height] = [picture.width() as i32, picture.height() as i32];
    let contrast = |x: i32, y: i32| {
        let [mut least, mut most] = [[1.0_f32; 3], [0.0_f32; 3]];
        for [dx, dy] in (-1..2).flat_map(|dy| (-1..2).map(move |dx| [dx, dy])) {
            for (c, value) in picture.rgb_wrapped(x + dx, y + dy, WrapMode::Clamp).into_iter().enumerate() {
                let code = srgb_from_linear(value.clamp(0.0, 1.0));
                (least[c], most[c]) = (least[c].min(code), most[c].max(code));
            }
        }
        (0..3).map(|c| most[c] - least[c]).fold(0.0, f32::max)
    };
    Ok((0..height).flat_map(|y| (0..width).map(move |x| [x, y])).map(|[x, y]| contrast(x, y)).collect())
}
