//! Writing of pictures to files.

use std::borrow::Cow;
use std::path::Path;

use image::{Channel, Chromaticities, Format, Image, ImageError, ImageMetadata, PixelSource, WriteOptions};
use spectrum::{Matrix3, Rgb, RgbColorSpace};

/// Writes a picture in the format of the name's extension. EXR files keep all channels, the
/// picture's colour space and its header; other formats keep only the colours and cannot state
/// their colour space, so these are converted to sRGB.
pub fn write_picture(picture: &dyn PixelSource, path: impl AsRef<Path>) -> Result<(), ImageError> {
    let path = path.as_ref();
    let format = Format::from_name(&path.to_string_lossy());
    match color_space(picture.metadata().chromaticities).filter(|_| format != Some(Format::Exr)) {
        None => image::write(picture, path, &WriteOptions::default()),
        Some(space) => image::write(&InSrgb::new(picture, space), path, &WriteOptions::default()),
    }
}

/// A pixel source that converts colours to sRGB as rows are read.
struct InSrgb<'a> {
    picture: &'a dyn PixelSource,
    srgb_from_picture: Matrix3,
    metadata: ImageMetadata,
    /// Indices of the channels R, G and B.
    color: Option<[usize; 3]>,
}

impl<'a> InSrgb<'a> {
    fn new(picture: &'a dyn PixelSource, space: &RgbColorSpace) -> Self {
        let channels = picture.channels();
        let find = |name| channels.iter().position(|channel| channel.name == name);
        let color = match ["R", "G", "B"].map(find) {
            [Some(r), Some(g), Some(b)] => Some([r, g, b]),
            _ => None,
        };
        let metadata = ImageMetadata { chromaticities: None, ..picture.metadata().clone() };
        Self { picture, srgb_from_picture: space.convert(RgbColorSpace::srgb()), metadata, color }
    }
}

impl PixelSource for InSrgb<'_> {
    fn width(&self) -> u32 {
        self.picture.width()
    }

    fn height(&self) -> u32 {
        self.picture.height()
    }

    fn channels(&self) -> Vec<Channel> {
        self.picture.channels()
    }

    fn metadata(&self) -> &ImageMetadata {
        &self.metadata
    }

    fn row(&self, y: u32, values: &mut [f32]) {
        self.picture.row(y, values);
        let count = values.len() / self.width() as usize;
        if let Some(color) = self.color {
            for pixel in values.chunks_exact_mut(count) {
                let rgb = self.srgb_from_picture.apply_f32(color.map(|c| pixel[c]));
                (0..3).for_each(|i| pixel[color[i]] = rgb[i]);
            }
        }
    }
}

/// The colour space with these chromaticities, if it is known and not sRGB.
fn color_space(chromaticities: Option<Chromaticities>) -> Option<&'static RgbColorSpace> {
    let Chromaticities { red, green, blue, white } = chromaticities?;
    RgbColorSpace::from_chromaticities([red, green, blue], white)
        .filter(|&space| space != RgbColorSpace::srgb())
}

/// The picture converted to sRGB.
pub(crate) fn in_srgb(picture: &Image) -> Cow<'_, Image> {
    let Some(space) = color_space(picture.metadata.chromaticities) else { return Cow::Borrowed(picture) };
    let matrix = space.convert(RgbColorSpace::srgb());
    let mut converted = Image::from_fn(picture.width(), picture.height(), ["R", "G", "B"], |x, y| {
        Rgb::from(matrix.apply_f32(picture.rgb(x, y))).to_array()
    });
    converted.metadata = picture.metadata.clone();
    converted.metadata.chromaticities = None;
    Cow::Owned(converted)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_without_a_colour_space_get_srgb() {
        let folder = std::env::temp_dir().join(format!("alhazen-picture-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let wide = RgbColorSpace::rec2020();
        let grey_green = RgbColorSpace::srgb().convert(wide).apply_f32([0.2, 0.5, 0.3]);
        let mut picture = Image::from_fn(2, 1, ["R", "G", "B"], |_, _| grey_green);
        let [red, green, blue] = wide.primaries();
        picture.metadata.chromaticities = Some(Chromaticities { red, green, blue, white: wide.white() });
        for (name, expected, tolerance) in
            [("a.exr", grey_green, 1e-3), ("a.pfm", [0.2, 0.5, 0.3], 1e-4), ("a.png", [0.2, 0.5, 0.3], 1e-2)]
        {
            write_picture(&picture, folder.join(name)).unwrap();
            let read = image::open(folder.join(name)).unwrap().rgb(1, 0);
            assert!((0..3).all(|c| (read[c] - expected[c]).abs() < tolerance), "{name}: {read:?}");
        }
        std::fs::remove_dir_all(folder).unwrap();
    }
}
