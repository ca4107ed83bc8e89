//! Pixel sensors: from light at sampled wavelengths to three numbers, and from those to XYZ.
//!
//! A sensor's response is c = g ∫ L(λ) c̄(λ) dλ for each of its three sensitivities c̄, with the
//! imaging ratio g = exposure time · ISO / 100 [Pharr 2023 §5.4.2]. There is no division by ∫ ȳ:
//! lights are scaled so that one of unit strength has ∫ L ȳ dλ = 1, and thus gives the response 1
//! at g = 1.
//!
//! White balance of the ideal sensor maps the chromaticity of the illuminant to the white point of
//! the film's colour space, by a von Kries transform in the Bradford cone space.
//!
//! The responses of a measured camera have no exact XYZ. Its matrix is fitted by least squares to
//! the 24 patches of a calibration chart: what the camera sees under the light for which it is
//! balanced becomes what an observer sees under the white of the film's colour space. That the
//! camera's green gives the luminance of that light fixes the scale. [Pharr 2023 §5.4.2]

use lanes::{Each, Real};
use spectrum::{
    CIE_Y_INTEGRAL, DenselySampled, Matrix3, RgbColorSpace, SampledSpectrum, SampledWavelengths, Spectrum,
    cie, color_checker, daylight, named, responses, tristimulus, white_balance,
};

/// The ideal sensor.
const IDEAL: &str = "cie1931";

/// The white balance of cameras without one, in kelvin.
const CAMERA_WHITE: f32 = 6500.0;

/// A sensor: an ideal one, whose sensitivities are the CIE 1931 colour matching functions, or a
/// measured camera.
#[derive(Clone, Debug)]
pub struct PixelSensor {
    name: String,
    /// The sensitivities of a camera.
    curves: Option<[DenselySampled; 3]>,
    scale: f32,
    xyz_from_sensor_rgb: Matrix3,
}

impl PixelSensor {
    /// The sensor of this name; `None` if there is none. `white_temperature` is the correlated
    /// colour temperature in kelvin of the daylight that becomes white in `color_space`; `None`
    /// means no white balance for the ideal sensor, and 6500 K for others.
    pub fn new(
        name: &str,
        color_space: &RgbColorSpace,
        white_temperature: Option<f32>,
        imaging_ratio: f32,
    ) -> Option<Self> {
        let curves = curves(name)?;
        let (scale, matrix) = match &curves {
            None => {
                let balance = |kelvin| white_balance(daylight(kelvin).to_xyz().xy(), color_space.white());
                (imaging_ratio * CIE_Y_INTEGRAL, white_temperature.map_or(Matrix3::IDENTITY, balance))
            }
            Some(curves) => {
                let light = daylight(white_temperature.unwrap_or(CAMERA_WHITE));
                (imaging_ratio, fitted(curves, &light, &color_space.illuminant())?)
            }
        };
        Some(Self { name: name.to_owned(), curves, scale, xyz_from_sensor_rgb: matrix })
    }

    /// A sensor of these parts; `None` if there is none of that name.
    pub(crate) fn of_parts(name: &str, scale: f32, xyz_from_sensor_rgb: Matrix3) -> Option<Self> {
        Some(Self { name: name.to_owned(), curves: curves(name)?, scale, xyz_from_sensor_rgb })
    }

    /// Its name.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// The factor from light that is seen, by XYZ or the camera's sensitivities, to responses.
    pub(crate) fn scale(&self) -> f32 {
        self.scale
    }

    /// The three responses to light at `lambda`: an unbiased estimate.
    #[inline(always)]
    pub fn response<R: Real>(&self, light: &SampledSpectrum<R>, lambda: &SampledWavelengths<R>) -> [R; 3] {
        let scale = R::splat(self.scale);
        let seen = match &self.curves {
            None => tristimulus(light, lambda),
            Some([r, g, b]) => responses([r, g, b], light, lambda),
        };
        seen.each(|x| x * scale)
    }

    /// The matrix from responses to XYZ, white balance included.
    pub fn xyz_from_sensor_rgb(&self) -> Matrix3 {
        self.xyz_from_sensor_rgb
    }
}

/// The sensitivities of the sensor of this name, if there is one; `Some(None)` is the ideal one.
fn curves(name: &str) -> Option<Option<[DenselySampled; 3]>> {
    if name == IDEAL {
        return Some(None);
    }
    let curve = |channel| {
        let curve = named(&format!("{name}_{channel}"))?;
        Some(DenselySampled::from_fn(|lambda| curve.at(lambda)))
    };
    Some(Some([curve("r")?, curve("g")?, curve("b")?]))
}

/// The matrix from a camera's responses to XYZ that fits the chart best, where the camera sees it
/// under one light and the observer under another; `None` if the responses are not independent.
fn fitted(camera: &[DenselySampled; 3], light: &Spectrum, white: &Spectrum) -> Option<Matrix3> {
    let observer = cie::matching_functions();
    let observer = [&observer.x, &observer.y, &observer.z];
    let inner = |light: &Spectrum, f: &dyn Fn(f32) -> f32| -> f64 {
        let at = |lambda: u16| f64::from(light.at(f32::from(lambda))) * f64::from(f(f32::from(lambda)));
        (360..=830).map(at).sum()
    };
    let [green, luminance] = [&camera[1], observer[1]].map(|f| inner(light, &|lambda| f.at(lambda)));
    // Sums over the patches of the products of responses, of which those of `xyz` are wanted.
    let (mut squares, mut products) = ([[0.0; 3]; 3], [[0.0; 3]; 3]);
    let (seen, wanted) = (green, inner(white, &|lambda| observer[1].at(lambda)) * green / luminance);
    for patch in color_checker() {
        let reflected = |light, f: &DenselySampled| inner(light, &|lambda| patch.at(lambda) * f.at(lambda));
        let rgb = [0, 1, 2].map(|c: usize| reflected(light, &camera[c]) / seen);
        let xyz = observer.map(|f| reflected(white, f) / wanted);
        for i in 0..3 {
            for j in 0..3 {
                squares[i][j] += rgb[i] * rgb[j];
                products[i][j] += xyz[i] * rgb[j];
            }
        }
    }
    Some(Matrix3(products) * Matrix3(squares).inverse()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean response to a spectrum over stratified wavelengths.
    fn response(sensor: &PixelSensor, light: &Spectrum) -> [f32; 3] {
        const STEPS: u32 = 1 << 12;
        let mut sum = [0.0_f64; 3];
        for i in 0..STEPS {
            let lambda = SampledWavelengths::sample_visible((i as f32 + 0.5) / STEPS as f32);
            let rgb = sensor.response(&light.sample(&lambda), &lambda);
            (0..3).for_each(|c| sum[c] += f64::from(rgb[c]) / f64::from(STEPS));
        }
        sum.map(|x| x as f32)
    }

    fn ideal(space: &RgbColorSpace, white: Option<f32>, imaging_ratio: f32) -> PixelSensor {
        PixelSensor::new(IDEAL, space, white, imaging_ratio).unwrap()
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
            let sensor = ideal(space, None, 1.0);
            assert_close(output(&sensor, space, &unit(space.illuminant())), [1.0; 3], 2e-3);
        }
    }

    #[test]
    fn the_imaging_ratio_is_a_factor() {
        let space = RgbColorSpace::srgb();
        let sensor = ideal(space, None, 0.25);
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
            let plain = output(&ideal(space, None, 1.0), space, &light);
            assert!((plain[0] - plain[2]).abs() > 0.05, "{name} is not white by itself: {plain:?}");
            let balanced = output(&ideal(space, Some(kelvin), 1.0), space, &light);
            assert_close(balanced, [1.0; 3], 0.005);
        }
    }

    #[test]
    fn a_camera_sees_nearly_the_colours_of_the_chart() {
        // The light for which the camera is balanced becomes the white of the colour space, and the
        // patches have their colours in that white, but for the error of the fit.
        let space = RgbColorSpace::srgb();
        for (camera, white, kelvin) in
            [("canon_eos_5d_mkiv", None, 6500.0), ("sony_ilce_9", Some(4500.0), 4500.0)]
        {
            let sensor = PixelSensor::new(camera, space, white, 1.0).unwrap();
            let light = unit(daylight(kelvin));
            assert_close(output(&sensor, space, &light), [1.0; 3], 0.03);
            let (mut error, white) = (0.0, space.illuminant());
            for patch in color_checker() {
                let under = |light: &Spectrum, lambda: f32| patch.at(lambda) * light.at(lambda);
                let pairs: Vec<_> = (360..=830).map(|l| (l as f32, under(&light, l as f32))).collect();
                let seen = output(&sensor, space, &Spectrum::from_pairs(&pairs).unwrap());
                let known = space.to_rgb(cie::integrate_xyz(|lambda| under(&white, lambda))).to_array();
                error += (0..3).map(|c| (seen[c] - known[c]).powi(2)).sum::<f32>() / 24.0;
            }
            assert!(error.sqrt() < 0.03, "{camera} {kelvin}: {}", error.sqrt());
        }
    }

    #[test]
    fn the_exposure_of_a_camera_is_a_factor_and_its_name_is_known() {
        let space = RgbColorSpace::srgb();
        let light = unit(Spectrum::blackbody(3000.0));
        let [one, four] = [1.0, 4.0]
            .map(|ratio| response(&PixelSensor::new("nikon_d810", space, None, ratio).unwrap(), &light));
        assert_eq!(one.map(|c| 4.0 * c), four);
        assert!(PixelSensor::new("nikon_d1", space, None, 1.0).is_none());
    }
}
