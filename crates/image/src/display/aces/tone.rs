//! The tone scale: an S-shaped curve from the luminance of the scene to that of the display.
//!
//! With f = m₂ (Y / (Y + s₂))^g it is Y' = 100 f² / (f + t₁). The constants m₂ and s₂ follow from
//! what 18 % grey becomes, and from the light that reaches the peak.

/// The exponent: contrast for the surround.
const CONTRAST: f64 = 1.15;

/// Middle grey of the scene, and the nits that it gets.
const GREY: [f64; 2] = [0.18, 10.013];

/// The strength of the toe.
const TOE: f64 = 0.04;

/// The light that reaches the peak, in units of diffuse white.
pub const ROOF: f64 = 128.0;

/// The peak in nits.
pub const PEAK: f64 = 100.0;

/// The tone scale.
#[derive(Clone, Copy, Debug)]
pub struct ToneScale {
    s2: f64,
    m2: f64,
}

impl ToneScale {
    /// The scale for a peak of 100 nits.
    pub fn new() -> Self {
        // What f has to be for an output of y, as a fraction of the peak.
        let before_toe = |y: f64| 0.5 * (y + (y * (y + 4.0 * TOE)).sqrt());
        let top = before_toe(1.0);
        let m = top / libm::pow(ROOF / top / (ROOF / top + 1.0), CONTRAST);
        let grey = libm::pow(before_toe(GREY[1] / PEAK) / m, 1.0 / CONTRAST);
        let w = GREY[0] / (top * grey / (1.0 - grey));
        let m2 = top / libm::pow(ROOF / top / (ROOF / top + w), CONTRAST);
        Self { s2: w * top * 100.0, m2 }
    }

    /// The display's luminance for the scene's, in nits where diffuse white has 100.
    pub fn luminance(&self, y: f64) -> f64 {
        let f = self.m2 * libm::pow(y / (y + self.s2), CONTRAST);
        f * f / (f + TOE) * PEAK
    }

    /// The luminance of middle grey on the display, in nits.
    pub fn grey(&self) -> f64 {
        GREY[1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grey_and_peak_are_where_they_should_be() {
        let scale = ToneScale::new();
        assert!((scale.luminance(18.0) - 10.013).abs() < 0.02, "{}", scale.luminance(18.0));
        assert!((scale.luminance(100.0 * ROOF) - PEAK).abs() < 1e-9);
        assert!(scale.luminance(0.0) == 0.0);
    }
}
