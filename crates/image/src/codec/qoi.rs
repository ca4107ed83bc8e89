//! Quite OK Image, by the crate `qoi`: 8-bit colours, with opacity or without [The Quite OK Image
//! Format, specification 1.0].

use std::io::{BufWriter, Write};

use qoi::{Decoder, Encoder, Error};

use super::{
    Format, Output, ReadOptions, WriteOptions,
    raster::{Header, Layout, Raster, from_io},
};
use crate::{depth::SampleDepth, error::ImageError, image::Image, memory::filled, source::PixelSource};

/// Size and channels.
pub fn header(bytes: &[u8]) -> Result<Header, ImageError> {
    let header = qoi::decode_header(bytes).map_err(from_library)?;
    Ok(Header { size: [header.width, header.height], channels: header.channels.as_u8().into(), bits: 8 })
}

/// 8-bit codes.
pub fn decode(bytes: &[u8], options: &ReadOptions) -> Result<Image, ImageError> {
    let header = header(bytes)?;
    let mut samples = filled(header.sample_count(bytes.len(), options)?, 0)?;
    let mut decoder = Decoder::new(bytes).map_err(from_library)?;
    decoder.decode_to_buf(&mut samples).map_err(from_library)?;
    Raster { size: header.size, channels: header.channels, samples }.into_image(options)
}

/// Writes 8-bit colours.
pub fn encode(
    picture: &dyn PixelSource,
    options: &WriteOptions,
    output: &mut dyn Output,
) -> Result<(), ImageError> {
    options.depth_among(Format::Qoi, &[SampleDepth::U8])?;
    let raster = Layout::new(picture, false, true).codes(picture)?;
    let encoder = Encoder::new(&raster.samples, raster.size[0], raster.size[1]).map_err(from_library)?;
    let mut output = BufWriter::new(output);
    encoder.encode_to_stream(&mut output).map_err(from_library)?;
    Ok(output.flush()?)
}

fn from_library(error: Error) -> ImageError {
    match error {
        Error::IoError(error) => from_io(error),
        Error::UnexpectedBufferEnd => ImageError::Invalid("the data ends early".into()),
        error => ImageError::Invalid(format!("QOI: {error}")),
    }
}
