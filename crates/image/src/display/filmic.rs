//! A curve like that of photographic film, for red, green and blue apart: the operator that Hable
//! fitted for the game Uncharted 2 [Hable 2010].
//!
//! f(x) = (x (A x + C B) + D E) / (x (A x + B) + D F) − E/F has a toe and a shoulder. It is applied
//! to twice the light, and scaled so that the linear white W becomes 1.

/// Strengths of shoulder and linear part, angle of the linear part, strength of the toe, numerator
/// and denominator of the toe.
const A: f64 = 0.15;
const B: f64 = 0.50;
const C: f64 = 0.10;
const D: f64 = 0.20;
const E: f64 = 0.02;
const F: f64 = 0.30;

/// The light that becomes white.
const WHITE: f64 = 11.2;

/// The factor on all light before the curve.
const EXPOSURE: f64 = 2.0;

/// Linear sRGB for linear sRGB; negative components count as 0.
pub(super) fn show(rgb: [f64; 3]) -> [f64; 3] {
    rgb.map(|c| curve(EXPOSURE * c.clamp(0.0, 1e6)) / curve(WHITE))
}

fn curve(x: f64) -> f64 {
    (x * (A * x + C * B) + D * E) / (x * (A * x + B) + D * F) - E / F
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_begins_at_black_and_reaches_white_at_w() {
        assert!(show([0.0; 3])[0].abs() < 1e-12);
        assert!((show([WHITE / EXPOSURE; 3])[1] - 1.0).abs() < 1e-12);
        // The factor to white that implementations of it have.
        assert!((1.0 / curve(WHITE) - 1.379_064).abs() < 1e-6);
    }
}
