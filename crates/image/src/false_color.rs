//! Numbers as colours: the magma map from black through purple and orange to pale yellow, whose
//! lightness grows evenly; and for numbers with a sign a map from blue through black to orange,
//! which the colour-blind can also distinguish.

use crate::{
    encoding::{ColorEncoding, at_most},
    error::ImageError,
    image::{Image, Pixels},
};

static MAGMA: [[u8; 3]; 256] = include!("../data/magma.rs");

/// The sRGB codes of a value in [0, 1]; others are clamped, NaN is black.
pub fn magma(value: f32) -> [u8; 3] {
    MAGMA[(at_most(value, 1.0) * 255.0 + 0.5) as usize]
}

/// The sRGB codes of a value in [−1, 1]: 0 is black, negative values are blue, positive ones
/// orange; others are clamped, NaN is black.
pub fn diverging(value: f32) -> [u8; 3] {
    const BLUE: [f32; 3] = [110.0, 190.0, 255.0];
    const ORANGE: [f32; 3] = [255.0, 165.0, 70.0];
    let strength = at_most(value.abs(), 1.0);
    if value < 0.0 { BLUE } else { ORANGE }.map(|code| (code * strength + 0.5) as u8)
}

/// A picture of an image's first channel, in which `white` is the brightest colour.
pub fn false_color(image: &Image, white: f32) -> Result<Image, ImageError> {
    colored(image, |value| magma(value / white))
}

/// A picture of an image's first channel, whose values have a sign: those as large as `full` have
/// the full colour.
pub fn signed_false_color(image: &Image, full: f32) -> Result<Image, ImageError> {
    colored(image, |value| diverging(value / full))
}

fn colored(image: &Image, color: impl Fn(f32) -> [u8; 3]) -> Result<Image, ImageError> {
    let pixels = (0..image.height()).flat_map(|y| (0..image.width()).map(move |x| (x, y)));
    let codes = pixels.flat_map(|(x, y)| color(image.channel(x, y, 0))).collect();
    Image::new(image.width(), image.height(), ["R", "G", "B"], Pixels::U8(codes, ColorEncoding::Srgb))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lightness_grows_with_the_value() {
        let lightness = |value| magma(value).map(u32::from).iter().sum::<u32>();
        for step in 0..16 {
            assert!(lightness(step as f32 / 16.0) < lightness((step + 1) as f32 / 16.0));
        }
        assert_eq!(magma(-1.0), magma(0.0));
        assert_eq!(magma(f32::NAN), magma(0.0));
        assert_eq!(magma(9.0), [252, 253, 191]);
    }

    #[test]
    fn signs_have_colours_and_sizes_brightness() {
        assert_eq!([0.0, f32::NAN].map(diverging), [[0; 3]; 2]);
        assert_eq!([diverging(-7.0), diverging(7.0)], [diverging(-1.0), diverging(1.0)]);
        let [[red, _, blue], half] = [diverging(-1.0), diverging(-0.5)];
        assert!(blue > red && half[2] < blue && diverging(0.5)[0] > diverging(0.5)[2]);
    }

    #[test]
    fn the_picture_has_the_size_of_the_image() {
        let image = Image::from_fn(3, 2, ["Y"], |x, _| [x as f32]);
        let picture = false_color(&image, 2.0).unwrap();
        assert_eq!((picture.width(), picture.height(), picture.channel_count()), (3, 2, 3));
        assert!((picture.rgb(2, 1)[0] - ColorEncoding::Srgb.to_linear(252.0 / 255.0)).abs() < 1e-6);
    }
}
