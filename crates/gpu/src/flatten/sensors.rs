//! The sensor: the rows of the matrix from responses to the colours of the picture, of which the
//! first has the largest response that a sample may have as its fourth word, and the sensitivities
//! of its three channels at each nanometre from 360 on; four words for each row and nanometre.

use film::{Film, FilmSettings, PixelSensor};
use spectrum::{DenselySampled, LAMBDA_MAX, LAMBDA_MIN, SampledSpectrum, SampledWavelengths};

use super::Flattener;
use super::slab::padded;

impl Flattener<'_> {
    /// The sensor of a film; its offset.
    pub fn sensor(&mut self, film: &Film) -> u32 {
        // The CPU keeps what else a film has.
        let FilmSettings {
            sensor,
            max_component_value,
            color_space,
            full_resolution: _,
            pixel_bounds: _,
            diagonal: _,
            filter: _,
            half_floats: _,
            layers: _,
            buckets: _,
            gbuffer: _,
            light_groups: _,
        } = film.settings();
        let curves =
            [0, 1, 2].map(|channel| DenselySampled::from_fn(|lambda| sensitivity(&sensor, channel, lambda)));
        let matrix = color_space.rgb_from_xyz() * sensor.xyz_from_sensor_rgb();
        let mut rows = padded(matrix.0.map(|row| row.map(|x| x as f32)));
        rows[3] = max_component_value;
        let [red, green, blue] = curves.each_ref().map(|curve| curve.values());
        let responses = red.iter().zip(green).zip(blue).map(|((&r, &g), &b)| [r, g, b]);
        rows.extend(padded(responses));
        self.slab.add_numbers(rows)
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
