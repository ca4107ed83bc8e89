//! The writer of TIFF: strips of rows, unpacked, then the directory that names them.

use std::io::{Seek, Write};

use tiff::TiffError;
use tiff::encoder::{Rational, TiffEncoder, TiffValue};
use tiff::tags::{CompressionMethod, ResolutionUnit, SampleFormat, Tag};

use super::{BLACK_IS_ZERO, RGB, STRAIGHT};
use crate::codec::raster::Raster;

/// Writes a picture of samples of this kind.
pub fn write<T>(raster: &Raster<T>, format: SampleFormat, output: impl Write + Seek) -> Result<(), TiffError>
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
