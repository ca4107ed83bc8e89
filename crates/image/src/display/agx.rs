//! The base look of AgX [Sobotka 2022]: colours are drawn towards grey (inset), put on a scale of
//! stops, bent by a sigmoid, and drawn apart again.
//!
//! With v the position between 10 stops below and 6.5 stops above middle grey, and p that of middle
//! grey, the sigmoid is ½ + 2 (v − p) / (1 + (|v − p|/s)ⁿ)^(1/n): of slope 2 and value ½ at middle
//! grey. The powers n of toe and shoulder are 3 and 3.25, and s is such that the curve ends at 0
//! and 1. Its values are codes of the display.

use std::sync::LazyLock;

use spectrum::Matrix3;

use crate::linear_from_srgb;

/// The inset: each primary of sRGB moves towards grey.
const INSET: Matrix3 = Matrix3([
    [0.842_479_062_253_094, 0.078_433_599_999_999_2, 0.079_223_745_147_764_3],
    [0.042_328_242_261_012_3, 0.878_468_636_469_772, 0.079_166_127_460_543_4],
    [0.042_375_654_905_705_1, 0.078_433_6, 0.879_142_973_793_104],
]);

/// Middle grey.
const GREY: f64 = 0.18;

/// Stops below and above middle grey.
const STOPS: [f64; 2] = [10.0, 6.5];

/// The slope of the sigmoid at middle grey.
const SLOPE: f64 = 2.0;

/// The powers of toe and shoulder.
const POWERS: [f64; 2] = [3.0, 3.25];

/// Linear sRGB for linear sRGB; negative components count as 0.
pub(super) fn show(rgb: [f64; 3]) -> [f64; 3] {
    static OUTSET: LazyLock<Matrix3> =
        LazyLock::new(|| INSET.inverse().expect("invariant: the inset has an inverse"));
    let codes = OUTSET.apply(INSET.apply(rgb.map(|c| c.max(0.0))).map(|c| sigmoid(position(c))));
    codes.map(|code| linear_from_srgb(code.clamp(0.0, 1.0) as f32).into())
}

/// The position of light on the scale of stops, from 0 to 1.
fn position(light: f64) -> f64 {
    let stops = libm::log2(light.max(f64::MIN_POSITIVE) / GREY);
    ((stops + STOPS[0]) / (STOPS[0] + STOPS[1])).clamp(0.0, 1.0)
}

fn sigmoid(v: f64) -> f64 {
    let pivot = STOPS[0] / (STOPS[0] + STOPS[1]);
    let (x, reach, power) = match v < pivot {
        true => (pivot - v, pivot, POWERS[0]),
        false => (v - pivot, 1.0 - pivot, POWERS[1]),
    };
    // So that x = reach gives ½.
    let bend = (libm::pow(2.0 * SLOPE * reach, power) - 1.0) / libm::pow(reach, power);
    let height = SLOPE * x / libm::pow(1.0 + bend * libm::pow(x, power), 1.0 / power);
    if v < pivot { 0.5 - height } else { 0.5 + height }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sigmoid_has_the_published_constants() {
        assert!(sigmoid(0.0).abs() < 1e-12 && (sigmoid(1.0) - 1.0).abs() < 1e-12);
        assert!((position(GREY) - 20.0 / 33.0).abs() < 1e-12);
        // The coefficients of |v − p|ⁿ that implementations of it have.
        let bend = |reach: f64, power: f64| ((4.0 * reach).powf(power) - 1.0) / reach.powf(power);
        assert!((bend(20.0 / 33.0, 3.0) - 59.507_875).abs() < 1e-5);
        assert!((bend(13.0 / 33.0, 3.25) - 69.862_789_135).abs() < 1e-5);
        let slope = (sigmoid(20.0 / 33.0 + 1e-6) - sigmoid(20.0 / 33.0 - 1e-6)) / 2e-6;
        assert!((slope - SLOPE).abs() < 1e-4, "{slope}");
    }

    #[test]
    fn the_scale_of_stops_is_the_published_one() {
        assert!((GREY.log2() - STOPS[0] - -12.473_931_188).abs() < 1e-8);
        assert!((GREY.log2() + STOPS[1] - 4.026_068_811).abs() < 1e-8);
    }
}
