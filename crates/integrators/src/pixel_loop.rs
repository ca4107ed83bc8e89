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

    /// Takes one sample of each pixel of a tile.
    fn tile(
        &self,
        index: u32,
        scene: &Scene,
        filter: &Filter,
        tile: &mut FilmTile,
        control: &Control,
    ) -> Result<RayStats, Cancelled> {
        control.check()?;
        let mut sampler = self.sampler.clone();
        let mut stats = RayStats::default();
        let bounds = tile.bounds();
        for y in bounds.min[1]..bounds.max[1] {
            for x in bounds.min[0]..bounds.max[0] {
                sampler.start_pixel_sample([x, y], index, 0);
                let u = sampler.get_1d();
                let u = if scene.options().disable_wavelength_jitter { 0.5 } else { u };
                let mut lambda = SampledWavelengths::sample_visible(u);
                let camera_sample = camera_sample(scene, filter, [x, y], &mut sampler);
                let l = self.radiance(scene, &camera_sample, &mut lambda, &mut sampler, &mut stats);
                tile.add_sample([x, y], &l, &lambda, camera_sample.filter_weight);
            }
        }
        Ok(stats)
    }

    /// The radiance that reaches the film there; black where the camera sees nothing.
    fn radiance(
        &self,
        scene: &Scene,
        sample: &CameraSample,
        lambda: &mut SampledWavelengths,
        sampler: &mut Sampler,
        stats: &mut RayStats,
    ) -> SampledSpectrum {
        let Some(camera_ray) = camera_ray(scene, sample, sampler.samples_per_pixel()) else {
            return SampledSpectrum::ZERO;
        };
        self.rays.li(scene, camera_ray.ray, lambda, sampler, stats) * camera_ray.weight
    }
}

/// The ray of a camera sample, with differentials where they are of use; `None` where the camera sees nothing.
pub(crate) fn camera_ray(
    scene: &Scene,
    sample: &CameraSample,
    samples_per_pixel: u32,
) -> Option<CameraRayDifferential> {
    let camera = scene.camera();
    let mut camera_ray = if scene.has_footprints() {
        camera.generate_ray_differential(sample)?
    } else {
        let ray = camera.generate_ray(sample)?;
        CameraRayDifferential { ray: ray.ray.into(), weight: ray.weight }
    };
    camera_ray.ray.scale(differential_scale(samples_per_pixel));
    Some(camera_ray)
}

/// Where, when and through which point of the lens a sample of a pixel looks.
pub(crate) fn camera_sample(
    scene: &Scene,
    filter: &Filter,
    pixel: [i32; 2],
    sampler: &mut Sampler,
) -> CameraSample {
    let place = filter.sample(sampler.get_pixel_2d());
    let (time, lens) = (sampler.get_1d(), sampler.get_2d());
    let center = Vec2::new(pixel[0] as f32 + 0.5, pixel[1] as f32 + 0.5);
    if scene.options().disable_pixel_jitter {
        return CameraSample { film: center, lens: Vec2::splat(0.5), time: 0.5, filter_weight: 1.0 };
    }
    CameraSample { film: center + place.offset, lens, time, filter_weight: place.weight }
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
        film.tiles_mut()
            .into_par_iter()
            .map(|mut tile| self.tile(pass, scene, &filter, &mut tile, control))
            .try_reduce(RayStats::default, |mut sum, stats| {
                sum += stats;
                Ok(sum)
            })
    }
}
