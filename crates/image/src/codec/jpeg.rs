//! JPEG, read by the crate `zune-jpeg`: grey and coloured pictures, baseline and progressive, and
//! those of inks, which become red, green and blue; written by `jpeg-encoder` [ITU-T T.81].

use std::io::{BufWriter, Write};

use jpeg_encoder::{Encoder, EncodingError, ImageBuffer, JpegColorType, SamplingFactor, rgb_to_ycbcr};
use zune_jpeg::{
    JpegDecoder,
    errors::DecodeErrors,
    zune_core::{bytestream::ZCursor, colorspace::ColorSpace, options::DecoderOptions},
};

use super::{
    Format, Output, ReadOptions, WriteOptions,
    raster::{Header, Layout, Raster},
};
use crate::{depth::SampleDepth, error::ImageError, image::Image, memory::filled, source::PixelSource};

/// Of 100; at this one losses are hard to see.
const QUALITY: u8 = 95;

/// Size and channels.
pub fn header(bytes: &[u8]) -> Result<Header, ImageError> {
    Ok(open(bytes)?.0)
}

/// 8-bit codes.
pub fn decode(bytes: &[u8], options: &ReadOptions) -> Result<Image, ImageError> {
    let (header, colors) = open(bytes)?;
    let mut samples = filled(header.sample_count(bytes.len(), options)?, 0)?;
    decoder(bytes, colors).decode_into(&mut samples).map_err(from_library)?;
    Raster { size: header.size, channels: header.channels, samples }.into_image(options)
}

/// The header, and the colours in which the picture is decoded.
fn open(bytes: &[u8]) -> Result<(Header, ColorSpace), ImageError> {
    let mut decoder = decoder(bytes, ColorSpace::RGB);
    decoder.decode_headers().map_err(from_library)?;
    let found = decoder.dimensions().zip(decoder.input_colorspace());
    let ((width, height), colors) = found.ok_or_else(|| ImageError::Invalid("a JPEG without size".into()))?;
    let colors = if colors == ColorSpace::Luma { colors } else { ColorSpace::RGB };
    let header = Header { size: [width as u32, height as u32], channels: colors.num_components(), bits: 8 };
    Ok((header, colors))
}

fn decoder(bytes: &[u8], colors: ColorSpace) -> JpegDecoder<ZCursor<&[u8]>> {
    let options = DecoderOptions::default()
        .jpeg_set_out_colorspace(colors)
        .set_strict_mode(false)
        .set_max_width(usize::from(u16::MAX))
        .set_max_height(usize::from(u16::MAX));
    JpegDecoder::new_with_options(ZCursor::new(bytes), options)
}

fn from_library(error: DecodeErrors) -> ImageError {
    match error {
        DecodeErrors::Unsupported(kind) => ImageError::Unsupported(format!("a JPEG of kind {kind:?}")),
        DecodeErrors::ExhaustedData | DecodeErrors::IoErrors(_) => {
            ImageError::Invalid("the data ends early".into())
        }
        DecodeErrors::LargeDimensions(side) => ImageError::Limits(format!("a side of {side} pixels")),
        error => ImageError::Invalid(format!("JPEG: {error:?}")),
    }
}

/// Writes grey or colours of 8 bits, without subsampling.
pub fn encode(
    picture: &dyn PixelSource,
    options: &WriteOptions,
    output: &mut dyn Output,
) -> Result<(), ImageError> {
    options.depth_among(Format::Jpeg, &[SampleDepth::U8])?;
    let raster = Layout::new(picture, true, false).codes(picture)?;
    let size = raster.size_within(u16::MAX)?;
    let mut output = BufWriter::new(output);
    let mut encoder = Encoder::new(&mut output as &mut dyn Write, QUALITY);
    encoder.set_sampling_factor(SamplingFactor::F_1_1);
    encoder.encode_image(Source { raster: &raster, size }).map_err(|error| match error {
        EncodingError::IoError(error) => ImageError::Io(error),
        error => ImageError::Invalid(format!("JPEG: {error}")),
    })?;
    Ok(output.flush()?)
}

struct Source<'a> {
    raster: &'a Raster<u8>,
    size: [u16; 2],
}

impl ImageBuffer for Source<'_> {
    fn get_jpeg_color_type(&self) -> JpegColorType {
        if self.raster.channels == 1 { JpegColorType::Luma } else { JpegColorType::Ycbcr }
    }

    fn width(&self) -> u16 {
        self.size[0]
    }

    fn height(&self) -> u16 {
        self.size[1]
    }

    fn fill_buffers(&self, y: u16, buffers: &mut [Vec<u8>; 4]) {
        let length = usize::from(self.size[0]) * self.raster.channels;
        let row = &self.raster.samples[usize::from(y) * length..][..length];
        if self.raster.channels == 1 {
            buffers[0].extend(row);
            return;
        }
        for &[r, g, b] in row.as_chunks().0 {
            let (brightness, blue, red) = rgb_to_ycbcr(r, g, b);
            buffers[0].push(brightness);
            buffers[1].push(blue);
            buffers[2].push(red);
        }
    }
}
