//! One sample of every pixel: camera rays, whose radiance is added to the film.
//!
//! Pass i takes sample i of every pixel. The dimensions of the sampler are used in a fixed order:
//! wavelengths (1), position in the pixel's filter (2), time (1), position on the lens (2), and
//! then those of the algorithm. [Pharr 2023 §1.3.4, §5.4.1]

use film::{FilmTile, Filter, FirstHit, Parts};
use geometry::RayStats;
use lanes::{Each, Int, Real};
use math::Vec2;
use rayon::prelude::*;
use sampling::Sampler;
use scene::camera::{CameraRayDifferential, CameraSample, differential_scale};
use scene::{Scene, ShutterSample, View};
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::Tracer;
use super::first_hit::first_hit;
use super::sample_counts::SampleCounts;
use crate::{Cancelled, Control};

/// One sample of each pixel that takes it.
#[derive(Clone, Copy)]
pub(crate) struct PixelSamples<'a> {
    /// The index of the sample.
    pub index: u32,
    pub scene: &'a Scene,
    pub view: &'a View,
    pub filter: &'a Filter,
    pub sampler: &'a Sampler,
    /// Where pixels take different numbers of samples, how many.
    pub counts: Option<&'a SampleCounts>,
}

/// A sample of a pixel.
pub(crate) struct PixelSample {
    pub pixel: [i32; 2],
    /// The wavelengths at which radiance is estimated.
    pub lambda: SampledWavelengths,
    /// The time, in the scene's units.
    pub time: f32,
    /// Where it is on film and lens.
    pub camera_sample: CameraSample,
    /// The camera ray; `None` if no light reaches that point of the film.
    pub camera_ray: Option<CameraRayDifferential>,
    /// Weight in the pixel.
    pub filter_weight: f32,
}

impl PixelSamples<'_> {
    /// Whether a pixel takes a sample.
    pub fn takes(&self, pixel: [i32; 2]) -> bool {
        self.counts.is_none_or(|counts| counts.takes(pixel, self.index))
    }

    /// Adds the estimates of `radiance` to each pixel of the tiles, at the wavelengths that it
    /// leaves in the sample. The tracer's sampler continues after the dimensions of the camera
    /// sample. After a cancellation the film has all finished samples, and no parts of others.
    pub fn add(
        &self,
        tiles: Vec<FilmTile>,
        control: &Control,
        radiance: impl Fn(&mut PixelSample, &mut Tracer) -> SampledSpectrum + Sync,
    ) -> Result<RayStats, Cancelled> {
        self.add_at(None, tiles, control, radiance)
    }

    /// The same; all samples share `shutter`, if there is one.
    pub fn add_at(
        &self,
        shutter: Option<&ShutterSample>,
        tiles: Vec<FilmTile>,
        control: &Control,
        radiance: impl Fn(&mut PixelSample, &mut Tracer) -> SampledSpectrum + Sync,
    ) -> Result<RayStats, Cancelled> {
        let tile = |mut tile: FilmTile| {
            let mut sampler = self.sampler.clone();
            let mut stats = RayStats::default();
            let (bounds, mut parts) = (tile.bounds(), tile.new_parts());
            let done = (bounds.min[1]..bounds.max[1]).try_for_each(|y| {
                control.check()?;
                for x in (bounds.min[0]..bounds.max[0]).filter(|&x| self.takes([x, y])) {
                    let mut sample = self.begin(shutter, [x, y], &mut sampler);
                    parts.iter_mut().for_each(Parts::clear);
                    let mut tracer = Tracer::new(self.scene, self.view, control, &mut sampler, &mut stats)
                        .with_parts(parts.as_mut());
                    let l = radiance(&mut sample, &mut tracer);
                    let first_hit = self.first_hit(&tile, &sample, &sample.lambda, &mut tracer);
                    tracer.finish()?;
                    let alpha = if first_hit.is_some() { 1.0 } else { 0.0 };
                    let radiance = film::Sample::new(&l, &sample.lambda, sample.filter_weight);
                    let parts = parts.as_ref();
                    tile.add([x, y], &film::Sample { alpha, first_hit, parts, ..radiance });
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

    /// The first hit of a sample, if an AOV of the film needs it. It comes after the estimate of
    /// radiance, so that its random numbers do not change the estimate.
    pub fn first_hit(
        &self,
        tile: &FilmTile,
        sample: &PixelSample,
        lambda: &SampledWavelengths,
        tracer: &mut Tracer,
    ) -> Option<FirstHit> {
        let camera_ray = sample.camera_ray.as_ref().filter(|_| tile.wants_first_hit())?;
        let neighbours = tile.wants_slopes().then(|| {
            let mut ray = self.view.camera.generate_ray_differential(&sample.camera_sample)?.ray;
            ray.scale(differential_scale(self.view.samples_per_pixel));
            ray.differentials
        });
        first_hit(tracer, &camera_ray.ray, neighbours.flatten().as_ref(), lambda)
    }

    /// Starts the sampler for a sample of a pixel and takes the dimensions of the camera.
    pub fn begin(
        &self,
        shutter: Option<&ShutterSample>,
        pixel: [i32; 2],
        sampler: &mut Sampler,
    ) -> PixelSample {
        sampler.start_pixel_sample(pixel, self.index, 0);
        let wavelength = sampler.get_1d();
        let place = sampler.get_pixel_2d();
        let (time, lens) = (sampler.get_1d(), sampler.get_2d());
        let shutter = shutter.copied().unwrap_or_else(|| ShutterSample::new(self.view, wavelength, time));
        self.sample(&shutter, pixel, place, lens)
    }

    /// The sample of a pixel at the point `place` of the filter, in [0, 1)², and `lens` of the
    /// lens.
    pub fn sample(&self, shutter: &ShutterSample, pixel: [i32; 2], place: Vec2, lens: Vec2) -> PixelSample {
        let sample = self.camera_sample(pixel.each(|x| x as u32), place, shutter.u, lens);
        let camera_ray = camera_ray(self.scene, self.view, &sample);
        PixelSample {
            pixel,
            lambda: shutter.lambda,
            time: shutter.time(self.view),
            camera_sample: sample,
            camera_ray,
            filter_weight: sample.filter_weight,
        }
    }

    /// The camera sample of a pixel at the point `place` of the filter and `lens` of the lens, in
    /// [0, 1)², unless the view's options fix them.
    #[inline(always)]
    pub fn camera_sample<R: Real>(
        &self,
        pixel: [R::Int; 2],
        place: Vec2<R>,
        time: R,
        lens: Vec2<R>,
    ) -> CameraSample<R> {
        let half = R::splat(0.5);
        let center = Vec2::from_array(pixel.each(R::Int::to_real)) + half;
        if self.view.options.disable_pixel_jitter {
            return CameraSample { film: center, lens: Vec2::splat(half), time, filter_weight: R::one() };
        }
        let place = self.filter.sample(place);
        CameraSample { film: center + place.offset, lens, time, filter_weight: place.weight }
    }
}

/// The camera ray of a sample, with differentials where something in the scene needs them; `None`
/// if no light reaches that point of the film.
pub(crate) fn camera_ray(scene: &Scene, view: &View, sample: &CameraSample) -> Option<CameraRayDifferential> {
    let camera = &view.camera;
    let camera_ray = if scene.needs_footprints(view) {
        camera.generate_ray_differential(sample)
    } else {
        camera.generate_ray(sample).map(|r| CameraRayDifferential { ray: r.ray.into(), weight: r.weight })
    };
    camera_ray.map(|mut camera_ray| {
        camera_ray.ray.scale(differential_scale(view.samples_per_pixel));
        camera_ray
    })
}
