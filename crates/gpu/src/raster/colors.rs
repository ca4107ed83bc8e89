//! Colours of spectra, for shaders that compute with red, green and blue.
//!
//! Light gets the colour that the film gives it. What scatters or absorbs light becomes the ratio
//! of the colours of the film's white after and before, so that grey stays grey. All is estimated
//! at the same few wavelengths, as ratios, whose errors are small where spectra are smooth.

use film::{Film, PixelSensor};
use math::Vec3;
use spectrum::{Matrix3, RgbColorSpace, SampledSpectrum, SampledWavelengths};

/// Sets of wavelengths.
const SETS: usize = 4;

/// Sets of wavelengths for the colour of white.
const EXACT_SETS: usize = 256;

/// From spectra to the colours of a film.
pub struct Colors {
    lambda: [SampledWavelengths; SETS],
    sensor: PixelSensor,
    rgb_from_sensor: Matrix3,
    space: &'static RgbColorSpace,
    /// The colour of the space's illuminant, and its estimate.
    white: [Vec3; 2],
}

impl Colors {
    /// Those of a film.
    pub fn new(film: &Film) -> Self {
        let (sensor, space) = (film.settings().sensor, film.color_space());
        let place =
            |i: usize, sets: usize| SampledWavelengths::sample_visible((i as f32 + 0.5) / sets as f32);
        let rgb_from_sensor = space.rgb_from_xyz() * sensor.xyz_from_sensor_rgb();
        let lambda = std::array::from_fn(|i| place(i, SETS));
        let mut colors = Self { lambda, sensor, rgb_from_sensor, space, white: [Vec3::ONE; 2] };
        let exact = (0..EXACT_SETS).map(|i| place(i, EXACT_SETS));
        let white = exact.map(|lambda| colors.seen(&colors.illuminant(&lambda), &lambda));
        let white = white.sum::<Vec3>() / EXACT_SETS as f32;
        colors.white = [white, colors.estimate(|lambda| colors.illuminant(lambda))];
        colors
    }

    /// The colour of light.
    pub fn light(&self, light: impl FnMut(&mut SampledWavelengths) -> SampledSpectrum) -> Vec3 {
        let [white, estimate] = self.white;
        (self.estimate(light) * white / estimate).max(Vec3::ZERO)
    }

    /// The factors on red, green and blue of a spectrum of factors, or of coefficients.
    pub fn factor(&self, mut factor: impl FnMut(&mut SampledWavelengths) -> SampledSpectrum) -> Vec3 {
        let after = self.estimate(|lambda| {
            let white = self.illuminant(lambda);
            factor(lambda) * white
        });
        (after / self.white[1]).max(Vec3::ZERO)
    }

    fn illuminant(&self, lambda: &SampledWavelengths) -> SampledSpectrum {
        SampledSpectrum::new(lambda.lambda().map(|lambda| self.space.illuminant_at(lambda)))
    }

    fn estimate(&self, mut light: impl FnMut(&mut SampledWavelengths) -> SampledSpectrum) -> Vec3 {
        let colors = self.lambda.iter().map(|lambda| {
            let light = light(&mut lambda.clone());
            self.seen(&light, lambda)
        });
        colors.sum::<Vec3>() / SETS as f32
    }

    fn seen(&self, light: &SampledSpectrum, lambda: &SampledWavelengths) -> Vec3 {
        Vec3::from_array(self.rgb_from_sensor.apply_f32(self.sensor.response(light, lambda)))
    }
}
