//! Camera rays for all pixels: makes an integrator of anything that can tell the radiance along a ray.
//!
//! Pass i takes sample i of every pixel. The sampler's coordinates are used in a fixed order: the wavelengths (1), the place
//! in the pixel's filter (2), the moment (1), the place on the lens (2), and then whatever the algorithm asks for.
//! [Pharr 2023 §1.3.4, §5.4.1]

use film::{Film, FilmTile, Filter};
use geometry::RayStats;
use math::{RayDifferential, Vec2};
use rayon::prelude::*;
use sampling::Sampler;
use scene::Scene;
use scene::camera::{CameraRayDifferential, CameraSample, differential_scale};
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::{Cancelled, Control, Integrator};

/// An algorithm that finds the radiance along a ray.
pub trait RayIntegrator: Send + Sync {
    /// Looks at the scene, once, before the first ray.
    fn prepare(&mut self, _scene: &Scene) {}

    /// An estimate of the radiance that arrives along the ray (whose direction has unit length) at the wavelengths
    /// `lambda`, of which dispersion may end all but the first.
    #[doc(alias = "Li")]
    fn li(
        &self,
        scene: &Scene,
        ray: RayDifferential,
        lambda: &mut SampledWavelengths,
        sampler: &mut Sampler,
        stats: &mut RayStats,
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

    fn prepare(&mut self, scene: &Scene) {
        self.rays.prepare(scene);
    }

    fn pass(
        &mut self,
        pass: u32,
        scene: &Scene,
        film: &mut Film,
        control: &Control,
    ) -> Result<RayStats, Cancelled> {
        let filter = film.filter().clone();
        let pixels = PixelSamples { index: pass, scene, filter: &filter, sampler: &self.sampler };
        pixels.add(film.tiles_mut(), control, |sample, sampler, stats| {
            let Some(camera_ray) = sample.camera_ray else { return SampledSpectrum::ZERO };
            let l = self.rays.li(scene, camera_ray.ray, &mut sample.lambda, sampler, stats);
            l * camera_ray.weight
        })
    }
}

/// One sample of each pixel.
#[derive(Clone, Copy)]
pub(crate) struct PixelSamples<'a> {
    /// Which sample.
    pub index: u32,
    pub scene: &'a Scene,
    pub filter: &'a Filter,
    pub sampler: &'a Sampler,
}

/// A sample of a pixel.
pub(crate) struct PixelSample {
    pub pixel: [i32; 2],
    /// The wavelengths at which light is asked for.
    pub lambda: SampledWavelengths,
    /// The moment, in the scene's time.
    pub time: f32,
    /// The ray that it sees along; `None` where the camera sees nothing.
    pub camera_ray: Option<CameraRayDifferential>,
    /// Weight in the pixel.
    pub filter_weight: f32,
}

impl PixelSamples<'_> {
    /// Adds to each pixel of the tiles the light that `radiance` finds there, with the wavelengths as it leaves them. The
    /// sampler that it is given goes on where the sample's own coordinates end.
    pub fn add(
        &self,
        tiles: Vec<FilmTile>,
        control: &Control,
        radiance: impl Fn(&mut PixelSample, &mut Sampler, &mut RayStats) -> SampledSpectrum + Sync,
    ) -> Result<RayStats, Cancelled> {
        let tile = |mut tile: FilmTile| {
            control.check()?;
            let mut sampler = self.sampler.clone();
            let mut stats = RayStats::default();
            let bounds = tile.bounds();
            for y in bounds.min[1]..bounds.max[1] {
                for x in bounds.min[0]..bounds.max[0] {
                    let mut sample = self.begin([x, y], &mut sampler);
                    let l = radiance(&mut sample, &mut sampler, &mut stats);
                    tile.add_sample([x, y], &l, &sample.lambda, sample.filter_weight);
                }
            }
            Ok(stats)
        };
        tiles.into_par_iter().map(tile).try_reduce(RayStats::default, |mut sum, stats| {
            sum += stats;
            Ok(sum)
        })
    }

    /// Sets the sampler to a pixel's sample and takes what the camera needs of it.
    pub fn begin(&self, pixel: [i32; 2], sampler: &mut Sampler) -> PixelSample {
        let options = self.scene.options();
        sampler.start_pixel_sample(pixel, self.index, 0);
        let u = sampler.get_1d();
        let u = if options.disable_wavelength_jitter { 0.5 } else { u };
        let lambda = SampledWavelengths::sample_visible(u);
        let place = self.filter.sample(sampler.get_pixel_2d());
        let (time, lens) = (sampler.get_1d(), sampler.get_2d());
        let center = Vec2::new(pixel[0] as f32 + 0.5, pixel[1] as f32 + 0.5);
        let sample = if options.disable_pixel_jitter {
            CameraSample { film: center, lens: Vec2::splat(0.5), time: 0.5, filter_weight: 1.0 }
        } else {
            CameraSample { film: center + place.offset, lens, time, filter_weight: place.weight }
        };
        let time = self.scene.camera().sample_time(sample.time);
        let camera_ray = self.camera_ray(&sample, sampler.samples_per_pixel());
        PixelSample { pixel, lambda, time, camera_ray, filter_weight: sample.filter_weight }
    }

    fn camera_ray(&self, sample: &CameraSample, samples_per_pixel: u32) -> Option<CameraRayDifferential> {
        let camera = self.scene.camera();
        let camera_ray = if self.scene.has_footprints() {
            camera.generate_ray_differential(sample)
        } else {
            camera.generate_ray(sample).map(|r| CameraRayDifferential { ray: r.ray.into(), weight: r.weight })
        };
        camera_ray.map(|mut camera_ray| {
            camera_ray.ray.scale(differential_scale(samples_per_pixel));
            camera_ray
        })
    }
}
