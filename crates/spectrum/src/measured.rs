//! Measured spectra by name: metals, glasses, illuminants and cameras, under pbrt-v4's names.
//!
//! `metal-X-eta` and `metal-X-k` are the real and imaginary part of an index of refraction,
//! `glass-X` a real one, `stdillum-X` and `illum-X` light of unit luminance; the name of a camera
//! with `_r`, `_g` or `_b` is the relative sensitivity of one of its channels [Solomatov 2023].
//! Further sources are in the files of `data/`.

use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock};

use crate::cie::{CIE_Y_INTEGRAL, integrate, matching_functions};
use crate::piecewise::PiecewiseLinear;

/// The spectrum called `name`.
pub(crate) fn measured(name: &str) -> Option<Arc<PiecewiseLinear>> {
    TABLE.get(name).cloned()
}

/// All names, in alphabetical order.
pub fn names() -> impl Iterator<Item = &'static str> {
    TABLE.keys().copied()
}

static TABLE: LazyLock<BTreeMap<&'static str, Arc<PiecewiseLinear>>> = LazyLock::new(|| {
    let measured = [include_str!("../data/metals.txt"), include_str!("../data/glasses.txt")];
    let mut table: BTreeMap<&str, Arc<PiecewiseLinear>> =
        measured.into_iter().flat_map(sections).map(|(name, spectrum)| (name, spectrum.into())).collect();
    for (name, light) in sections(include_str!("../data/illuminants.txt")) {
        table.insert(name, Arc::new(with_unit_luminance(light)));
    }
    let cameras = parts(include_str!("../data/cameras.txt"));
    table.extend(cameras.map(|(name, row)| (name, Arc::new(every_ten(row)))));
    table
});

/// The reflectances of the 24 patches of the ColorChecker, a chart by which cameras are calibrated
/// [Pascale 2006].
pub fn color_checker() -> impl Iterator<Item = PiecewiseLinear> {
    let rows = include_str!("../data/color_checker.txt").lines();
    rows.filter(|row| !row.starts_with('#')).map(every_ten)
}

/// The spectrum of values at 380, 390, 400 … nanometres.
fn every_ten(row: &str) -> PiecewiseLinear {
    let value = |word: &str| word.parse().expect("invariant: the tables are well formed");
    let pairs: Vec<(f32, f32)> =
        row.split_whitespace().enumerate().map(|(i, word)| (380.0 + 10.0 * i as f32, value(word))).collect();
    PiecewiseLinear::from_pairs(&pairs).expect("invariant: the tables are well formed")
}

/// The parts of a file: `[name]`, then text.
fn parts(text: &'static str) -> impl Iterator<Item = (&'static str, &'static str)> {
    text.split('[').skip(1).map(|part| part.split_once(']').expect("invariant: a name ends with a bracket"))
}

/// The parts of a file of spectra: `[name]`, then pairs of wavelength and value.
fn sections(text: &'static str) -> impl Iterator<Item = (&'static str, PiecewiseLinear)> {
    let spectrum = |pairs| PiecewiseLinear::parse(pairs).expect("invariant: the tables are well formed");
    parts(text).map(move |(name, pairs)| (name, spectrum(pairs)))
}

/// The light scaled so that its Y is one.
fn with_unit_luminance(light: PiecewiseLinear) -> PiecewiseLinear {
    let y_bar = &matching_functions().y;
    let luminance = integrate(|lambda| light.at(lambda) * y_bar.at(lambda)) / CIE_Y_INTEGRAL;
    light.scaled(1.0 / luminance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cie::integrate_xyz;
    use crate::spectrum::named;

    #[test]
    fn every_name_has_a_spectrum() {
        let metals = ["Ag", "Al", "Au", "Cu", "CuZn", "MgO", "TiO2"];
        let glasses = ["BK7", "BAF10", "FK51A", "LASF9", "F5", "F10", "F11"];
        let lights =
            ["A", "D50", "D65", "F1", "F2", "F3", "F4", "F5", "F6", "F7", "F8", "F9", "F10", "F11", "F12"];
        for metal in metals {
            assert!(
                named(&format!("metal-{metal}-eta")).is_some()
                    && named(&format!("metal-{metal}-k")).is_some()
            );
        }
        for glass in glasses {
            let spectrum = named(&format!("glass-{glass}")).unwrap();
            for lambda in [360.0, 550.0, 830.0] {
                assert!((1.4..2.0).contains(&spectrum.at(lambda)), "{glass} at {lambda}");
            }
        }
        for light in lights.iter().map(|l| format!("stdillum-{l}")).chain(["illum-acesD60".into()]) {
            assert!((named(&light).unwrap().to_xyz().y - 1.0).abs() < 1e-5, "{light}");
        }
        let cameras = names().filter(|name| name.ends_with("_g")).count();
        assert_eq!(cameras, 17);
        assert_eq!(names().count(), 2 * metals.len() + glasses.len() + lights.len() + 1 + 3 * cameras);
        assert!(named("metal-Unobtainium-eta").is_none());
    }

    #[test]
    fn indices_of_refraction_are_the_published_ones() {
        for (name, lambda, value) in [
            ("metal-Au-eta", 450.851_56, 1.502_125),
            ("metal-Cu-k", 590.400_8, 2.809),
            ("metal-Ag-k", 506.057_86, 2.973_75),
            ("metal-Al-eta", 604.800_84, 1.22),
            ("metal-CuZn-eta", 600.0, 0.450),
            ("metal-TiO2-eta", 619.9, 2.88),
            ("metal-MgO-eta", 589.259, 1.737_37),
            // The helium d line of the catalogue.
            ("glass-BK7", 587.56, 1.516_80),
            ("glass-F11", 587.56, 1.784_72),
        ] {
            let ours = named(name).unwrap().at(lambda);
            assert!((ours / value - 1.0).abs() < 3e-4, "{name} at {lambda}: {ours}");
        }
    }

    #[test]
    fn cameras_see_red_green_and_blue_where_they_should() {
        for green in names().filter(|name| name.ends_with("_g")) {
            let camera = green.strip_suffix("_g").unwrap();
            let peak = |channel: &str| {
                let curve = named(&format!("{camera}_{channel}")).unwrap();
                let values = (380..=720).map(|lambda| (curve.at(lambda as f32), lambda));
                assert_eq!((curve.at(370.0), curve.at(730.0)), (0.0, 0.0));
                values.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap()
            };
            assert_eq!(peak("g"), (1.0, 520), "{camera}");
            let ((red, at_red), (blue, at_blue)) = (peak("r"), peak("b"));
            assert!((0.4..0.7).contains(&red) && (590..=600).contains(&at_red), "{camera}: {red} {at_red}");
            assert!(
                (0.6..0.95).contains(&blue) && (450..=480).contains(&at_blue),
                "{camera}: {blue} {at_blue}"
            );
        }
        assert_eq!(named("nikon_d810_b").unwrap().at(475.0), 0.5 * (0.91527 + 0.90722));
    }

    #[test]
    fn the_patches_of_the_chart_have_their_colours() {
        let patches: Vec<_> = color_checker().collect();
        assert_eq!(patches.len(), 24);
        let luminance = |patch: &PiecewiseLinear| {
            let d50 = named("stdillum-D50").unwrap();
            integrate_xyz(|lambda| patch.at(lambda) * d50.at(lambda)).y
        };
        // The published L* of the grey patches under D50: 96.5, 81.3, 66.8, 51.0, 35.7 and 20.5.
        for (patch, lightness) in patches[18..].iter().zip([96.5, 81.3, 66.8, 51.0, 35.7, 20.5]) {
            let ours = 116.0 * luminance(patch).cbrt() - 16.0;
            assert!((ours - lightness).abs() < 1.0, "{ours} is not {lightness}");
        }
    }

    #[test]
    fn illuminants_have_their_known_chromaticities() {
        for (name, xy) in [
            ("stdillum-A", [0.447_58, 0.407_45]),
            ("stdillum-D65", [0.312_72, 0.329_03]),
            ("stdillum-F2", [0.372_08, 0.375_29]),
            ("stdillum-F11", [0.380_52, 0.377_13]),
            ("illum-acesD60", [0.321_68, 0.337_67]),
        ] {
            let ours = named(name).unwrap().to_xyz().xy();
            assert!((0..2).all(|i| (ours[i] - xy[i]).abs() < 3e-4), "{name}: {ours:?}");
        }
    }
}
