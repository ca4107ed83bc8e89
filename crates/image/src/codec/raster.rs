//! PNG, JPEG, Radiance HDR, TGA, BMP, QOI and TIFF, by the `image` crate.

use std::io::Cursor;

use image_rs::{
    DynamicImage, ImageBuffer, ImageError as RasterError, ImageFormat, ImageReader, Limits, Luma, LumaA, Rgb,
    Rgba, codecs::jpeg::JpegEncoder,
};

use super::{Format, ReadOptions, SampleDepth, WriteOptions};
use crate::{
    encoding::ColorEncoding,
    error::ImageError,
    image::{Image, Pixels},
};

/// Of 100; at this one losses are hard to see.
const JPEG_QUALITY: u8 = 95;

/// 8-bit images stay so; 16-bit ones become linear single floats. Palettes are looked up.
pub fn decode(bytes: &[u8], format: Format, options: &ReadOptions) -> Result<Image, ImageError> {
    let mut reader = ImageReader::with_format(Cursor::new(bytes), library_format(format)?);
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(options.byte_limit(bytes.len()));
    limits.max_image_width = Some(1 << 20);
    limits.max_image_height = Some(1 << 20);
    reader.limits(limits);
    let decoded = reader.decode().map_err(from_library)?;
    if format == Format::Png {
        check_palette(bytes)?;
    }
    let (width, height) = (decoded.width(), decoded.height());
    let encoding = options.encoding();
    let codes = |values: Vec<u8>| Pixels::U8(values, encoding);
    let linear = |values: Vec<u16>, alpha_every: usize| {
        let value = |(index, code)| {
            let code = f32::from(code) / 65535.0;
            if index % alpha_every == alpha_every - 1 { code } else { encoding.to_linear(code) }
        };
        Pixels::F32(values.into_iter().enumerate().map(value).collect())
    };
    const Y: &[&str] = &["Y"];
    const YA: &[&str] = &["Y", "A"];
    const RGB: &[&str] = &["R", "G", "B"];
    const RGBA: &[&str] = &["R", "G", "B", "A"];
    let (channels, pixels) = match decoded {
        DynamicImage::ImageLuma8(buffer) => (Y, codes(buffer.into_raw())),
        DynamicImage::ImageLumaA8(buffer) => (YA, codes(buffer.into_raw())),
        DynamicImage::ImageRgb8(buffer) => (RGB, codes(buffer.into_raw())),
        DynamicImage::ImageRgba8(buffer) => (RGBA, codes(buffer.into_raw())),
        DynamicImage::ImageLuma16(buffer) => (Y, linear(buffer.into_raw(), usize::MAX)),
        DynamicImage::ImageLumaA16(buffer) => (YA, linear(buffer.into_raw(), 2)),
        DynamicImage::ImageRgb16(buffer) => (RGB, linear(buffer.into_raw(), usize::MAX)),
        DynamicImage::ImageRgba16(buffer) => (RGBA, linear(buffer.into_raw(), 4)),
        DynamicImage::ImageRgb32F(buffer) => (RGB, Pixels::F32(buffer.into_raw())),
        DynamicImage::ImageRgba32F(buffer) => (RGBA, Pixels::F32(buffer.into_raw())),
        _ => return Err(ImageError::Unsupported(format!("{format:?} of an unknown pixel layout"))),
    };
    Image::new(width, height, channels.iter().copied(), pixels)
}

/// Refuses a PNG whose pixels name colours that its palette does not have, which the library takes
/// for black.
fn check_palette(bytes: &[u8]) -> Result<(), ImageError> {
    let damaged = |error: png::DecodingError| ImageError::Invalid(error.to_string());
    let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().map_err(damaged)?;
    let info = reader.info();
    let (width, bits) = (info.width as usize, info.bit_depth as usize);
    let Some(palette) = info.palette.as_ref().filter(|_| info.color_type == png::ColorType::Indexed) else {
        return Ok(());
    };
    let color_count = palette.len() / 3;
    if color_count >= 1 << bits {
        return Ok(());
    }
    let size = reader.output_buffer_size().ok_or_else(|| ImageError::Limits("PNG".into()))?;
    let mut packed = vec![0; size];
    let frame = reader.next_frame(&mut packed).map_err(damaged)?;
    let index = |row: &[u8], x: usize| row[x * bits / 8] >> (8 - bits - x * bits % 8) & (0xff >> (8 - bits));
    let known = |row: &[u8]| (0..width).all(|x| usize::from(index(row, x)) < color_count);
    if packed[..frame.buffer_size()].chunks_exact(frame.line_size).all(known) {
        return Ok(());
    }
    Err(ImageError::Invalid(format!("a PNG pixel names a colour beyond the palette of {color_count}")))
}

/// Integer formats hold sRGB codes of the colour clamped to [0, 1]; alpha is kept where the format
/// has it.
pub fn encode(image: &Image, format: Format, options: &WriteOptions) -> Result<Vec<u8>, ImageError> {
    let depth = match (format, options.depth) {
        (Format::Hdr, SampleDepth::Natural) => SampleDepth::F32,
        (Format::Tiff, SampleDepth::Natural) if !matches!(image.pixels(), Pixels::U8(..)) => SampleDepth::F32,
        (_, SampleDepth::Natural) => SampleDepth::U8,
        (_, depth) => depth,
    };
    let allowed: &[SampleDepth] = match format {
        Format::Hdr => &[SampleDepth::F32],
        Format::Tiff => &[SampleDepth::U8, SampleDepth::U16, SampleDepth::F32],
        Format::Png => &[SampleDepth::U8, SampleDepth::U16],
        _ => &[SampleDepth::U8],
    };
    if !allowed.contains(&depth) {
        return Err(ImageError::Unsupported(format!("{format:?} does not hold samples of depth {depth:?}")));
    }
    let keeps_alpha = !matches!(format, Format::Hdr | Format::Jpeg);
    // Only some formats have grey images, and no float writer of the library does.
    let grey = !image.is_color() && depth != SampleDepth::F32 && !matches!(format, Format::Qoi);
    let alpha = image.alpha_index().filter(|_| keeps_alpha);
    let colored = if grey { 1 } else { 3 };
    let mut values = Vec::with_capacity(image.width() as usize * image.height() as usize * 4);
    for y in 0..image.height() {
        for x in 0..image.width() {
            values.extend_from_slice(&image.rgb(x, y)[..colored]);
            values.extend(alpha.map(|c| image.channel(x, y, c)));
        }
    }
    let buffer = dynamic(image.width(), image.height(), &values, colored, alpha.is_some(), depth)
        .ok_or_else(|| ImageError::Limits(format!("{} × {} pixels", image.width(), image.height())))?;
    let mut bytes = Cursor::new(Vec::new());
    match format {
        Format::Jpeg => buffer.write_with_encoder(JpegEncoder::new_with_quality(&mut bytes, JPEG_QUALITY)),
        _ => buffer.write_to(&mut bytes, library_format(format)?),
    }
    .map_err(from_library)?;
    Ok(bytes.into_inner())
}

/// The library's image of linear values, `colored` colour channels and perhaps alpha a pixel.
fn dynamic(
    width: u32,
    height: u32,
    values: &[f32],
    colored: usize,
    alpha: bool,
    depth: SampleDepth,
) -> Option<DynamicImage> {
    let count = colored + usize::from(alpha);
    let code = |index: usize| {
        let encoding = if index % count == colored { ColorEncoding::Linear } else { ColorEncoding::Srgb };
        encoding.from_linear(values[index])
    };
    let u8s = || (0..values.len()).map(|i| (code(i) * 255.0 + 0.5) as u8).collect::<Vec<_>>();
    let u16s = || (0..values.len()).map(|i| (code(i) * 65535.0 + 0.5) as u16).collect::<Vec<_>>();
    Some(match (depth, colored, alpha) {
        (SampleDepth::F32, _, false) => {
            ImageBuffer::<Rgb<f32>, _>::from_raw(width, height, values.to_vec())?.into()
        }
        (SampleDepth::F32, _, true) => {
            ImageBuffer::<Rgba<f32>, _>::from_raw(width, height, values.to_vec())?.into()
        }
        (SampleDepth::U16, 1, false) => ImageBuffer::<Luma<u16>, _>::from_raw(width, height, u16s())?.into(),
        (SampleDepth::U16, 1, true) => ImageBuffer::<LumaA<u16>, _>::from_raw(width, height, u16s())?.into(),
        (SampleDepth::U16, _, false) => ImageBuffer::<Rgb<u16>, _>::from_raw(width, height, u16s())?.into(),
        (SampleDepth::U16, _, true) => ImageBuffer::<Rgba<u16>, _>::from_raw(width, height, u16s())?.into(),
        (_, 1, false) => ImageBuffer::<Luma<u8>, _>::from_raw(width, height, u8s())?.into(),
        (_, 1, true) => ImageBuffer::<LumaA<u8>, _>::from_raw(width, height, u8s())?.into(),
        (_, _, false) => ImageBuffer::<Rgb<u8>, _>::from_raw(width, height, u8s())?.into(),
        (_, _, true) => ImageBuffer::<Rgba<u8>, _>::from_raw(width, height, u8s())?.into(),
    })
}

pub(super) fn library_format(format: Format) -> Result<ImageFormat, ImageError> {
    Ok(match format {
        Format::Png => ImageFormat::Png,
        Format::Jpeg => ImageFormat::Jpeg,
        Format::Hdr => ImageFormat::Hdr,
        Format::Tga => ImageFormat::Tga,
        Format::Bmp => ImageFormat::Bmp,
        Format::Qoi => ImageFormat::Qoi,
        Format::Tiff => ImageFormat::Tiff,
        Format::Exr | Format::Pfm => {
            return Err(ImageError::Unsupported(format!("{format:?} is not a raster format")));
        }
    })
}

pub(super) fn from_library(error: RasterError) -> ImageError {
    match error {
        RasterError::IoError(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => {
            ImageError::Invalid("the data ends early".into())
        }
        RasterError::IoError(error) => ImageError::Io(error),
        RasterError::Limits(error) => ImageError::Limits(error.to_string()),
        RasterError::Unsupported(error) => ImageError::Unsupported(error.to_string()),
        other => ImageError::Invalid(other.to_string()),
    }
}
