//! The radiance of a blackbody, by Planck's law.
//!
//! L(λ, T) = 2hc² / (λ⁵ (e^{hc / (λ k T)} − 1)), in W / (m² sr m) with λ in metres
//! [Pharr 2023 §4.4.1].

/// Speed of light in vacuum, m/s.
const C: f64 = 299_792_458.0;
/// Planck's constant, J s.
const H: f64 = 6.626_069_57e-34;
/// Boltzmann's constant, J/K.
const K_B: f64 = 1.380_648_8e-23;
/// Wien's displacement constant, m K.
const WIEN: f64 = 2.897_772_1e-3;

/// Radiance of a blackbody of `temperature` kelvin at `lambda` nanometres, per metre of wavelength;
/// zero at 0 K.
pub fn blackbody(lambda: f32, temperature: f32) -> f32 {
    if temperature <= 0.0 {
        return 0.0;
    }
    planck(f64::from(lambda) * 1e-9, f64::from(temperature)) as f32
}

/// Planck's law for a wavelength in metres.
fn planck(lambda: f64, temperature: f64) -> f64 {
    2.0 * H * C * C / (lambda.powi(5) * libm::expm1(H * C / (lambda * K_B * temperature)))
}

/// A blackbody's spectrum, scaled so that its largest value over all wavelengths is one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blackbody {
    temperature: f64,
    normalization: f64,
}

impl Blackbody {
    /// The normalized spectrum of a body of `temperature` kelvin; black at 0 K.
    pub fn new(temperature: f32) -> Self {
        let temperature = f64::from(temperature);
        let normalization =
            if temperature > 0.0 { 1.0 / planck(WIEN / temperature, temperature) } else { 0.0 };
        Self { temperature, normalization }
    }

    /// The temperature in kelvin.
    pub fn temperature(&self) -> f32 {
        self.temperature as f32
    }

    /// The value at `lambda` nanometres.
    #[inline]
    pub fn at(&self, lambda: f32) -> f32 {
        if self.normalization == 0.0 {
            return 0.0;
        }
        (planck(f64::from(lambda) * 1e-9, self.temperature) * self.normalization) as f32
    }

    /// The largest value over all wavelengths.
    pub fn max_value(&self) -> f32 {
        if self.normalization == 0.0 { 0.0 } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radiance_equals_published_values() {
        for (lambda, temperature, radiance) in [
            (483.0, 6000.0, 3.1849e13),
            (600.0, 6000.0, 2.86772e13),
            (500.0, 3700.0, 1.59845e12),
            (600.0, 4500.0, 7.46497e12),
        ] {
            let ours = blackbody(lambda, temperature);
            assert!((ours / radiance - 1.0).abs() < 1e-3, "{ours} at {lambda} nm, {temperature} K");
        }
        assert_eq!(blackbody(500.0, 0.0), 0.0);
    }

    #[test]
    fn the_peak_is_one_at_wiens_wavelength() {
        for temperature in [4000.0_f32, 5000.0, 6500.0] {
            let spectrum = Blackbody::new(temperature);
            let peak = (WIEN * 1e9) as f32 / temperature;
            assert!((spectrum.at(peak) - 1.0).abs() < 1e-6);
            assert!(spectrum.at(peak * 0.99) < 1.0 && spectrum.at(peak * 1.01) < 1.0);
        }
    }

    #[test]
    fn zero_temperature_is_black() {
        assert_eq!(Blackbody::new(0.0).at(500.0), 0.0);
        assert_eq!(Blackbody::new(-3.0).max_value(), 0.0);
    }
}
