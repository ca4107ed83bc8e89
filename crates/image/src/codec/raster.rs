//! PNG, JPEG, TGA, BMP, QOI, WebP and TIFF, by the `image` crate, which also writes Radiance HDR.

use std::io::{BufWriter, Cursor, Seek, Write};

use image_rs::{
    DynamicImage, ImageBuffer, ImageDecoder, ImageError as RasterError, ImageFormat, ImageReader, Limits,
    Luma, LumaA, Rgb, Rgba, codecs::jpeg::JpegEncoder,
};

use super::{Format, ReadOptions, WriteOptions};
use crate::{
    depth::SampleDepth,
    encoding::ColorEncoding,
    error::ImageError,
    image::{Image, Pixels},
    memory::{collected, filled, reserved},
    metadata::{Attribute, ImageMetadata},
    source::{PixelSource, alpha_channel, color_channels},
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
    let decoder = reader.into_decoder().map_err(from_library)?;
    let ((width, height), color_type) = (decoder.dimensions(), decoder.color_type());
    let size = usize::try_from(decoder.total_bytes())
        .ok()
        .filter(|&size| size as u64 <= options.byte_limit(bytes.len()))
        .ok_or_else(|| ImageError::Limits(format!("{width} × {height} pixels")))?;
    let mut samples = reserved(size)?;
    // The library aborts where its own allocation fails, so that memory is tested first.
    drop(reserved::<u8>(size)?);
    samples.resize(size, 0);
    decoder.read_image(&mut samples).map_err(from_library)?;
    if format == Format::Png {
        check_palette(bytes)?;
    }
    let encoding = options.encoding();
    let count = usize::from(color_type.channel_count());
    let channels: &[&str] = match count {
        1 => &["Y"],
        2 => &["Y", "A"],
        3 => &["R", "G", "B"],
        _ => &["R", "G", "B", "A"],
    };
    let pixels = match usize::from(color_type.bytes_per_pixel()) / count {
        1 => Pixels::U8(samples, encoding),
        2 => {
            let linear = |(index, code): (usize, &[u8; 2])| {
                let code = f32::from(u16::from_ne_bytes(*code)) / 65535.0;
                let alpha = count % 2 == 0 && index % count == count - 1;
                if alpha { code } else { encoding.to_linear(code) }
            };
            Pixels::F32(collected(size / 2, samples.as_chunks().0.iter().enumerate().map(linear))?)
        }
        _ => {
            let values = samples.as_chunks().0.iter().map(|&bytes| f32::from_ne_bytes(bytes));
            Pixels::F32(collected(size / 4, values)?)
        }
    };
    Image::new(width, height, channels.iter().copied(), pixels)
}

/// Refuses a PNG whose pixels index colours beyond its palette, which the library reads as black.
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
    let mut packed = filled(size, 0)?;
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
pub fn encode(
    picture: &dyn PixelSource,
    format: Format,
    options: &WriteOptions,
    output: &mut (impl Write + Seek),
) -> Result<(), ImageError> {
    let channels = picture.channels();
    let depth = match (format, options.depth) {
        (Format::Hdr, SampleDepth::Natural) => SampleDepth::F32,
        (Format::Tiff, SampleDepth::Natural) if channels[0].depth != SampleDepth::U8 => SampleDepth::F32,
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
    let color = color_channels(&channels);
    // Only some formats have grey images, and no float writer of the library does.
    let grey =
        color[0] == color[1] && depth != SampleDepth::F32 && !matches!(format, Format::Qoi | Format::Webp);
    let alpha = alpha_channel(&channels).filter(|_| keeps_alpha);
    let written: Vec<usize> = color[..if grey { 1 } else { 3 }].iter().copied().chain(alpha).collect();
    let buffer = dynamic(picture, &Layout { channels: channels.len(), written, alpha }, depth)?;
    let mut output = BufWriter::new(output);
    match format {
        Format::Jpeg => buffer.write_with_encoder(JpegEncoder::new_with_quality(&mut output, JPEG_QUALITY)),
        Format::Png => return write_png(&buffer, picture, &mut output),
        _ => buffer.write_to(&mut output, library_format(format)?),
    }
    .map_err(from_library)?;
    Ok(output.flush()?)
}

/// Writes a PNG, with the name of its view as text if it has one.
fn write_png(
    buffer: &DynamicImage,
    picture: &dyn PixelSource,
    output: &mut impl Write,
) -> Result<(), ImageError> {
    let failed = |error: png::EncodingError| match error {
        png::EncodingError::IoError(error) => ImageError::Io(error),
        error => ImageError::Invalid(error.to_string()),
    };
    let color = buffer.color();
    let mut encoder = png::Encoder::new(&mut *output, buffer.width(), buffer.height());
    encoder.set_color(match color.channel_count() {
        1 => png::ColorType::Grayscale,
        2 => png::ColorType::GrayscaleAlpha,
        3 => png::ColorType::Rgb,
        _ => png::ColorType::Rgba,
    });
    encoder.set_compression(png::Compression::Fast);
    if let Some(Attribute::Text(view)) = picture.metadata().get(ImageMetadata::VIEW) {
        encoder.add_text_chunk("View".into(), view.clone()).map_err(failed)?;
    }
    let is_wide = color.bytes_per_pixel() > color.channel_count();
    encoder.set_depth(if is_wide { png::BitDepth::Sixteen } else { png::BitDepth::Eight });
    let mut writer = encoder.write_header().map_err(failed)?;
    if is_wide {
        // Of big-endian numbers.
        let codes = buffer.as_bytes().as_chunks().0.iter().map(|&code| u16::from_ne_bytes(code));
        let bytes = collected(buffer.as_bytes().len(), codes.flat_map(u16::to_be_bytes))?;
        writer.write_image_data(&bytes).map_err(failed)?;
    } else {
        writer.write_image_data(buffer.as_bytes()).map_err(failed)?;
    }
    writer.finish().map_err(failed)?;
    Ok(output.flush()?)
}

/// Which of a picture's channels are written.
struct Layout {
    /// How many channels it has.
    channels: usize,
    /// Which of them are written, in this order.
    written: Vec<usize>,
    /// Which of them is alpha.
    alpha: Option<usize>,
}

impl Layout {
    /// The written values, each made of a linear one and the encoding of its channel.
    fn collect<T>(
        &self,
        picture: &dyn PixelSource,
        convert: impl Fn(f32, ColorEncoding) -> T,
    ) -> Result<Vec<T>, ImageError> {
        let (width, height) = (picture.width() as usize, picture.height() as usize);
        let mut values = reserved(width * height * self.written.len())?;
        let mut row = vec![0.0; width * self.channels];
        for y in 0..picture.height() {
            picture.row(y, &mut row);
            for pixel in row.chunks_exact(self.channels) {
                values.extend(self.written.iter().map(|&c| {
                    let linear = self.alpha == Some(c);
                    convert(pixel[c], if linear { ColorEncoding::Linear } else { ColorEncoding::Srgb })
                }));
            }
        }
        Ok(values)
    }
}

/// The library's image of a picture.
fn dynamic(
    picture: &dyn PixelSource,
    layout: &Layout,
    depth: SampleDepth,
) -> Result<DynamicImage, ImageError> {
    let (width, height) = (picture.width(), picture.height());
    let u8s = || layout.collect(picture, |v, encoding| (encoding.from_linear(v) * 255.0 + 0.5) as u8);
    let u16s = || layout.collect(picture, |v, encoding| (encoding.from_linear(v) * 65535.0 + 0.5) as u16);
    let floats = || layout.collect(picture, |v, _| v);
    let image: Option<DynamicImage> = match (depth, layout.written.len(), layout.alpha.is_some()) {
        (SampleDepth::F32, _, false) => {
            ImageBuffer::<Rgb<f32>, _>::from_raw(width, height, floats()?).map(Into::into)
        }
        (SampleDepth::F32, _, true) => {
            ImageBuffer::<Rgba<f32>, _>::from_raw(width, height, floats()?).map(Into::into)
        }
        (SampleDepth::U16, 1, _) => {
            ImageBuffer::<Luma<u16>, _>::from_raw(width, height, u16s()?).map(Into::into)
        }
        (SampleDepth::U16, 2, _) => {
            ImageBuffer::<LumaA<u16>, _>::from_raw(width, height, u16s()?).map(Into::into)
        }
        (SampleDepth::U16, 3, _) => {
            ImageBuffer::<Rgb<u16>, _>::from_raw(width, height, u16s()?).map(Into::into)
        }
        (SampleDepth::U16, ..) => {
            ImageBuffer::<Rgba<u16>, _>::from_raw(width, height, u16s()?).map(Into::into)
        }
        (_, 1, _) => ImageBuffer::<Luma<u8>, _>::from_raw(width, height, u8s()?).map(Into::into),
        (_, 2, _) => ImageBuffer::<LumaA<u8>, _>::from_raw(width, height, u8s()?).map(Into::into),
        (_, 3, _) => ImageBuffer::<Rgb<u8>, _>::from_raw(width, height, u8s()?).map(Into::into),
        _ => ImageBuffer::<Rgba<u8>, _>::from_raw(width, height, u8s()?).map(Into::into),
    };
    image.ok_or_else(|| ImageError::Limits(format!("{width} × {height} pixels")))
}

pub(super) fn library_format(format: Format) -> Result<ImageFormat, ImageError> {
    Ok(match format {
        Format::Png => ImageFormat::Png,
        Format::Jpeg => ImageFormat::Jpeg,
        Format::Hdr => ImageFormat::Hdr,
        Format::Tga => ImageFormat::Tga,
        Format::Bmp => ImageFormat::Bmp,
        Format::Qoi => ImageFormat::Qoi,
        Format::Webp => ImageFormat::WebP,
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
