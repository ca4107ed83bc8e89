//! PNG, by the crate `png`: grey and coloured pictures of 1 to 16 bits, and palettes, whose colours
//! are looked up; a transparent colour becomes opacity [ISO/IEC 15948].

use std::io::{BufWriter, Cursor, Write};

use png::{BitDepth, ColorType, Compression, Decoder, DecodingError, EncodingError, Limits, Transformations};

use super::{
    Format, Output, ReadOptions, WriteOptions,
    raster::{Header, Layout, Raster, from_io, invalid, packed},
};
use crate::{
    depth::SampleDepth,
    error::ImageError,
    image::Image,
    memory::{collected, filled, reserved},
    metadata::{Attribute, ImageMetadata},
    source::PixelSource,
};

type Reader<'a> = png::Reader<Cursor<&'a [u8]>>;

/// Size, channels and depth of the decoded picture.
pub fn header(bytes: &[u8]) -> Result<Header, ImageError> {
    Ok(header_of(&open(bytes, &ReadOptions::default())?))
}

/// 8-bit pictures stay so, and those of fewer bits become such; those of 16 bits become linear
/// single floats.
pub fn decode(bytes: &[u8], options: &ReadOptions) -> Result<Image, ImageError> {
    let mut reader = open(bytes, options)?;
    let Header { size, channels, bits } = header_of(&reader);
    let count = header_of(&reader).sample_count(bytes.len(), options)?;
    let frame_size = reader.output_buffer_size().ok_or_else(too_large)?;
    let mut frame = filled(frame_size, 0)?;
    reader.next_frame(&mut frame).map_err(from_library)?;
    if reader.info().color_type == ColorType::Indexed {
        let samples = looked_up(&frame, &reader, count)?;
        return Raster { size, channels, samples }.into_image(options);
    }
    if bits == 16 {
        let samples = frame.as_chunks().0.iter().map(|&code| u16::from_be_bytes(code));
        return Raster { size, channels, samples: collected(count, samples)? }.into_image(options);
    }
    Raster { size, channels, samples: frame }.into_image(options)
}

fn open<'a>(bytes: &'a [u8], options: &ReadOptions) -> Result<Reader<'a>, ImageError> {
    let most = usize::try_from(options.byte_limit(bytes.len())).unwrap_or(usize::MAX);
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: most });
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    // The library looks colours up, too, but takes indices beyond the palette for black.
    let is_indexed = decoder.read_header_info().map_err(from_library)?.color_type == ColorType::Indexed;
    decoder.set_transformations(if is_indexed { Transformations::IDENTITY } else { Transformations::EXPAND });
    decoder.read_info().map_err(from_library)
}

fn header_of(reader: &Reader) -> Header {
    let info = reader.info();
    let (color, depth) = reader.output_color_type();
    let channels = match color {
        ColorType::Indexed => 3 + usize::from(info.trns.is_some()),
        color => color.samples(),
    };
    Header { size: [info.width, info.height], channels, bits: (depth as u32).max(8) }
}

/// The colours of a picture of indices, with their opacity where the palette has it.
fn looked_up(frame: &[u8], reader: &Reader, count: usize) -> Result<Vec<u8>, ImageError> {
    let info = reader.info();
    let Some(palette) = &info.palette else { return invalid("a PNG without its palette") };
    let (palette, _) = palette.as_chunks::<3>();
    let opacities = info.trns.as_deref().filter(|opacities| opacities.len() <= palette.len());
    let (width, bits) = (info.width as usize, info.bit_depth as usize);
    let mut samples = reserved(count)?;
    for row in frame.chunks_exact((width * bits).div_ceil(8)) {
        for x in 0..width {
            let index = usize::from(packed(row, bits, x));
            let Some(color) = palette.get(index) else {
                let text = format!("a PNG pixel names a colour beyond the palette of {}", palette.len());
                return invalid(text);
            };
            samples.extend(color);
            if info.trns.is_some() {
                samples.push(opacities.and_then(|all| all.get(index)).copied().unwrap_or(u8::MAX));
            }
        }
    }
    Ok(samples)
}

fn too_large() -> ImageError {
    ImageError::Limits("PNG".into())
}

fn from_library(error: DecodingError) -> ImageError {
    match error {
        DecodingError::IoError(error) => from_io(error),
        DecodingError::LimitsExceeded => too_large(),
        error => ImageError::Invalid(format!("PNG: {error}")),
    }
}

/// Writes 8 or 16 bits, and the name of the picture's view as text if it has one.
pub fn encode(
    picture: &dyn PixelSource,
    options: &WriteOptions,
    output: &mut dyn Output,
) -> Result<(), ImageError> {
    let depth = options.depth_among(Format::Png, &[SampleDepth::U8, SampleDepth::U16])?;
    let layout = Layout::new(picture, true, true);
    let (raster, depth) = if depth == SampleDepth::U16 {
        let Raster { size, channels, samples } = layout.wide_codes(picture)?;
        let bytes = collected(2 * samples.len(), samples.into_iter().flat_map(u16::to_be_bytes))?;
        (Raster { size, channels, samples: bytes }, BitDepth::Sixteen)
    } else {
        (layout.codes(picture)?, BitDepth::Eight)
    };
    let mut output = BufWriter::new(output);
    write(&raster, depth, picture.metadata(), &mut output).map_err(|error| match error {
        EncodingError::IoError(error) => ImageError::Io(error),
        error => ImageError::Invalid(format!("PNG: {error}")),
    })?;
    Ok(output.flush()?)
}

fn write(
    raster: &Raster<u8>,
    depth: BitDepth,
    metadata: &ImageMetadata,
    output: &mut dyn Write,
) -> Result<(), EncodingError> {
    let [width, height] = raster.size;
    let mut encoder = png::Encoder::new(output, width, height);
    encoder.set_color(match raster.channels {
        1 => ColorType::Grayscale,
        2 => ColorType::GrayscaleAlpha,
        3 => ColorType::Rgb,
        _ => ColorType::Rgba,
    });
    encoder.set_depth(depth);
    encoder.set_compression(Compression::Fast);
    if let Some(Attribute::Text(view)) = metadata.get(ImageMetadata::VIEW) {
        encoder.add_text_chunk("View".into(), view.clone())?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&raster.samples)?;
    writer.finish()
}
