//! The writer of TIFF: strips of rows, unpacked, then the directory that names them.

use std::io::{BufWriter, Write};

use tiff::TiffError;
use tiff::encoder::{Rational, TiffEncoder, TiffValue};
use tiff::tags::{CompressionMethod, ResolutionUnit, SampleFormat, Tag};

use super::{BLACK_IS_ZERO, RGB, STRAIGHT, from_library};
use crate::codec::raster::{Layout, Raster};
use crate::codec::{Format, Output, WriteOptions};
use crate::{depth::SampleDepth, error::ImageError, source::PixelSource};

/// Writes grey or colours, with opacity or without, of 8 or 16 bits or of single floats, unpacked.
pub fn encode(
    picture: &dyn PixelSource,
    options: &WriteOptions,
    output: &mut dyn Output,
) -> Result<(), ImageError> {
    use SampleDepth::{F32, U8, U16};
    let is_float = picture.channels()[0].depth != U8;
    let depths = if is_float { [F32, U8, U16] } else { [U8, U16, F32] };
    let depth = options.depth_among(Format::Tiff, &depths)?;
    let layout = Layout::new(picture, true, true);
    let mut output = BufWriter::new(output);
    match depth {
        U8 => write(&layout.codes(picture)?, SampleFormat::Uint, &mut output),
        U16 => write(&layout.wide_codes(picture)?, SampleFormat::Uint, &mut output),
        _ => write(&layout.floats(picture)?, SampleFormat::IEEEFP, &mut output),
    }
    .map_err(from_library)?;
    Ok(output.flush()?)
}

fn write<T>(
    raster: &Raster<T>,
    format: SampleFormat,
    output: &mut BufWriter<&mut dyn Output>,
) -> Result<(), TiffError>
where
    [T]: TiffValue,
{
    /// As many bytes as readers have memory for.
    const STRIP_LENGTH: usize = 1 << 20;
    let ([width, height], channels) = (raster.size, raster.channels);
    let row_length = width as usize * channels;
    let rows = (STRIP_LENGTH / (row_length * size_of::<T>())).clamp(1, height as usize);
    let mut encoder = TiffEncoder::new(output)?;
    let mut directory = encoder.image_directory()?;
    let (mut starts, mut lengths) = (Vec::new(), Vec::new());
    for strip in raster.samples.chunks(rows * row_length) {
        starts.push(u32::try_from(directory.write_data(strip)?)?);
        lengths.push(u32::try_from(size_of_val(strip))?);
    }
    directory.write_tag(Tag::ImageWidth, width)?;
    directory.write_tag(Tag::ImageLength, height)?;
    directory.write_tag(Tag::BitsPerSample, &*vec![8 * size_of::<T>() as u16; channels])?;
    directory.write_tag(Tag::Compression, CompressionMethod::None.to_u16())?;
    let photometric = if channels < 3 { BLACK_IS_ZERO.into() } else { RGB };
    directory.write_tag(Tag::PhotometricInterpretation, photometric)?;
    directory.write_tag(Tag::StripOffsets, &*starts)?;
    directory.write_tag(Tag::SamplesPerPixel, channels as u16)?;
    directory.write_tag(Tag::RowsPerStrip, rows as u32)?;
    directory.write_tag(Tag::StripByteCounts, &*lengths)?;
    directory.write_tag(Tag::XResolution, Rational { n: 1, d: 1 })?;
    directory.write_tag(Tag::YResolution, Rational { n: 1, d: 1 })?;
    directory.write_tag(Tag::ResolutionUnit, ResolutionUnit::None.to_u16())?;
    directory.write_tag(Tag::SampleFormat, &*vec![format.to_u16(); channels])?;
    if raster.has_alpha() {
        directory.write_tag(Tag::ExtraSamples, STRAIGHT)?;
    }
    directory.finish()
}
