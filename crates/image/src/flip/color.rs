//! The colour spaces of FLIP: linear sRGB → XYZ → YCxCz, and → CIE L*a*b* with Hunt-adjusted
//! chroma.
//!
//! White is that of the sRGB matrix below (D65). The digits are those of the published evaluator,
//! so that numbers agree.

use math::Vec3;

/// The white point: XYZ of RGB = (1, 1, 1).
const WHITE: Vec3 = Vec3::new(0.950_428_55, 1.0, 1.088_900_4);

fn xyz_from_rgb(c: Vec3) -> Vec3 {
    Vec3::new(
        (10_135_552.0 * c.x + 8_788_810.0 * c.y + 4_435_075.0 * c.z) / 24_577_794.0,
        (2_613_072.0 * c.x + 8_788_810.0 * c.y + 887_015.0 * c.z) / 12_288_897.0,
        (1_425_312.0 * c.x + 8_788_810.0 * c.y + 70_074_185.0 * c.z) / 73_733_382.0,
    )
}

fn rgb_from_xyz(c: Vec3) -> Vec3 {
    Vec3::new(
        3.241_003_3 * c.x - 1.537_398_9 * c.y - 0.498_615_86 * c.z,
        -0.969_224_33 * c.x + 1.875_930_1 * c.y + 0.041_554_224 * c.z,
        0.055_639_423 * c.x - 0.204_011_2 * c.y + 1.057_148_9 * c.z,
    )
}

/// The opponent channels: lightness, red-green and blue-yellow, linear in the light.
pub fn ycxcz_from_rgb(rgb: Vec3) -> Vec3 {
    let c = xyz_from_rgb(rgb) / WHITE;
    Vec3::new(116.0 * c.y - 16.0, 500.0 * (c.x - c.y), 200.0 * (c.y - c.z))
}

/// The inverse of [`ycxcz_from_rgb`].
pub fn rgb_from_ycxcz(c: Vec3) -> Vec3 {
    let y = (c.x + 16.0) / 116.0;
    rgb_from_xyz(Vec3::new(y + c.y / 500.0, y, y - c.z / 200.0) * WHITE)
}

/// L*a*b* whose chroma is scaled by lightness, as colours seem more vivid in more light
/// [Hunt 1952].
pub fn hunt_lab_from_rgb(rgb: Vec3) -> Vec3 {
    let c = xyz_from_rgb(rgb) / WHITE;
    let [x, y, z] = c.to_array().map(|t| {
        const DELTA: f32 = 6.0 / 29.0;
        if t > DELTA.powi(3) { lanes::cbrt(t) } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
    });
    let lightness = 116.0 * y - 16.0;
    Vec3::new(lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z))
}

/// The HyAB distance: city blocks in lightness, straight in chroma [Abasi 2020].
pub fn hyab(a: Vec3, b: Vec3) -> f32 {
    let d = (a - b).abs();
    d.x + lanes::hypot(d.y, d.z)
}

/// Relative luminance of linear sRGB.
pub fn luminance(rgb: Vec3) -> f32 {
    rgb.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_opponent_space_inverts() {
        for rgb in [Vec3::ZERO, Vec3::ONE, Vec3::new(0.2, 0.7, 0.1), Vec3::X, Vec3::Z] {
            assert!((rgb_from_ycxcz(ycxcz_from_rgb(rgb)) - rgb).length() < 1e-5);
        }
    }

    #[test]
    fn white_is_light_and_colourless() {
        let white = hunt_lab_from_rgb(Vec3::ONE);
        assert!((white - Vec3::new(100.0, 0.0, 0.0)).length() < 1e-3, "{white}");
    }
}
