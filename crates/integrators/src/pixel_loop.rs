//! Camera rays for all pixels: makes an integrator of anything that can tell the radiance along a
//! ray.
//!
//! Pass i takes sample i of every pixel. The sampler's coordinates are used in a fixed order: the
//! wavelengths (1), the place in the pixel's filter (2), the moment (1), the place on the lens (2),
//! and then whatever the algorithm asks for. [Pharr 2023 §1.3.4, §5.4.1]

use film::{Film, FilmTile, Filter};
use geometry::RayStats;
use math::{RayDifferential, Vec2};
use rayon::prelude::*;
use sampling::{Sampler, hash};
use scene::Scene;
use scene::camera::{CameraRayDifferential, CameraSample, differential_scale};
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::{Cancelled, Control, Integrator};

/// An algorithm that finds the radiance along a ray.
pub trait RayIntegrator: Send + Sync {
    /// Looks at the scene, once, before the first ray.
    fn prepare(&mut self, _scene: &Scene) {}

    /// An estimate of the radiance that arrives along the ray (whose direction has unit length) at
    /// the wavelengths `lambda`, of which dispersion may end all but the first.
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

/// When a path is followed, and at which wavelengths.
#[derive(Clone, Copy)]
pub(crate) struct Moment {
    /// The wavelengths.
    pub lambda: SampledWavelengths,
    /// The part of the shutter's time that has gone by.
    shutter: f32,
}

impl Moment {
    /// From two sample values in [0, 1), as far as the scene lets them choose.
    pub fn new(scene: &Scene, wavelength: f32, shutter: f32) -> Self {
        let options = scene.options();
        let wavelength = if options.disable_wavelength_jitter { 0.5 } else { wavelength };
        let shutter = if options.disable_pixel_jitter { 0.5 } else { shutter };
        Self { lambda: SampledWavelengths::sample_visible(wavelength), shutter }
    }

    /// That which all paths of a pass share. Over the passes both are spread evenly: each step goes
    /// on by an irrational part of the range. For wavelengths that is a quarter of the golden
    /// ratio, because four of them, a quarter apart, are taken at once.
    pub fn of_pass(scene: &Scene, seed: u32, pass: u32) -> Self {
        // Parts of 2³²: a quarter of the golden ratio, and √2 − 1.
        const STEPS: [u32; 2] = [0x678d_de6e, 0x6a09_e667];
        let [wavelength, shutter] = [0, 1].map(|i| {
            let start = hash(&[seed, i]) as u32;
            let bits = start.wrapping_add(pass.wrapping_mul(STEPS[i as usize]));
            (bits >> 8) as f32 / (1 << 24) as f32
        });
        Self::new(scene, wavelength, shutter)
    }

    /// In the scene's time.
    pub fn time(&self, scene: &Scene) -> f32 {
        scene.camera().sample_time(self.shutter)
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
    /// Adds to each pixel of the tiles the light that `radiance` finds there, with the wavelengths
    /// as it leaves them. The sampler that it is given goes on where the sample's own coordinates
    /// end.
    pub fn add(
        &self,
        tiles: Vec<FilmTile>,
        control: &Control,
        radiance: impl Fn(&mut PixelSample, &mut Sampler, &mut RayStats) -> SampledSpectrum + Sync,
    ) -> Result<RayStats, Cancelled> {
        self.add_at(None, tiles, control, radiance)
    }

    /// The same; all samples have the wavelengths and the time of `moment`, if there is one.
    pub fn add_at(
        &self,
        moment: Option<&Moment>,
        tiles: Vec<FilmTile>,
        control: &Control,
        radiance: impl Fn(&mut PixelSample, &mut Sampler, &mut RayStats) -> SampledSpectrum + Sync,
    ) -> Result<RayStats, Cancelled> {
        let tile = |mut tile: FilmTile| {
            let mut sampler = self.sampler.clone();
            let mut stats = RayStats::default();
            let bounds = tile.bounds();
            let done = (bounds.min[1]..bounds.max[1]).try_for_each(|y| {
                control.check()?;
                for x in bounds.min[0]..bounds.max[0] {
                    let mut sample = self.begin(moment, [x, y], &mut sampler);
                    let l = radiance(&mut sample, &mut sampler, &mut stats);
                    tile.add_sample([x, y], &l, &sample.lambda, sample.filter_weight);
                }
                Ok(())
            });
            control.count(&stats);
            done.map(|()| stats)
        };
        tiles.into_par_iter().map(tile).try_reduce(RayStats::default, |mut sum, stats| {
            sum += stats;
            Ok(sum)
        })
    }

    /// Sets the sampler to a pixel's sample and takes what the camera needs of it.
    pub fn begin(&self, moment: Option<&Moment>, pixel: [i32; 2], sampler: &mut Sampler) -> PixelSample {
        sampler.start_pixel_sample(pixel, self.index, 0);
        let wavelength = sampler.get_1d();
        let place = self.filter.sample(sampler.get_pixel_2d());
        let (time, lens) = (sampler.get_1d(), sampler.get_2d());
        let moment = moment.copied().unwrap_or_else(|| Moment::new(self.scene, wavelength, time));
        let center = Vec2::new(pixel[0] as f32 + 0.5, pixel[1] as f32 + 0.5);
        let (film, lens, filter_weight) = if self.scene.options().disable_pixel_jitter {
            (center, Vec2::splat(0.5), 1.0)
        } else {
            (center + place.offset, lens, place.weight)
        };
        let sample = CameraSample { film, lens, time: moment.shutter, filter_weight };
        let camera_ray = camera_ray(self.scene, &sample, sampler.samples_per_pixel());
        let time = moment.time(self.scene);
        PixelSample { pixel, lambda: moment.lambda, time, camera_ray, filter_weight }
    }
}

/// The ray that the camera sees along, with its neighbours where something in the scene asks for
/// them; `None` where it sees nothing.
pub(crate) fn camera_ray(
    scene: &Scene,
    sample: &CameraSample,
    samples_per_pixel: u32,
) -> Option<CameraRayDifferential> {
    let camera = scene.camera();
    let camera_ray = if scene.has_footprints() {
        camera.generate_ray_differential(sample)
    } else {
        camera.generate_ray(sample).map(|r| CameraRayDifferential { ray: r.ray.into(), weight: r.weight })
    };
    camera_ray.map(|mut camera_ray| {
        camera_ray.ray.scale(differential_scale(samples_per_pixel));
        camera_ray
    })
}
