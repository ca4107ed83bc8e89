//! The start of paths at the camera.

use lanes::{Each, Int, Kernel, Real};
use math::Vec2;
use sampling::sampler::Address;
use spectrum::SampledWavelengths;

use super::paths::Paths;
use crate::transport::pixel_samples::PixelSamples;
use crate::transport::shutter_sample::ShutterSample;

/// The dimensions that camera samples take.
const DIMENSIONS: u32 = 6;

/// Starts a path for each pixel: its random numbers and wavelengths in lanes, its ray by itself.
pub(super) struct Begin<'a, 'b> {
    pub pixels: &'a PixelSamples<'a>,
    /// The index of the tile in the batch, and its pixels.
    pub tile: u32,
    pub positions: &'a [[i32; 2]],
    pub paths: &'b mut Paths,
    /// Gets the paths that have a ray.
    pub active: &'b mut Vec<u32>,
    pub with_differentials: bool,
}

impl Kernel for Begin<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(mut self) {
        for positions in self.positions.chunks(R::LANES) {
            self.begin::<R>(positions);
        }
    }
}

impl Begin<'_, '_> {
    #[inline(always)]
    fn begin<R: Real>(&mut self, positions: &[[i32; 2]]) {
        let PixelSamples { index, view, sampler, .. } = *self.pixels;
        let position = |lane: usize, axis: usize| positions[lane.min(positions.len() - 1)][axis] as u32;
        let pixel = [R::Int::from_fn(|lane| position(lane, 0)), R::Int::from_fn(|lane| position(lane, 1))];
        let mut address = Address { pixel, index, dimension: R::Int::splat(0) };
        let lambda = ShutterSample::wavelengths(view, sampler.at_1d::<R>(&address));
        address.skip(1);
        let place = sampler.at_pixel_2d::<R>(&address);
        address.skip(2);
        let shutter = sampler.at_1d::<R>(&address);
        address.skip(1);
        let lens = sampler.at_2d::<R>(&address);
        let (place, lens) = (place.each(R::to_array), lens.each(R::to_array));
        let (values, pdf) = (lambda.lambda().each(R::to_array), lambda.pdf().0.each(R::to_array));
        let shutter = shutter.to_array();
        for (lane, &pixel) in positions.iter().enumerate() {
            let lambda = SampledWavelengths::new(values.each(|v| v[lane]), pdf.each(|p| p[lane]));
            let u = if view.options.disable_pixel_jitter { 0.5 } else { shutter[lane] };
            let pair = |[x, y]: &[[f32; lanes::MAX_LANES]; 2]| Vec2::new(x[lane], y[lane]);
            let sample = self.pixels.sample(&ShutterSample { lambda, u }, pixel, pair(&place), pair(&lens));
            if sample.camera_ray.is_some() {
                self.active.push(self.paths.len() as u32);
            }
            self.paths.push(self.tile, &sample, DIMENSIONS, self.with_differentials);
        }
    }
}
