//! The sensor: the offsets of its three sensitivities, the largest response that a sample may
//! have, and the rows of the matrix from responses to the colours of the picture.

use film::{Film, FilmSettings, PixelSensor};
use spectrum::{DenselySampled, LAMBDA_MAX, LAMBDA_MIN, SampledSpectrum, SampledWavelengths};

use super::Flattener;

impl Flattener<'_> {
    /// The sensor of a film; its offset.
    pub fn sensor(&mut self, film: &Film) -> u32 {
        let FilmSettings { sensor, max_component_value, color_space, .. } = film.settings();
        let curves = [0, 1, 2].map(|channel| {
            let curve = DenselySampled::from_fn(|lambda| sensitivity(&sensor, channel, lambda));
            self.curve(&curve)
        });
        let matrix = color_space.rgb_from_xyz() * sensor.xyz_from_sensor_rgb();
        let at = self.slab.add(curves);
        self.slab.add_numbers([max_component_value]);
        self.slab.add_numbers(matrix.0.as_flattened().iter().map(|&x| x as f32));
        at
    }
}

/// The response of a channel to unit light of one wavelength, per nanometre.
fn sensitivity(sensor: &PixelSensor, channel: usize, lambda: f32) -> f32 {
    let range = LAMBDA_MAX - LAMBDA_MIN;
    let lambda = SampledWavelengths::sample_uniform((lambda - LAMBDA_MIN) / range);
    let alone = SampledSpectrum::new([1.0, 0.0, 0.0, 0.0]);
    // One of four wavelengths has light, each with the density 1 / range.
    sensor.response(&alone, &lambda)[channel] * 4.0 / range
}
