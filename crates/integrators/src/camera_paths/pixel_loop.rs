//! Camera rays for all pixels: turns a [`RayIntegrator`] into an [`Integrator`].

use film::{Film, FilmTile, Filter};
use geometry::RayStats;
use math::RayDifferential;
use sampling::Sampler;
use scene::{Scene, View};
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::adaptive::PixelIntegrator;
use crate::transport::Record;
use crate::transport::pixel_samples::{PixelSample, PixelSamples};
use crate::{Cancelled, Control, Integrator, PassError, Tracer};

/// An algorithm that estimates the radiance along a ray.
pub trait RayIntegrator: Send + Sync {
    /// Called once, before the first ray. `Err` if the render was cancelled.
    fn prepare(&mut self, _scene: &Scene, _view: &View, _control: &Control) -> Result<(), Cancelled> {
        Ok(())
    }

    /// An estimate of the radiance that arrives along the ray (whose direction has unit length) at
    /// the wavelengths `lambda`, of which dispersion may terminate all but the first.
    #[doc(alias = "Li")]
    fn li(
        &self,
        tracer: &mut Tracer,
        ray: RayDifferential,
        lambda: &mut SampledWavelengths,
    ) -> SampledSpectrum;
}

/// The steps of one sample of a pixel.
pub(crate) fn record(
    rays: &impl RayIntegrator,
    pixels: &PixelSamples,
    pixel: [i32; 2],
    control: &Control,
) -> Result<Record, Cancelled> {
    let (mut sampler, mut stats, mut steps) = (pixels.sampler.clone(), RayStats::default(), Vec::new());
    let PixelSample { camera_ray, mut lambda, .. } = pixels.begin(None, pixel, &mut sampler);
    let tracer = Tracer::new(pixels.scene, pixels.view, control, &mut sampler, &mut stats);
    let mut tracer = tracer.with_steps(&mut steps);
    let l = camera_ray.map_or(SampledSpectrum::ZERO, |camera_ray| {
        rays.li(&mut tracer, camera_ray.ray, &mut lambda) * camera_ray.weight
    });
    tracer.finish()?;
    Ok(Record { lambda, l, steps })
}

/// Runs a [`RayIntegrator`] for each sample of each pixel.
#[derive(Clone, Debug)]
pub struct PixelLoop<R> {
    rays: R,
    sampler: Sampler,
}

impl<R: RayIntegrator> PixelLoop<R> {
    /// With as many passes as the sampler has samples per pixel.
    pub fn new(rays: R, sampler: Sampler) -> Self {
        Self { rays, sampler }
    }
}

impl<R: RayIntegrator> Integrator for PixelLoop<R> {
    fn passes(&self) -> u32 {
        self.sampler.samples_per_pixel()
    }

    fn prepare(&mut self, scene: &Scene, view: &View, control: &Control) -> Result<(), Cancelled> {
        self.rays.prepare(scene, view, control)
    }

    fn pass(
        &mut self,
        pass: u32,
        scene: &Scene,
        view: &View,
        film: &mut Film,
        control: &Control,
    ) -> Result<RayStats, PassError> {
        let filter = film.filter().clone();
        let (filter, sampler) = (&filter, &self.sampler);
        let pixels = PixelSamples { index: pass, scene, view, filter, sampler, counts: None };
        Ok(self.add(&pixels, film.tiles_mut()?, control)?)
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
        let pixels = PixelSamples { index, scene, view, filter, sampler: &self.sampler, counts: None };
        Some(record(&self.rays, &pixels, pixel, control))
    }
}

impl<R: RayIntegrator> PixelIntegrator for PixelLoop<R> {
    fn add(
        &self,
        samples: &PixelSamples,
        tiles: Vec<FilmTile>,
        control: &Control,
    ) -> Result<RayStats, Cancelled> {
        samples.add(tiles, control, |sample, tracer| {
            let Some(camera_ray) = sample.camera_ray else { return SampledSpectrum::ZERO };
            let l = self.rays.li(tracer, camera_ray.ray, &mut sample.lambda) * camera_ray.weight;
            tracer.scale_parts(camera_ray.weight);
            l
        })
    }
}
