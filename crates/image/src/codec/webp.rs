//! WebP, by the crate `image-webp`: read lossy or not, of animations the first picture; written
//! lossless [WebP Container Specification].

use std::io::{BufWriter, Cursor, Write};

use image_webp::{ColorType, DecodingError, EncodingError, WebPDecoder, WebPEncoder};

use super::{
    Format, Output, ReadOptions, WriteOptions,
    raster::{Header, Layout, Raster, from_io},
};
use crate::{depth::SampleDepth, error::ImageError, image::Image, memory::filled, source::PixelSource};

/// Size and channels.
pub fn header(bytes: &[u8]) -> Result<Header, ImageError> {
    Ok(header_of(&WebPDecoder::new(Cursor::new(bytes)).map_err(from_library)?))
}

/// 8-bit codes.
pub fn decode(bytes: &[u8], options: &ReadOptions) -> Result<Image, ImageError> {
    let mut decoder = WebPDecoder::new(Cursor::new(bytes)).map_err(from_library)?;
    decoder.set_memory_limit(usize::try_from(options.byte_limit(bytes.len())).unwrap_or(usize::MAX));
    let header = header_of(&decoder);
    let mut samples = filled(header.sample_count(bytes.len(), options)?, 0)?;
    decoder.read_image(&mut samples).map_err(from_library)?;
    Raster { size: header.size, channels: header.channels, samples }.into_image(options)
}

fn header_of(decoder: &WebPDecoder<Cursor<&[u8]>>) -> Header {
    let (width, height) = decoder.dimensions();
    Header { size: [width, height], channels: 3 + usize::from(decoder.has_alpha()), bits: 8 }
}

fn from_library(error: DecodingError) -> ImageError {
    match error {
        DecodingError::IoError(error) => from_io(error),
        DecodingError::MemoryLimitExceeded => ImageError::Limits("WebP".into()),
        DecodingError::UnsupportedFeature(text) => ImageError::Unsupported(text),
        error => ImageError::Invalid(format!("WebP: {error}")),
    }
}

/// Writes 8-bit colours.
pub fn encode(
    picture: &dyn PixelSource,
    options: &WriteOptions,
    output: &mut dyn Output,
) -> Result<(), ImageError> {
    options.depth_among(Format::Webp, &[SampleDepth::U8])?;
    let raster = Layout::new(picture, false, true).codes(picture)?;
    let [width, height] = raster.size_within(1 << 14)?.map(u32::from);
    let color = if raster.has_alpha() { ColorType::Rgba8 } else { ColorType::Rgb8 };
    let mut output = BufWriter::new(output);
    let encoder = WebPEncoder::new(&mut output as &mut dyn Write);
    encoder.encode(&raster.samples, width, height, color).map_err(|error| match error {
        EncodingError::IoError(error) => ImageError::Io(error),
        error => ImageError::Invalid(format!("WebP: {error}")),
    })?;
    Ok(output.flush()?)
}
