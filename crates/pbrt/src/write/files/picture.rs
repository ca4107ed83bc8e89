//! Images of textures and lights: 8-bit codes as PNG, floats as OpenEXR.

use image::{ColorEncoding, Format, Image, ImageError, ImageMetadata, Pixels, WriteOptions, encode};

/// The channels of PNG files.
const CHANNELS: [&[&str]; 4] = [&["Y"], &["Y", "A"], &["R", "G", "B"], &["R", "G", "B", "A"]];

/// Whether the image has 8-bit codes that a file with this encoding can keep as they are.
pub(super) fn keeps_codes(image: &Image, encoding: ColorEncoding) -> bool {
    let has_usual_channels = CHANNELS.iter().any(|channels| image.channels() == *channels);
    let is_plain = image.metadata == ImageMetadata::default();
    has_usual_channels && is_plain && matches!(image.pixels(), Pixels::U8(_, own) if *own == encoding)
}

/// The bytes of a PNG file with the image's codes, or of an OpenEXR file with its values.
pub(super) fn bytes(image: &Image, as_codes: bool) -> Result<Vec<u8>, ImageError> {
    let options = WriteOptions::default();
    match image.pixels() {
        // Codes are written as they are where they are said to be in the file's own encoding.
        Pixels::U8(codes, _) if as_codes => {
            let pixels = Pixels::U8(codes.clone(), ColorEncoding::Srgb);
            let image = Image::new(image.width(), image.height(), image.channels(), pixels)?;
            encode(&image, Format::Png, &options)
        }
        // OpenEXR orders channels by name, so that opacity would become the first one.
        _ if image.channels() == CHANNELS[1] => encode(&with_colors(image), Format::Exr, &options),
        Pixels::U8(..) => encode(&image.to_f32(), Format::Exr, &options),
        Pixels::F16(_) | Pixels::F32(_) => encode(image, Format::Exr, &options),
    }
}

/// A grey image with opacity as one of red, green, blue and opacity.
fn with_colors(image: &Image) -> Image {
    let mut colored = Image::from_fn(image.width(), image.height(), ["R", "G", "B", "A"], |x, y| {
        let [grey, opacity] = [0, 1].map(|c| image.channel(x, y, c));
        [grey, grey, grey, opacity]
    });
    colored.metadata = image.metadata.clone();
    colored
}
