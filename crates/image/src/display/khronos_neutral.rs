//! "PBR Neutral", the tone mapper of Khronos for pictures of products, which keeps base colours
//! below 0.8 as they are [Khronos 2024].
//!
//! The reflection of white light at F₉₀ = 0.04 (that of the index 1.5) is taken off, as if it were
//! not part of the surface's colour; peaks from K_s = 0.8 − F₉₀ on are compressed towards 1, and
//! desaturate at the speed K_d = 0.15.

/// Reflectance of common materials at normal incidence.
const F90: f64 = 0.04;

/// Where the compression of highlights begins.
const START: f64 = 0.8 - F90;

/// The speed of desaturation.
const DESATURATION: f64 = 0.15;

/// Linear sRGB for linear sRGB; negative components, which the definition does not have, count as
/// 0.
pub(super) fn show(rgb: [f64; 3]) -> [f64; 3] {
    let rgb = rgb.map(|c| c.max(0.0));
    let least = rgb[0].min(rgb[1]).min(rgb[2]);
    let offset = if least < 2.0 * F90 { least - least * least / (4.0 * F90) } else { F90 };
    let rgb = rgb.map(|c| c - offset);
    let peak = rgb[0].max(rgb[1]).max(rgb[2]);
    if peak <= START {
        return rgb;
    }
    let new_peak = 1.0 - (1.0 - START).powi(2) / (peak + 1.0 - 2.0 * START);
    let keep = 1.0 / (DESATURATION * (peak - new_peak) + 1.0);
    rgb.map(|c| c * new_peak / peak * keep + new_peak * (1.0 - keep))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base_colours_are_kept_but_for_the_reflection() {
        assert_eq!(show([0.5, 0.3, 0.2]), [0.46, 0.26, 0.2 - 0.04]);
        // A colour without white keeps all its light.
        assert_eq!(show([0.5, 0.3, 0.0]), [0.5, 0.3, 0.0]);
    }

    #[test]
    fn it_is_continuous_where_its_parts_meet() {
        for at in [[2.0 * F90; 3], [START + F90; 3], [START, 0.0, 0.0]] {
            let [below, above] = [-1e-7, 1e-7].map(|d| show(at.map(|c| c * (1.0 + d))));
            assert!((0..3).all(|c| (below[c] - above[c]).abs() < 1e-6), "{at:?}: {below:?} {above:?}");
        }
    }

    #[test]
    fn highlights_approach_white() {
        let [r, g, b] = show([1e5, 1e3, 1e3]);
        assert!(r > 0.9999 && g > 0.99 && b == g && r <= 1.0, "{r} {g}");
    }
}
