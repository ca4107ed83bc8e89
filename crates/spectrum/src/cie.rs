//! The CIE 1931 standard observer: from spectra to tristimulus values.
//!
//! X = ∫ L(λ) x̄(λ) dλ / ∫ ȳ(λ) dλ, likewise Y and Z, with the integral taken as the sum over whole
//! nanometres from 360 to 830. For light known at sampled wavelengths the same is estimated by 1/N
//! Σ L(λᵢ) x̄(λᵢ) / p(λᵢ) [Pharr 2023 §4.6.1].

use lanes::Real;
use std::sync::LazyLock;

use crate::dense::{COUNT, DenselySampled};
use crate::rgb::Xyz;
use crate::sampled::SampledSpectrum;
use crate::wavelengths::{LAMBDA_MIN, SampledWavelengths};

/// ∫ ȳ(λ) dλ in nanometres.
pub const CIE_Y_INTEGRAL: f32 = 106.856_895;

/// The matching functions x̄, ȳ, z̄.
pub struct MatchingFunctions {
    /// x̄(λ).
    pub x: DenselySampled,
    /// ȳ(λ), the photopic luminous efficiency.
    pub y: DenselySampled,
    /// z̄(λ).
    pub z: DenselySampled,
}

/// The matching functions of the CIE 1931 2° standard observer.
pub fn matching_functions() -> &'static MatchingFunctions {
    static FUNCTIONS: LazyLock<MatchingFunctions> = LazyLock::new(|| {
        let rows: Vec<[f32; 3]> = include_str!("../data/cie_1931.txt").lines().filter_map(row).collect();
        assert_eq!(rows.len(), COUNT, "invariant: a row for each nanometre");
        let column = |j: usize| DenselySampled::from_fn(|lambda| rows[(lambda - LAMBDA_MIN) as usize][j]);
        MatchingFunctions { x: column(0), y: column(1), z: column(2) }
    });
    &FUNCTIONS
}

/// x̄, ȳ, z̄ of a line of the table, `None` for a comment.
fn row(line: &str) -> Option<[f32; 3]> {
    let mut numbers = line.split_whitespace().skip(1).map(str::parse);
    match (numbers.next()?, numbers.next()?, numbers.next()?) {
        (Ok(x), Ok(y), Ok(z)) => Some([x, y, z]),
        _ => None,
    }
}

/// The sum of `f` over the whole nanometres of the range: ∫ f dλ.
pub(crate) fn integrate(f: impl Fn(f32) -> f32) -> f32 {
    (0..COUNT).map(|i| f64::from(f(LAMBDA_MIN + i as f32))).sum::<f64>() as f32
}

/// The colour of light with the spectrum `f`.
pub fn integrate_xyz(f: impl Fn(f32) -> f32) -> Xyz {
    let functions = matching_functions();
    let component = |g: &DenselySampled| integrate(|lambda| f(lambda) * g.at(lambda)) / CIE_Y_INTEGRAL;
    Xyz::new(component(&functions.x), component(&functions.y), component(&functions.z))
}

/// The colour of light sampled at `lambda`: an unbiased estimate.
pub fn xyz_from(light: &SampledSpectrum, lambda: &SampledWavelengths) -> Xyz {
    tristimulus(light, lambda).into()
}

/// X, Y and Z of light sampled at `lambda`: unbiased estimates.
#[inline(always)]
pub fn tristimulus<R: Real>(light: &SampledSpectrum<R>, lambda: &SampledWavelengths<R>) -> [R; 3] {
    let MatchingFunctions { x, y, z } = matching_functions();
    let weighted = light.safe_div(lambda.pdf());
    [integral(x, lambda, weighted), integral(y, lambda, weighted), integral(z, lambda, weighted)]
}

/// ∫ L f dλ in nanometres for each of three functions f and light sampled at `lambda`: unbiased
/// estimates.
#[inline(always)]
pub fn responses<R: Real>(
    functions: [&DenselySampled; 3],
    light: &SampledSpectrum<R>,
    lambda: &SampledWavelengths<R>,
) -> [R; 3] {
    let weighted = light.safe_div(lambda.pdf());
    let [a, b, c] = functions;
    [inner(a, lambda, weighted), inner(b, lambda, weighted), inner(c, lambda, weighted)]
}

/// The luminance of light sampled at `lambda`: an unbiased estimate.
pub fn y_from(light: &SampledSpectrum, lambda: &SampledWavelengths) -> f32 {
    integral(&matching_functions().y, lambda, light.safe_div(lambda.pdf()))
}

/// ∫ L f dλ / ∫ ȳ dλ for a matching function f and light divided by its densities.
#[inline(always)]
fn integral<R: Real>(
    function: &DenselySampled,
    lambda: &SampledWavelengths<R>,
    weighted: SampledSpectrum<R>,
) -> R {
    inner(function, lambda, weighted) / R::splat(CIE_Y_INTEGRAL)
}

/// ∫ L f dλ for a function f and light divided by its densities.
#[inline(always)]
fn inner<R: Real>(
    function: &DenselySampled,
    lambda: &SampledWavelengths<R>,
    weighted: SampledSpectrum<R>,
) -> R {
    let mut values = *lambda.lambda();
    for value in &mut values {
        *value = function.at(*value);
    }
    (SampledSpectrum(values) * weighted).average()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_luminosity_function_peaks_at_555_nm_and_has_the_known_integral() {
        let functions = matching_functions();
        assert_eq!(functions.y.at(555.0), 1.0);
        assert_eq!(functions.y.max_value(), 1.0);
        let sum: f64 = functions.y.values().iter().map(|&v| f64::from(v)).sum();
        assert!((sum / f64::from(CIE_Y_INTEGRAL) - 1.0).abs() < 1e-6, "{sum}");
    }

    #[test]
    fn equal_energy_light_is_nearly_white() {
        let functions = matching_functions();
        for f in [&functions.x, &functions.z] {
            assert!((f.values().iter().sum::<f32>() / CIE_Y_INTEGRAL - 1.0).abs() < 1e-3);
        }
    }

    #[test]
    fn estimates_from_sampled_wavelengths_have_the_right_mean() {
        // Stratified u: the mean over them is the integral of the estimator by the midpoint rule.
        const STEPS: u32 = 1 << 14;
        let light = |lambda: f32| 1.0 + (lambda / 40.0).sin();
        let functions = matching_functions();
        let exact = |f: &DenselySampled| {
            (0..COUNT).map(|i| f.values()[i] * light(LAMBDA_MIN + i as f32)).sum::<f32>() / CIE_Y_INTEGRAL
        };
        for sample in [SampledWavelengths::sample_uniform, SampledWavelengths::sample_visible] {
            let mut mean = Xyz::ZERO;
            let mut mean_y = 0.0;
            for i in 0..STEPS {
                let mut lambda = sample((i as f32 + 0.5) / STEPS as f32);
                if i % 2 == 0 {
                    lambda.terminate_secondary();
                }
                let sampled = SampledSpectrum::new(lambda.lambda().map(light));
                mean += xyz_from(&sampled, &lambda) / STEPS as f32;
                mean_y += y_from(&sampled, &lambda) / STEPS as f32;
            }
            assert!((mean.x - exact(&functions.x)).abs() < 2e-3);
            assert!((mean.y - exact(&functions.y)).abs() < 2e-3);
            assert!((mean.z - exact(&functions.z)).abs() < 2e-3);
            assert!((mean_y - mean.y).abs() < 1e-5);
        }
    }
}
