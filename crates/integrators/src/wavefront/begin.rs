//! The start of paths at the camera.

use lanes::{Each, Int, Kernel, MAX_LANES, Real};
use math::Vec2;
use sampling::sampler::Address;
use scene::camera::{CameraSample, differential_scale};

use super::numbers::CameraNumbers;
use super::pass::Pass;
use super::paths::Paths;
use crate::transport::shutter_sample::ShutterSample;

/// Gives the paths, which have pixels, their wavelengths, weights and camera rays.
pub(super) struct Begin<'a, 'b> {
    pub pass: Pass<'a>,
    pub paths: &'b mut Paths,
    pub with_differentials: bool,
}

impl Kernel for Begin<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(mut self) {
        for first in (0..self.paths.len()).step_by(R::LANES) {
            self.begin::<R>(first);
        }
    }
}

impl Begin<'_, '_> {
    /// Begins with the paths of some successive rows.
    #[inline(always)]
    fn begin<R: Real>(&mut self, first: usize) {
        let pixels = self.pass.pixels;
        let [x, y] = &self.paths.pixel;
        let pixel = [R::Int::load(&x[first..]), R::Int::load(&y[first..])];
        let mut address = Address { pixel, index: pixels.index, dimension: R::Int::splat(0) };
        let numbers = CameraNumbers::<R>::draw(&self.pass, &mut address);
        let lambda = ShutterSample::wavelengths(pixels.view, numbers.wavelength);
        let time = ShutterSample::shutter(pixels.view, numbers.time);
        let sample = pixels.camera_sample(pixel, numbers.place, time, numbers.lens);
        let paths = &mut *self.paths;
        address.dimension.store(&mut paths.dimension[first..]);
        sample.filter_weight.store(&mut paths.filter_weight[first..]);
        let ([a, b, c, d], [p, q, r, s]) = (*lambda.lambda(), lambda.pdf().0);
        paths.wavelengths.store(first, [a, b, c, d, p, q, r, s]);
        let ray = pixels.view.camera.ray(&sample);
        ray.time.store(&mut paths.time[first..]);
        paths.origin.store(first, ray.o.to_array());
        paths.direction.store(first, ray.d.to_array());
        if self.with_differentials {
            self.add_differentials(first, R::LANES, &Samples::new(&sample));
        }
    }

    /// The differentials of rays, one by one.
    #[inline(never)]
    fn add_differentials(&mut self, first: usize, lanes: usize, samples: &Samples) {
        let view = self.pass.pixels.view;
        for (row, lane) in (first..self.paths.len()).zip(0..lanes) {
            let mut ray = view.camera.ray_differential(&samples.lane(lane));
            ray.scale(differential_scale(view.samples_per_pixel));
            self.paths.differentials[row] = ray.differentials;
        }
    }
}

/// Camera samples in arrays.
struct Samples {
    film: [[f32; MAX_LANES]; 2],
    lens: [[f32; MAX_LANES]; 2],
    time: [f32; MAX_LANES],
    filter_weight: [f32; MAX_LANES],
}

impl Samples {
    #[inline(always)]
    fn new<R: Real>(sample: &CameraSample<R>) -> Self {
        Self {
            film: sample.film.to_array().each(R::to_array),
            lens: sample.lens.to_array().each(R::to_array),
            time: sample.time.to_array(),
            filter_weight: sample.filter_weight.to_array(),
        }
    }

    fn lane(&self, lane: usize) -> CameraSample {
        let pair = |[x, y]: &[[f32; MAX_LANES]; 2]| Vec2::new(x[lane], y[lane]);
        CameraSample {
            film: pair(&self.film),
            lens: pair(&self.lens),
            time: self.time[lane],
            filter_weight: self.filter_weight[lane],
        }
    }
}
