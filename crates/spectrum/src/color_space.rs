//! RGB colour spaces, given by three primaries and a white point.
//!
//! The matrix that takes RGB to XYZ has the primaries as columns, each scaled so that RGB (1, 1, 1)
//! is the white: the colour of the space's illuminant at unit luminance [Pharr 2023 §4.6.3]. A
//! space also has the table that turns its RGB values into spectra; see [`crate::uplift`].
//!
//! White balance scales in the Bradford cone space: M⁻¹ diag(LMS_target / LMS_source) M [Lam 1985].

use lanes::Real;
use std::fmt;
use std::sync::{Arc, LazyLock, OnceLock};

use crate::cie::integrate_xyz;
use crate::dense::DenselySampled;
use crate::matrix::Matrix3;
use crate::measured::measured;
use crate::rgb::{Rgb, Xyz};
use crate::uplift::{RgbSigmoidPolynomial, RgbToSpectrumTable};

/// An RGB colour space.
pub struct RgbColorSpace {
    name: &'static str,
    primaries: [[f32; 2]; 3],
    white: [f32; 2],
    illuminant: Arc<DenselySampled>,
    xyz_from_rgb: Matrix3,
    rgb_from_xyz: Matrix3,
    table_data: &'static [u8],
    table: OnceLock<RgbToSpectrumTable>,
}

/// Defines the function that returns one colour space.
macro_rules! color_space {
    ($(#[$doc:meta])* $function:ident, $name:literal, $illuminant:literal, $r:expr, $g:expr, $b:expr, $data:literal) => {
        impl RgbColorSpace {
            $(#[$doc])*
            pub fn $function() -> &'static Self {
                static SPACE: LazyLock<RgbColorSpace> = LazyLock::new(|| {
                    RgbColorSpace::new($name, [$r, $g, $b], $illuminant, include_bytes!(concat!("../data/", $data)))
                });
                &SPACE
            }
        }
    };
}

color_space! {
    /// sRGB, with the primaries of ITU-R BT.709 and D65.
    srgb, "srgb", "stdillum-D65", [0.64, 0.33], [0.3, 0.6], [0.15, 0.06], "rgb_srgb.bin"
}

color_space! {
    /// Display P3: the primaries of DCI-P3 with D65.
    dci_p3, "dci-p3", "stdillum-D65", [0.68, 0.32], [0.265, 0.69], [0.15, 0.06], "rgb_dci_p3.bin"
}

color_space! {
    /// ITU-R BT.2020, with D65.
    rec2020, "rec2020", "stdillum-D65", [0.708, 0.292], [0.17, 0.797], [0.131, 0.046], "rgb_rec2020.bin"
}

color_space! {
    /// ACES 2065-1 of the Academy of Motion Picture Arts and Sciences, with its D60.
    aces2065_1, "aces2065-1", "illum-acesD60", [0.7347, 0.2653], [0.0, 1.0], [0.0001, -0.077], "rgb_aces2065_1.bin"
}

impl RgbColorSpace {
    fn new(
        name: &'static str,
        primaries: [[f32; 2]; 3],
        illuminant: &str,
        table_data: &'static [u8],
    ) -> Self {
        let illuminant =
            measured(illuminant).expect("invariant: the illuminants of colour spaces are named spectra");
        let white_xyz = integrate_xyz(|lambda| illuminant.at(lambda));
        let columns = primaries.map(|[x, y]| {
            let [x, y] = [f64::from(x), f64::from(y)];
            [x / y, 1.0, (1.0 - x - y) / y]
        });
        let unscaled = Matrix3::from_columns(columns);
        let scale = unscaled
            .inverse()
            .expect("invariant: the primaries are distinct")
            .apply(white_xyz.to_array().map(f64::from));
        let xyz_from_rgb = unscaled * Matrix3::diagonal(scale);
        Self {
            name,
            primaries,
            white: white_xyz.xy(),
            illuminant: Arc::new(DenselySampled::from_fn(|lambda| illuminant.at(lambda))),
            xyz_from_rgb,
            rgb_from_xyz: xyz_from_rgb.inverse().expect("invariant: the primaries are distinct"),
            table_data,
            table: OnceLock::new(),
        }
    }

    /// All colour spaces.
    pub fn all() -> [&'static Self; 4] {
        [Self::srgb(), Self::dci_p3(), Self::rec2020(), Self::aces2065_1()]
    }

    /// The colour space with this name: `srgb`, `dci-p3`, `rec2020` or `aces2065-1`, in letters of
    /// any case.
    pub fn named(name: &str) -> Option<&'static Self> {
        Self::all().into_iter().find(|space| space.name.eq_ignore_ascii_case(name))
    }

    /// The colour space with about these chromaticities of red, green, blue and white.
    pub fn from_chromaticities(primaries: [[f32; 2]; 3], white: [f32; 2]) -> Option<&'static Self> {
        let close = |a: [f32; 2], b: [f32; 2]| (0..2).all(|i| (a[i] - b[i]).abs() <= 1e-3 * b[i].abs());
        Self::all().into_iter().find(|space| {
            close(white, space.white) && (0..3).all(|i| close(primaries[i], space.primaries[i]))
        })
    }

    /// The name that [`named`](Self::named) knows it by.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Chromaticities of red, green and blue.
    pub fn primaries(&self) -> [[f32; 2]; 3] {
        self.primaries
    }

    /// Chromaticity of the white.
    pub fn white(&self) -> [f32; 2] {
        self.white
    }

    /// The illuminant of this space, with unit luminance, at `lambda` nanometres.
    #[inline(always)]
    pub fn illuminant_at<R: Real>(&self, lambda: R) -> R {
        self.illuminant.at(lambda)
    }

    /// The illuminant of this space, with unit luminance, shared.
    pub(crate) fn shared_illuminant(&self) -> Arc<DenselySampled> {
        Arc::clone(&self.illuminant)
    }

    /// The matrix from RGB to XYZ.
    pub fn xyz_from_rgb(&self) -> Matrix3 {
        self.xyz_from_rgb
    }

    /// The matrix from XYZ to RGB.
    pub fn rgb_from_xyz(&self) -> Matrix3 {
        self.rgb_from_xyz
    }

    /// The colour `xyz` in this space.
    #[inline]
    pub fn to_rgb(&self, xyz: Xyz) -> Rgb {
        self.rgb_from_xyz.apply_f32(xyz.to_array()).into()
    }

    /// The colour that `rgb` means in this space.
    #[inline]
    pub fn to_xyz(&self, rgb: Rgb) -> Xyz {
        self.xyz_from_rgb.apply_f32(rgb.to_array()).into()
    }

    /// Weights of red, green and blue in luminance.
    pub fn luminance_weights(&self) -> Rgb {
        self.xyz_from_rgb.0[1].map(|v| v as f32).into()
    }

    /// The matrix from this space's RGB to that of `target`.
    pub fn convert(&self, target: &Self) -> Matrix3 {
        if self == target { Matrix3::IDENTITY } else { target.rgb_from_xyz * self.xyz_from_rgb }
    }

    /// The smooth reflectance with the colour `rgb` under this space's illuminant; components
    /// outside [0, 1] are clamped.
    pub fn to_rgb_coeffs(&self, rgb: Rgb) -> RgbSigmoidPolynomial {
        self.uplifting().polynomial(rgb.to_array())
    }

    /// The table of smooth reflectances, which is decoded by the first call.
    #[inline]
    pub fn uplifting(&self) -> &RgbToSpectrumTable {
        self.table.get_or_init(|| RgbToSpectrumTable::decode(self.table_data))
    }
}

impl PartialEq for RgbColorSpace {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl fmt::Debug for RgbColorSpace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "RgbColorSpace({})", self.name)
    }
}

/// Bradford's matrix from XYZ to cone responses (LMS).
const LMS_FROM_XYZ: Matrix3 =
    Matrix3([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]]);

/// The chromatic adaptation matrix on XYZ from a white of chromaticity `source` to one of `target`.
pub fn white_balance(source: [f32; 2], target: [f32; 2]) -> Matrix3 {
    let lms = |xy| LMS_FROM_XYZ.apply(Xyz::from_xy(xy, 1.0).to_array().map(f64::from));
    let (from, to) = (lms(source), lms(target));
    let xyz_from_lms = LMS_FROM_XYZ.inverse().expect("invariant: Bradford's matrix has an inverse");
    xyz_from_lms * Matrix3::diagonal(std::array::from_fn(|i| to[i] / from[i])) * LMS_FROM_XYZ
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: [f32; 3], b: [f32; 3], tolerance: f32) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() <= tolerance)
    }

    #[test]
    fn the_illuminant_is_white_in_each_space() {
        for space in RgbColorSpace::all() {
            let white = space.illuminant().to_xyz();
            assert!((white.y - 1.0).abs() < 1e-5);
            assert!(close(space.to_rgb(white).to_array(), [1.0; 3], 1e-5), "{space:?}");
            assert!(close(space.to_xyz(Rgb::splat(1.0)).to_array(), white.to_array(), 1e-5), "{space:?}");
        }
    }

    #[test]
    fn whites_have_their_known_chromaticities() {
        for (space, white) in
            [(RgbColorSpace::srgb(), [0.3127, 0.3290]), (RgbColorSpace::aces2065_1(), [0.32168, 0.33767])]
        {
            assert!(
                (0..2).all(|i| (space.white()[i] - white[i]).abs() < 2e-4),
                "{space:?} {:?}",
                space.white()
            );
        }
    }

    #[test]
    fn the_matrix_of_srgb_is_the_standard_one() {
        let standard = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]];
        for (row, expected) in RgbColorSpace::srgb().xyz_from_rgb().0.iter().zip(standard) {
            assert!(close(row.map(|v| v as f32), expected, 5e-4), "{row:?}");
        }
    }

    #[test]
    fn conversions_round_trip() {
        let colour = [0.2, 0.7, 0.4];
        for from in RgbColorSpace::all() {
            for to in RgbColorSpace::all() {
                let there = from.convert(to).apply_f32(colour);
                assert!(close(to.convert(from).apply_f32(there), colour, 1e-5));
            }
        }
    }

    #[test]
    fn spaces_are_found_by_name_and_by_chromaticities() {
        for space in RgbColorSpace::all() {
            assert_eq!(RgbColorSpace::named(&space.name().to_uppercase()), Some(space));
            assert_eq!(RgbColorSpace::from_chromaticities(space.primaries(), space.white()), Some(space));
        }
        assert_eq!(RgbColorSpace::named("sRGB2"), None);
        assert_eq!(RgbColorSpace::from_chromaticities([[0.5, 0.5]; 3], [0.3, 0.3]), None);
    }

    #[test]
    fn white_balance_takes_white_to_white() {
        let (warm, cool) = ([0.44757, 0.40745], [0.3127, 0.3290]);
        let balanced = Xyz::from(white_balance(warm, cool).apply_f32(Xyz::from_xy(warm, 1.0).to_array()));
        assert!((0..2).all(|i| (balanced.xy()[i] - cool[i]).abs() < 1e-5));
        assert!((balanced.y - 1.0).abs() < 1e-3);
    }
}
