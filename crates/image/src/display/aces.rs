//! The output transform of ACES 2.0 for a display with the primaries of Rec. 709 and a peak of 100
//! nits [AMPAS 2025].
//!
//! It works on lightness J, colourfulness M and hue h of a colour appearance model:
//!
//! 1. A tone scale compresses the luminance of J.
//! 2. Chroma compression reduces M as J was reduced, and a little more where the display has less.
//! 3. Gamut compression moves colours towards grey until the display can show them, without
//!    changing their hue.
//!
//! The tables are those of the reference; all is in double precision.

mod appearance;
mod chroma;
mod gamut;
mod tone;

use std::sync::LazyLock;

use spectrum::{Matrix3, RgbColorSpace, white_balance};

use self::appearance::{Appearance, Primaries};
use self::chroma::ChromaCompression;
use self::gamut::GamutCompression;
use self::tone::ToneScale;

/// The primaries and the white of ACES "AP1".
const AP1: Primaries = Primaries {
    red: [0.713, 0.293],
    green: [0.165, 0.830],
    blue: [0.128, 0.044],
    white: [0.321_68, 0.337_67],
};

/// Those of Rec. 709.
const REC709: Primaries =
    Primaries { red: [0.64, 0.33], green: [0.30, 0.60], blue: [0.15, 0.06], white: [0.3127, 0.3290] };

/// Light beyond this is not told apart: eight times what the tone scale maps to the peak.
const BRIGHTEST: f64 = 8.0 * tone::ROOF;

/// Lightness, colourfulness and hue in degrees from 0 to 360.
#[derive(Clone, Copy, Debug)]
struct Jmh {
    j: f64,
    m: f64,
    h: f64,
}

/// The tables of the transform.
struct Transform {
    input: Appearance,
    display: Appearance,
    tone: ToneScale,
    chroma: ChromaCompression,
    gamut: GamutCompression,
}

/// The matrix from a colour space to AP1, adapted to its white.
pub(super) fn ap1_from(space: &RgbColorSpace) -> Matrix3 {
    let rgb_from_xyz = AP1.xyz_from_rgb().inverse().expect("invariant: primaries are independent");
    let [x, y] = AP1.white;
    rgb_from_xyz * white_balance(space.white(), [x as f32, y as f32]) * space.xyz_from_rgb()
}

/// Linear sRGB for linear AP1.
pub(super) fn show(rgb: [f64; 3]) -> [f64; 3] {
    static TRANSFORM: LazyLock<Transform> = LazyLock::new(Transform::new);
    TRANSFORM.show(rgb)
}

impl Transform {
    fn new() -> Self {
        let (input, display) = (Appearance::new(&AP1), Appearance::new(&REC709));
        let tone = ToneScale::new();
        let chroma = ChromaCompression::new(&input);
        let gamut = GamutCompression::new(&input, &display, &tone);
        Self { input, display, tone, chroma, gamut }
    }

    fn show(&self, rgb: [f64; 3]) -> [f64; 3] {
        let seen = self.input.jmh(rgb.map(|c| c.clamp(0.0, BRIGHTEST)));
        let j = self.input.lightness(self.tone.luminance(self.input.luminance(seen.j)));
        let compressed = self.chroma.compress(seen, j);
        let reach = self.chroma.reach(compressed.h);
        self.display.rgb(self.gamut.compress(compressed, reach)).map(|c| c.clamp(0.0, 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_those_of_the_reference() {
        // Linear AP1, and linear Rec. 709 by OpenColorIO 2.6.
        for (rgb, known) in [
            ([0.18, 0.18, 0.18], [0.1, 0.1, 0.1]),
            ([1.0, 1.0, 1.0], [0.45757, 0.45757, 0.45757]),
            ([0.02, 0.02, 0.02], [0.00298, 0.00298, 0.00298]),
            ([5.0, 5.0, 5.0], [0.82405, 0.82405, 0.82405]),
            ([50.0, 50.0, 50.0], [0.98688, 0.98688, 0.98688]),
            ([0.5, 0.1, 0.05], [0.47289, 0.0228, 0.01509]),
            ([1.0, 0.2, 0.05], [0.85853, 0.07253, 0.01355]),
            ([0.1, 0.6, 0.15], [0.00303, 0.33684, 0.11102]),
            ([0.05, 0.1, 0.9], [0.00173, 0.07376, 0.44202]),
            ([4.0, 0.5, 0.2], [1.0, 0.28764, 0.2234]),
            ([0.2, 3.0, 0.4], [0.0, 0.88634, 0.23784]),
            ([0.1, 0.3, 6.0], [0.13905, 0.306, 1.0]),
            ([2.0, 2.0, 0.1], [0.72873, 0.71026, 0.02137]),
            ([0.05, 1.2, 1.4], [0.0, 0.53844, 0.5577]),
            ([1.5, 0.1, 1.2], [0.99879, 0.03576, 0.57281]),
            ([-0.02, 0.3, 0.1], [0.0, 0.15707, 0.07718]),
            ([30.0, 2.0, 1.0], [1.0, 0.75747, 0.72863]),
            ([0.0, 0.0, 20.0], [0.32363, 0.45374, 1.0]),
        ] {
            let shown = show(rgb);
            let error = (0..3).map(|c| (shown[c] - known[c]).abs()).fold(0.0, f64::max);
            assert!(error < 5e-5, "{rgb:?}: {shown:.5?} is not {known:?}");
        }
    }

    #[test]
    fn white_of_any_space_is_white() {
        for space in RgbColorSpace::all() {
            let white = ap1_from(space).apply([1.0; 3]);
            assert!(white.iter().all(|c| (c - 1.0).abs() < 1e-3), "{space:?}: {white:?}");
        }
    }
}
