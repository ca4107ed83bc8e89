//! The start of paths at the camera.

use lanes::{Int, Kernel, Real};
use sampling::sampler::Address;
use scene::ShutterSample;
use scene::camera::differential_scale;

use super::numbers::{CameraNumbers, draw_1d};
use super::pass::Pass;
use super::path_columns::PathColumns;
use super::segment_columns::{OptionalColumns, SegmentColumns, numbers_of};

/// Gives the paths, which have pixels, their wavelengths, weights and camera rays.
pub(super) struct Begin<'a, 'b> {
    pub pass: Pass<'a>,
    pub paths: &'b mut PathColumns,
    pub segments: &'b mut SegmentColumns,
    pub optional: OptionalColumns,
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
        let pixel = self.paths.pixels(first);
        let mut address = Address { pixel, index: pixels.index, dimension: R::Int::splat(0) };
        let numbers = CameraNumbers::<R>::draw(&self.pass, &mut address);
        let lambda = ShutterSample::wavelengths(pixels.view, numbers.wavelength);
        let time = ShutterSample::shutter(pixels.view, numbers.time);
        let sample = pixels.camera_sample(pixel, numbers.place, time, numbers.lens);
        let (paths, segments) = (&mut *self.paths, &mut *self.segments);
        if self.optional.media {
            paths.choose_heroes(first, draw_1d::<R>(&self.pass, &mut address));
        }
        address.dimension.store(&mut paths.dimension[first..]);
        sample.filter_weight.store(&mut paths.filter_weight[first..]);
        paths.set_wavelengths(first, &lambda);
        let camera = &pixels.view.camera;
        let (ray, weight) = if self.optional.differentials {
            let (ray, mut differentials, weight) = camera.ray_and_neighbours(&sample);
            differentials.scale(&ray, R::splat(differential_scale(pixels.view.samples_per_pixel)));
            segments.differentials.store(first, numbers_of(&differentials));
            R::Int::splat(1).store(&mut segments.are_differentials[first..]);
            (ray, weight)
        } else {
            camera.ray(&sample)
        };
        if !paths.camera_weight.is_empty() {
            weight.store(&mut paths.camera_weight[first..]);
        }
        ray.time.store(&mut segments.time[first..]);
        segments.origin.store(first, ray.o.to_array());
        segments.direction.store(first, ray.d.to_array());
    }
}
