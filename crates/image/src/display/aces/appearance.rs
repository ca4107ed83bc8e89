//! The colour appearance model of the transform: that of CAM16 for a dim surround, with the white
//! of the colour space as the adapted white, and without the model's terms for colourfulness.
//!
//! Cones respond to light of 100 nits by r = 400 x / (27.13 + x), x = (F_L |c| / 100)^0.42, where c
//! is scaled so that white has c = 100. Sums and differences of r make the achromatic response A,
//! of which lightness is J = 100 A^(cz), and two opponent axes, of which M and h are the polar
//! coordinates.

use spectrum::Matrix3;

use super::Jmh;

/// The luminance of RGB (1, 1, 1) in nits.
const REFERENCE: f64 = 100.0;

/// The adapting luminance in nits.
const ADAPTING: f64 = 100.0;

/// The relative luminance of the background, of 100.
const BACKGROUND: f64 = 20.0;

/// The impact of a dim surround, and its factor on colourfulness.
const SURROUND: [f64; 2] = [0.59, 0.9];

/// The primaries of the cones' space.
const CONES: Primaries = Primaries {
    red: [0.8336, 0.1735],
    green: [2.3854, -1.4659],
    blue: [0.087, -0.125],
    white: [0.333, 0.333],
};

/// Chromaticities of primaries and white.
#[derive(Clone, Copy, Debug)]
pub struct Primaries {
    pub red: [f64; 2],
    pub green: [f64; 2],
    pub blue: [f64; 2],
    pub white: [f64; 2],
}

impl Primaries {
    /// The matrix from RGB to XYZ, where (1, 1, 1) is the white with Y = 1.
    pub fn xyz_from_rgb(&self) -> Matrix3 {
        let xyz = |[x, y]: [f64; 2]| [x / y, 1.0, (1.0 - x - y) / y];
        let columns = [self.red, self.green, self.blue].map(xyz);
        let primaries = Matrix3::from_columns(columns);
        let inverse = primaries.inverse().expect("invariant: primaries are independent");
        primaries * Matrix3::diagonal(inverse.apply(xyz(self.white)))
    }
}

/// The model, for colours of one space.
#[derive(Clone, Debug)]
pub struct Appearance {
    cones_from_rgb: Matrix3,
    rgb_from_cones: Matrix3,
    /// From responses to A and the opponent axes.
    aab_from_response: Matrix3,
    response_from_aab: Matrix3,
    /// F_L / 100.
    f_l: f64,
    /// The response to light of white's luminance.
    white: f64,
}

/// The exponent c z of J by A.
pub fn gamma() -> f64 {
    SURROUND[0] * (1.48 + (BACKGROUND / REFERENCE).sqrt())
}

impl Appearance {
    /// The model for a space with these primaries.
    pub fn new(primaries: &Primaries) -> Self {
        let cones_from_xyz = CONES.xyz_from_rgb().inverse().expect("invariant: primaries are independent");
        let cones = cones_from_xyz * primaries.xyz_from_rgb();
        let adaptation = Matrix3::diagonal(cones.apply([1.0; 3]).map(|c| REFERENCE / c));
        let cones_from_rgb = adaptation * cones;
        let k4 = (1.0 / (5.0 * ADAPTING + 1.0)).powi(4);
        let f_l = 0.2 * k4 * (5.0 * ADAPTING) + 0.1 * (1.0 - k4).powi(2) * libm::cbrt(5.0 * ADAPTING);
        let f_l = f_l / REFERENCE;
        let white = response(REFERENCE, f_l);
        let m = 43.0 * SURROUND[1];
        let achromatic = [2.0, 1.0, 0.05];
        let a_white = achromatic.iter().sum::<f64>() * white;
        let aab_from_response = Matrix3([
            achromatic.map(|weight| weight / a_white),
            [m, -12.0 / 11.0 * m, m / 11.0],
            [m / 9.0, m / 9.0, -2.0 / 9.0 * m],
        ]);
        let inverse = |matrix: Matrix3| matrix.inverse().expect("invariant: the model has an inverse");
        Self {
            cones_from_rgb,
            rgb_from_cones: inverse(cones_from_rgb),
            aab_from_response,
            response_from_aab: inverse(aab_from_response),
            f_l,
            white,
        }
    }

    /// How a colour appears.
    pub fn jmh(&self, rgb: [f64; 3]) -> Jmh {
        let responses = self.cones_from_rgb.apply(rgb).map(|c| response(c, self.f_l));
        let [a, x, y] = self.aab_from_response.apply(responses);
        if a <= 0.0 {
            return Jmh { j: 0.0, m: 0.0, h: 0.0 };
        }
        Jmh {
            j: 100.0 * libm::pow(a, gamma()),
            m: libm::hypot(x, y),
            h: libm::atan2(y, x).to_degrees().rem_euclid(360.0),
        }
    }

    /// The colour that appears so.
    pub fn rgb(&self, Jmh { j, m, h }: Jmh) -> [f64; 3] {
        let (sin, cos) = libm::sincos(h.to_radians());
        let a = libm::pow((j / 100.0).max(0.0), 1.0 / gamma());
        let responses = self.response_from_aab.apply([a, m * cos, m * sin]);
        self.rgb_from_cones.apply(responses.map(|r| light(r, self.f_l)))
    }

    /// The lightness of grey of this luminance in nits.
    pub fn lightness(&self, luminance: f64) -> f64 {
        100.0 * libm::pow(response(luminance, self.f_l) / self.white, gamma())
    }

    /// The luminance of grey of this lightness, in nits.
    pub fn luminance(&self, lightness: f64) -> f64 {
        light(self.white * libm::pow((lightness / 100.0).max(0.0), 1.0 / gamma()), self.f_l)
    }
}

fn response(c: f64, f_l: f64) -> f64 {
    let x = libm::pow(c.abs() * f_l, 0.42);
    (400.0 * x / (27.13 + x)).copysign(c)
}

/// The inverse of [`response`].
fn light(r: f64, f_l: f64) -> f64 {
    let x = 27.13 * r.abs() / (400.0 - r.abs()).max(1e-9);
    (libm::pow(x, 1.0 / 0.42) / f_l).copysign(r)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_model_round_trips_and_white_has_lightness_100() {
        let model = Appearance::new(&super::super::REC709);
        let white = model.jmh([1.0; 3]);
        assert!((white.j - 100.0).abs() < 1e-9 && white.m < 1e-9, "{white:?}");
        for rgb in [[0.1, 0.5, 0.9], [0.8, 0.05, 0.1], [0.2, 0.2, 0.2]] {
            let back = model.rgb(model.jmh(rgb));
            assert!((0..3).all(|c| (back[c] - rgb[c]).abs() < 1e-9), "{back:?}");
        }
        assert!((model.luminance(model.lightness(18.0)) - 18.0).abs() < 1e-9);
    }
}
