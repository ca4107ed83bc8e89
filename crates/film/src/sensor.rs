//! Pixel sensors: from light at sampled wavelengths to three numbers, and from those to XYZ.
//!
//! A sensor's response is c = g ∫ L(λ) c̄(λ) dλ for each of its three sensitivities c̄, with the
//! imaging ratio g = exposure time · ISO / 100 [Pharr 2023 §5.4.2]. There is no division by ∫ ȳ:
//! lights are scaled so that one of unit strength has ∫ L ȳ dλ = 1, and thus gives the response 1
//! at g = 1.
//!
//! White balance maps the chromaticity of the illuminant to the white point of the film's colour
//! space, by a von Kries transform in the Bradford cone space.

use lanes::{Each, Real};
use spectrum::{
    CIE_Y_INTEGRAL, Matrix3, RgbColorSpace, SampledSpectrum, SampledWavelengths, daylight, tristimulus,
    white_balance,
};

/// A sensor whose sensitivities are the CIE 1931 colour matching functions.
#[derive(Clone, Debug)]
pub struct PixelSensor {
    scale: f32,
    xyz_from_sensor_rgb: Matrix3,
}

impl PixelSensor {
    /// The ideal XYZ sensor. `white_temperature` is the correlated colour temperature in kelvin of
    /// the daylight that becomes white in `color_space`; `None` means no white balance.
    pub fn cie1931(color_space: &RgbColorSpace, white_temperature: Option<f32>, imaging_ratio: f32) -> Self {
        let balance = |kelvin| white_balance(daylight(kelvin).to_xyz().xy(), color_space.white());
        Self {
            scale: imaging_ratio * CIE_Y_INTEGRAL,
            xyz_from_sensor_rgb: white_temperature.map_or(Matrix3::IDENTITY, balance),
        }
    }

    /// A sensor of these parts.
    pub(crate) fn new(scale: f32, xyz_from_sensor_rgb: Matrix3) -> Self {
        Self { scale, xyz_from_sensor_rgb }
    }

    /// The factor from XYZ of light to responses.
    pub(crate) fn scale(&self) -> f32 {
        self.scale
    }

    /// The three responses to light at `lambda`: an unbiased estimate.
    #[inline(always)]
    pub fn response<R: Real>(&self, light: &SampledSpectrum<R>, lambda: &SampledWavelengths<R>) -> [R; 3] {
        let scale = R::splat(self.scale);
        tristimulus(light, lambda).each(|x| x * scale)
    }

    /// The matrix from responses to XYZ, white balance included.
    pub fn xyz_from_sensor_rgb(&self) -> Matrix3 {
        self.xyz_from_sensor_rgb
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spectrum::Spectrum;

    /// The mean response to a spectrum over stratified wavelengths.
    fn response(sensor: &PixelSensor, light: &Spectrum) -> [f32; 3] {
        const STEPS: u32 = 1 << 14;
        let mut sum = [0.0_f64; 3];
        for i in 0..STEPS {
            let lambda = SampledWavelengths::sample_visible((i as f32 + 0.5) / STEPS as f32);
            let rgb = sensor.response(&light.sample(&lambda), &lambda);
            (0..3).for_each(|c| sum[c] += f64::from(rgb[c]) / f64::from(STEPS));
        }
        sum.map(|x| x as f32)
    }

    fn output(sensor: &PixelSensor, space: &RgbColorSpace, light: &Spectrum) -> [f32; 3] {
        (space.rgb_from_xyz() * sensor.xyz_from_sensor_rgb()).apply_f32(response(sensor, light))
    }

    fn assert_close(a: [f32; 3], b: [f32; 3], tolerance: f32) {
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() <= tolerance), "{a:?} is not {b:?}");
    }

    /// Light of unit strength, as lights of a scene have it.
    fn unit(light: Spectrum) -> Spectrum {
        let scale = 1.0 / light.to_photometric();
        let values: Vec<_> = (360..=830).map(|l| (l as f32, light.at(l as f32) * scale)).collect();
        Spectrum::from_pairs(&values).unwrap()
    }

    #[test]
    fn the_white_of_each_colour_space_is_one_in_it() {
        for space in RgbColorSpace::all() {
            let sensor = PixelSensor::cie1931(space, None, 1.0);
            assert_close(output(&sensor, space, &unit(space.illuminant())), [1.0; 3], 2e-3);
        }
    }

    #[test]
    fn the_imaging_ratio_is_a_factor() {
        let space = RgbColorSpace::srgb();
        let sensor = PixelSensor::cie1931(space, None, 0.25);
        assert_close(output(&sensor, space, &unit(space.illuminant())), [0.25; 3], 5e-4);
    }

    #[test]
    fn white_balance_makes_the_named_light_white() {
        // Illuminant A is a black body of 2855 K on the scale of temperatures on which D65 is
        // daylight of 6500 K.
        let lights = [
            ("stdillum-D65", 6500.0, RgbColorSpace::aces2065_1()),
            ("stdillum-A", 2855.0, RgbColorSpace::srgb()),
        ];
        for (name, kelvin, space) in lights {
            let light = unit(spectrum::named(name).unwrap());
            let plain = output(&PixelSensor::cie1931(space, None, 1.0), space, &light);
            assert!((plain[0] - plain[2]).abs() > 0.05, "{name} is not white by itself: {plain:?}");
            let balanced = output(&PixelSensor::cie1931(space, Some(kelvin), 1.0), space, &light);
            assert_close(balanced, [1.0; 3], 0.005);
        }
    }
}
