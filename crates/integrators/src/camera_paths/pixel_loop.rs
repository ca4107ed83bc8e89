//! Camera rays for all pixels: turns a [`RayIntegrator`] into an [`Integrator`].

use film::Film;
use geometry::RayStats;
use math::RayDifferential;
use sampling::Sampler;
use scene::{Scene, View};
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::transport::pixel_samples::PixelSamples;
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
        let pixels = PixelSamples { index: pass, scene, view, filter: &filter, sampler: &self.sampler };
        let stats = pixels.add(film.tiles_mut()?, control, |sample, tracer| {
            let Some(camera_ray) = sample.camera_ray else { return SampledSpectrum::ZERO };
            let l = self.rays.li(tracer, camera_ray.ray, &mut sample.lambda) * camera_ray.weight;
            tracer.scale_parts(camera_ray.weight);
            l
        })?;
        Ok(stats)
    }
}
