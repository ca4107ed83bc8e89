//! Daylight of a correlated colour temperature: the CIE D series.
//!
//! S(λ) = S₀(λ) + M₁ S₁(λ) + M₂ S₂(λ), where M₁ and M₂ follow from the chromaticity (x, y) on the
//! daylight locus y = −3x² + 2.87x − 0.275, and x from the temperature [CIE 015:2018 §4.1.2].

use crate::blackbody::blackbody;
use crate::cie::CIE_Y_INTEGRAL;
use crate::dense::DenselySampled;
use crate::piecewise::PiecewiseLinear;
use crate::spectrum::Spectrum;

/// Daylight of `temperature` kelvin, with about 1 at 560 nm.
///
/// The temperature is on the scale of 1968 (D65 is 6500 K), corrected by 1.4388 / 1.4380. Below
/// 4000 K, where daylight is undefined, it is a blackbody of unit luminance.
pub fn daylight(temperature: f32) -> Spectrum {
    let cct = temperature * 1.4388 / 1.4380;
    if cct < 4000.0 {
        let body = DenselySampled::from_fn(|lambda| blackbody(lambda, cct));
        let luminance = Spectrum::from(body.clone()).to_photometric() / CIE_Y_INTEGRAL;
        return if luminance > 0.0 { body.scaled(1.0 / luminance).into() } else { Spectrum::ZERO };
    }
    let [x, y] = chromaticity(f64::from(cct));
    let m = 0.0241 + 0.2562 * x - 0.7341 * y;
    let m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / m;
    let m2 = (0.0300 - 31.4424 * x + 30.0717 * y) / m;
    let pairs: Vec<(f32, f32)> = include_str!("../data/daylight.txt")
        .lines()
        .filter_map(row)
        .map(|[lambda, s0, s1, s2]| (lambda as f32, (0.01 * (s0 + m1 * s1 + m2 * s2)) as f32))
        .collect();
    PiecewiseLinear::from_pairs(&pairs).expect("invariant: the table is well formed").to_dense().into()
}

/// The chromaticity of daylight of `cct` kelvin.
fn chromaticity(cct: f64) -> [f64; 2] {
    let polynomial = |[a, b, c, d]: [f64; 4]| ((a / cct + b) / cct + c) / cct + d;
    let x = if cct <= 7000.0 {
        polynomial([-4.6070e9, 2.9678e6, 0.09911e3, 0.244063])
    } else {
        polynomial([-2.0064e9, 1.9018e6, 0.24748e3, 0.237040])
    };
    [x, (-3.0 * x + 2.870) * x - 0.275]
}

/// The four numbers of a line of the table, `None` for a comment.
fn row(line: &str) -> Option<[f64; 4]> {
    let numbers: Result<Vec<f64>, _> = line.split_whitespace().map(str::parse).collect();
    numbers.ok()?.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::named;

    #[test]
    fn daylight_of_6500_kelvin_is_d65() {
        let [x, y] = daylight(6500.0).to_xyz().xy();
        assert!((x - 0.3127).abs() < 3e-4 && (y - 0.3290).abs() < 3e-4, "{x} {y}");
        let d65 = named("stdillum-D65").unwrap();
        for lambda in [400.0, 500.0, 600.0, 700.0] {
            let ratio =
                (daylight(6500.0).at(lambda) / daylight(6500.0).at(560.0)) / (d65.at(lambda) / d65.at(560.0));
            assert!((ratio - 1.0).abs() < 5e-3, "{lambda}: {ratio}");
        }
    }

    #[test]
    fn hotter_daylight_is_bluer_and_cool_bodies_have_unit_luminance() {
        let xs = [3000.0, 5000.0, 6999.0, 7010.0, 10_000.0].map(|t| daylight(t).to_xyz().xy()[0]);
        assert!(xs.windows(2).all(|w| w[0] > w[1]), "{xs:?}");
        assert!((daylight(3000.0).to_xyz().y - 1.0).abs() < 1e-5);
        assert_eq!(daylight(0.0), Spectrum::ZERO);
    }
}
