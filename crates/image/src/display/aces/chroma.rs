//! Chroma compression: colourfulness follows the tone scale, and is then shaped by two toes that
//! depend on lightness, so that dark and bright colours are less saturated than those between.

use super::Jmh;
use super::appearance::{Appearance, gamma};
use super::tone::PEAK;

/// How much colours of low colourfulness are compressed.
const COMPRESSION: f64 = 2.4;

/// How much those of high colourfulness are expanded, and from which part of the peak's nits on.
const EXPANSION: [f64; 2] = [1.3, 0.5];

/// The tables of the compression.
#[derive(Clone, Debug)]
pub struct ChromaCompression {
    /// The largest colourfulness of AP1 at the lightness of the peak, for each degree of hue.
    reach: [f64; 360],
    /// The lightness of the peak.
    peak: f64,
    scale: f64,
}

impl ChromaCompression {
    /// For colours of this space.
    pub fn new(input: &Appearance) -> Self {
        let peak = input.lightness(PEAK);
        let reach = std::array::from_fn(|degree| largest_colourfulness(input, peak, degree as f64));
        Self { reach, peak, scale: libm::pow(0.033_79 * PEAK, 0.305_96) - 0.451_35 }
    }

    /// The largest colourfulness of the input at this hue, at the lightness of the peak.
    pub fn reach(&self, hue: f64) -> f64 {
        let degree = (hue as usize).min(359);
        let (a, b) = (self.reach[degree], self.reach[(degree + 1) % 360]);
        a + (b - a) * (hue - degree as f64)
    }

    /// The colour with the lightness `j` of the display and compressed colourfulness.
    pub fn compress(&self, Jmh { j: j_scene, m, h }: Jmh, j: f64) -> Jmh {
        if m == 0.0 || j_scene <= 0.0 {
            return Jmh { j, m: 0.0, h };
        }
        let (light, gamma) = (j / self.peak, 1.0 / gamma());
        let dark = (1.0 - light).max(0.0);
        let norm = self.norm(h);
        let limit = libm::pow(light, gamma) * self.reach(h) / norm;
        let m = m * libm::pow(j / j_scene, gamma) / norm;
        let m = limit
            - toe(
                limit - m,
                limit - 0.001,
                dark * EXPANSION[0],
                (light * light + EXPANSION[1] / PEAK).sqrt(),
            );
        let m = toe(m, limit, light * COMPRESSION, dark);
        Jmh { j, m: m * norm, h }
    }

    /// The colourfulness that counts as 1 at this hue: a sum of harmonics, fitted to the space of
    /// hues that people see as evenly spaced.
    fn norm(&self, hue: f64) -> f64 {
        const COS: [f64; 3] = [11.340_72, 16.468_99, 7.883_80];
        const SIN: [f64; 3] = [14.664_41, -6.372_24, 9.193_64];
        let harmonics = (0..3).map(|i| {
            let (sin, cos) = libm::sincos((i + 1) as f64 * hue.to_radians());
            COS[i] * cos + SIN[i] * sin
        });
        (harmonics.sum::<f64>() + 77.128_96) * self.scale
    }
}

/// A toe below `limit`, beyond which it is the identity.
fn toe(x: f64, limit: f64, k1: f64, k2: f64) -> f64 {
    if x > limit {
        return x;
    }
    let k2 = k2.max(0.001);
    let k1 = (k1 * k1 + k2 * k2).sqrt();
    let k3 = (limit + k1) / (limit + k2);
    let b = k3 * x - k1;
    0.5 * (b + (b * b + 4.0 * k2 * k3 * x).sqrt())
}

/// The colourfulness at which a colour leaves the space, for this lightness and hue.
fn largest_colourfulness(space: &Appearance, j: f64, h: f64) -> f64 {
    let is_outside = |m: f64| space.rgb(Jmh { j, m, h }).iter().any(|c| *c < 0.0);
    let (mut low, mut high) = (0.0, 50.0);
    while high < 1300.0 && !is_outside(high) {
        (low, high) = (high, high + 50.0);
    }
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if is_outside(middle) { high = middle } else { low = middle }
    }
    high
}
