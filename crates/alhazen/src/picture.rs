//! Writing of pictures to files.

use std::borrow::Cow;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::{
    Attribute, Channel, Chromaticities, Display, DisplaySettings, Format, Image, ImageError, ImageMetadata,
    PixelSource, WriteOptions, encode,
};
use spectrum::{Matrix3, Rgb, RgbColorSpace};

/// Writes a picture in the format of the name's extension. EXR files keep all channels, the
/// picture's colour space and its header. Other formats keep only the colours and cannot state
/// their colour space, so these are converted to sRGB. Formats of codes for a display get what
/// `display` says; others stay linear.
pub fn write_picture(
    picture: &dyn PixelSource,
    path: impl AsRef<Path>,
    display: &DisplaySettings,
) -> Result<(), ImageError> {
    let path = path.as_ref();
    let write = |picture: &dyn PixelSource| image::write(picture, path, &WriteOptions::default());
    match Format::from_name(&path.to_string_lossy()) {
        Some(format) if format != Format::Exr => write(&InSrgb::new(picture, format, display)),
        _ => write(picture),
    }
}

/// A picture as a PNG in sRGB, in a data URI.
pub fn data_uri(picture: &Image) -> String {
    let png = encode(&*in_srgb(picture), Format::Png, &WriteOptions::default());
    let png = png.expect("invariant: PNG takes any picture");
    format!("data:image/png;base64,{}", STANDARD.encode(png))
}

/// A pixel source that converts colours to sRGB, and for formats of codes to what a display shows,
/// as rows are read.
pub struct InSrgb<'a> {
    picture: &'a dyn PixelSource,
    conversion: Conversion,
    metadata: ImageMetadata,
    /// Indices of the channels R, G and B.
    color: Option<[usize; 3]>,
}

/// What becomes of colours.
enum Conversion {
    /// They stay as they are.
    None,
    /// Linear colours of sRGB.
    Srgb(Matrix3),
    /// What a display shows.
    Display(Box<Display>),
}

impl<'a> InSrgb<'a> {
    /// For a file of this format.
    pub fn new(picture: &'a dyn PixelSource, format: Format, display: &DisplaySettings) -> Self {
        let channels = picture.channels();
        let find = |name| channels.iter().position(|channel| channel.name == name);
        let color = match ["R", "G", "B"].map(find) {
            [Some(r), Some(g), Some(b)] => Some([r, g, b]),
            _ => None,
        };
        let mut metadata = picture.metadata().clone();
        let space = color_space(metadata.chromaticities.take());
        if format.is_for_display() {
            metadata.set(ImageMetadata::VIEW, Attribute::Text(display.view.name().to_owned()));
        }
        let conversion = match (format.is_for_display() && *display != DisplaySettings::default(), space) {
            (true, space) => {
                Conversion::Display(Box::new(Display::new(display, space.unwrap_or(RgbColorSpace::srgb()))))
            }
            (false, Some(space)) => Conversion::Srgb(space.convert(RgbColorSpace::srgb())),
            (false, None) => Conversion::None,
        };
        Self { picture, conversion, metadata, color }
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
        let Some(color) = self.color else { return };
        for pixel in values.chunks_exact_mut(count) {
            let rgb = color.map(|c| pixel[c]);
            let shown = match &self.conversion {
                Conversion::None => rgb,
                Conversion::Srgb(matrix) => matrix.apply_f32(rgb),
                Conversion::Display(display) => display.show(rgb),
            };
            (0..3).for_each(|i| pixel[color[i]] = shown[i]);
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
fn in_srgb(picture: &Image) -> Cow<'_, Image> {
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
            write_picture(&picture, folder.join(name), &DisplaySettings::default()).unwrap();
            let read = image::open(folder.join(name)).unwrap().rgb(1, 0);
            assert!((0..3).all(|c| (read[c] - expected[c]).abs() < tolerance), "{name}: {read:?}");
        }
        // A view acts on formats of codes only, and they name it.
        let view = image::DisplayView::KhronosNeutral;
        let settings = DisplaySettings { view, exposure: 1.0, white: None };
        for (name, expected, tolerance) in
            [("b.pfm", [0.2, 0.5, 0.3], 1e-4), ("b.png", [0.3332, 0.8691, 0.5118], 5e-3)]
        {
            write_picture(&picture, folder.join(name), &settings).unwrap();
            let read = image::open(folder.join(name)).unwrap().rgb(1, 0);
            assert!((0..3).all(|c| (read[c] - expected[c]).abs() < tolerance), "{name}: {read:?}");
        }
        let bytes = std::fs::read(folder.join("b.png")).unwrap();
        let text = b"tEXtView\0khronos-neutral";
        assert!(bytes.windows(text.len()).any(|window| window == text));
        std::fs::remove_dir_all(folder).unwrap();
    }
}
