//! Wavelengths and time of a sample.

use lanes::Real;
use sampling::hash;
use spectrum::SampledWavelengths;

use crate::View;

/// The wavelengths and the time of a path.
#[derive(Clone, Copy, Debug)]
pub struct ShutterSample {
    /// The wavelengths.
    pub lambda: SampledWavelengths,
    /// Sample value in [0, 1) for the shutter time.
    pub u: f32,
}

impl ShutterSample {
    /// From two sample values in [0, 1), unless the view's options fix them.
    pub fn new(view: &View, wavelength: f32, shutter: f32) -> Self {
        Self { lambda: Self::wavelengths(view, wavelength), u: Self::shutter(view, shutter) }
    }

    /// The sample value of the shutter time, unless the view's options fix it.
    #[inline(always)]
    pub fn shutter<R: Real>(view: &View, u: R) -> R {
        if view.options.disable_pixel_jitter { R::splat(0.5) } else { u }
    }

    /// The wavelengths from a sample value in [0, 1), unless the view's options fix them.
    #[inline(always)]
    pub fn wavelengths<R: Real>(view: &View, u: R) -> SampledWavelengths<R> {
        match (view.options.disable_wavelength_jitter, view.wavelengths) {
            (false, None) => SampledWavelengths::sample_visible(u),
            (false, Some([min, max])) => SampledWavelengths::sample_uniform_in(u, min, max),
            (true, None) => SampledWavelengths::fixed_visible(),
            (true, Some([min, max])) => SampledWavelengths::fixed_uniform_in(min, max),
        }
    }

    /// The sample that all paths of a pass share. Over the passes both are stratified by an
    /// additive recurrence with an irrational step. For wavelengths the step is a quarter of the
    /// golden ratio, because a path has four of them, a quarter of the range apart.
    pub fn of_pass(view: &View, seed: u32, pass: u32) -> Self {
        // As fractions of 2³²: a quarter of the golden ratio, and √2 − 1.
        const STEPS: [u32; 2] = [0x678d_de6e, 0x6a09_e667];
        let [wavelength, shutter] = [0, 1].map(|i| {
            let start = hash(&[seed, i]) as u32;
            let bits = start.wrapping_add(pass.wrapping_mul(STEPS[i as usize]));
            (bits >> 8) as f32 / (1 << 24) as f32
        });
        Self::new(view, wavelength, shutter)
    }

    /// The time, in the scene's units.
    pub fn time(&self, view: &View) -> f32 {
        view.camera.sample_time(self.u)
    }
}
