//! Rasters, which the formats of integers have in common: a header with a size and a kind of
//! pixels, and samples side by side, which become the pixels of an [`Image`], or are made of those
//! of a picture.

use std::io;

use super::ReadOptions;
use crate::{
    encoding::ColorEncoding,
    error::ImageError,
    image::{Image, Pixels},
    memory::{collected, reserved},
    source::{PixelSource, alpha_channel, color_channels},
};

/// The size and the kind of pixels that the header of a file states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Header {
    /// Width and height.
    pub size: [u32; 2],
    /// How many channels the decoded picture has: grey or colours, and opacity.
    pub channels: usize,
    /// The bits of a sample.
    pub bits: u32,
}

impl Header {
    /// The number of samples of the picture; refused where they exceed what `options` allow for a
    /// file of `length` bytes, or have no memory.
    pub fn sample_count(&self, length: usize, options: &ReadOptions) -> Result<usize, ImageError> {
        const MAX_SIDE: u32 = 1 << 20;
        let [width, height] = self.size;
        if width == 0 || height == 0 {
            return invalid(format!("{width} × {height} pixels"));
        }
        if width.max(height) > MAX_SIDE {
            return Err(ImageError::Limits(format!("{width} × {height} pixels")));
        }
        let bytes = self.channels * self.bits.div_ceil(8) as usize;
        options.check_size(width as usize, height as usize, bytes, length)?;
        let pixels = width as usize * height as usize;
        // Some libraries abort where their own allocation fails, so that memory is tested first.
        drop(reserved::<u8>(pixels * bytes)?);
        Ok(pixels * self.channels)
    }
}

/// The names of this many channels.
pub fn channel_names(count: usize) -> &'static [&'static str] {
    match count {
        1 => &["Y"],
        2 => &["Y", "A"],
        3 => &["R", "G", "B"],
        _ => &["R", "G", "B", "A"],
    }
}

/// A picture as its file has it: rows from the top, the samples of a pixel side by side, which are
/// grey or red, green and blue, then opacity if there is any.
#[derive(Debug, PartialEq)]
pub struct Raster<T> {
    /// Width and height.
    pub size: [u32; 2],
    /// Samples of a pixel.
    pub channels: usize,
    /// All samples.
    pub samples: Vec<T>,
}

impl<T> Raster<T> {
    /// The rows from the top.
    pub fn rows(&self) -> std::slice::ChunksExact<'_, T> {
        self.samples.chunks_exact(self.size[0] as usize * self.channels)
    }

    /// Whether the last sample of a pixel is opacity.
    pub fn has_alpha(&self) -> bool {
        self.channels.is_multiple_of(2)
    }

    /// Width and height, where both are at most `most`.
    pub fn size_within(&self, most: u16) -> Result<[u16; 2], ImageError> {
        let [width, height] = self.size;
        match self.size.map(|side| u16::try_from(side).ok().filter(|side| *side <= most)) {
            [Some(width), Some(height)] => Ok([width, height]),
            _ => Err(ImageError::Limits(format!("{width} × {height} pixels, where {most} is the most"))),
        }
    }
}

impl Raster<u8> {
    /// The image of these codes.
    pub fn into_image(self, options: &ReadOptions) -> Result<Image, ImageError> {
        let [width, height] = self.size;
        let pixels = Pixels::U8(self.samples, options.encoding());
        Image::new(width, height, channel_names(self.channels).iter().copied(), pixels)
    }
}

impl Raster<u16> {
    /// The image of the linear values of these codes.
    pub fn into_image(self, options: &ReadOptions) -> Result<Image, ImageError> {
        let [width, height] = self.size;
        let (count, encoding) = (self.channels, options.encoding());
        let linear = |(index, &code): (usize, &u16)| {
            let code = f32::from(code) / 65535.0;
            let is_alpha = self.has_alpha() && index % count == count - 1;
            if is_alpha { code } else { encoding.to_linear(code) }
        };
        let pixels = Pixels::F32(collected(self.samples.len(), self.samples.iter().enumerate().map(linear))?);
        Image::new(width, height, channel_names(count).iter().copied(), pixels)
    }
}

/// Which of a picture's channels are written.
pub struct Layout {
    /// How many channels it has.
    channels: usize,
    /// Which of them are written, in this order.
    written: Vec<usize>,
    /// Which of them is alpha.
    alpha: Option<usize>,
}

impl Layout {
    /// The channels that a format keeps, which may have neither grey pixels nor opacity.
    pub fn new(picture: &dyn PixelSource, keeps_grey: bool, keeps_alpha: bool) -> Self {
        let channels = picture.channels();
        let color = color_channels(&channels);
        let alpha = alpha_channel(&channels).filter(|_| keeps_alpha);
        let count = if keeps_grey && color[0] == color[1] { 1 } else { 3 };
        let written = color[..count].iter().copied().chain(alpha).collect();
        Self { channels: channels.len(), written, alpha }
    }

    /// The picture in 8-bit codes of sRGB.
    pub fn codes(&self, picture: &dyn PixelSource) -> Result<Raster<u8>, ImageError> {
        self.collect(picture, |value, encoding| encoding.quantize(value))
    }

    /// The picture in 16-bit codes of sRGB.
    pub fn wide_codes(&self, picture: &dyn PixelSource) -> Result<Raster<u16>, ImageError> {
        self.collect(picture, |value, encoding| (encoding.from_linear(value) * 65535.0 + 0.5) as u16)
    }

    /// The picture in linear values.
    pub fn floats(&self, picture: &dyn PixelSource) -> Result<Raster<f32>, ImageError> {
        self.collect(picture, |value, _| value)
    }

    /// The written values, each made of a linear one and the encoding of its channel.
    fn collect<T>(
        &self,
        picture: &dyn PixelSource,
        convert: impl Fn(f32, ColorEncoding) -> T,
    ) -> Result<Raster<T>, ImageError> {
        let size = [picture.width(), picture.height()];
        let [width, height] = size.map(|side| side as usize);
        let mut samples = reserved(width * height * self.written.len())?;
        let mut row = vec![0.0; width * self.channels];
        for y in 0..picture.height() {
            picture.row(y, &mut row);
            for pixel in row.chunks_exact(self.channels) {
                samples.extend(self.written.iter().map(|&c| {
                    let linear = self.alpha == Some(c);
                    convert(pixel[c], if linear { ColorEncoding::Linear } else { ColorEncoding::Srgb })
                }));
            }
        }
        Ok(Raster { size, channels: self.written.len(), samples })
    }
}

/// The refusal of bytes that contradict their format.
pub fn invalid<T>(text: impl Into<String>) -> Result<T, ImageError> {
    Err(ImageError::Invalid(text.into()))
}

/// The error of a library whose input ended or failed.
pub fn from_io(error: io::Error) -> ImageError {
    if error.kind() == io::ErrorKind::UnexpectedEof {
        return ImageError::Invalid("the data ends early".into());
    }
    ImageError::Io(error)
}

/// The first `count` bytes, which are removed from `data`.
pub fn take<'a>(data: &mut &'a [u8], count: usize) -> Result<&'a [u8], ImageError> {
    let Some((taken, rest)) = data.split_at_checked(count) else { return invalid("the data ends early") };
    *data = rest;
    Ok(taken)
}

/// The number of `bits` at place `index` of a row of such numbers, the first in the high bits.
pub fn packed(row: &[u8], bits: usize, index: usize) -> u8 {
    let bit = index * bits;
    row[bit / 8] >> (8 - bits - bit % 8) & (0xff >> (8 - bits))
}

/// The nearest 8-bit code of one of 1 to 8 bits.
pub fn widened(code: u32, bits: u32) -> u8 {
    let most = (1 << bits) - 1;
    ((code * 255 + most / 2) / most) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_of_few_bits_are_read_from_the_high_ones_and_widened() {
        assert_eq!([0, 1, 2].map(|x| packed(&[0b1001_1100], 2, x)), [2, 1, 3]);
        assert_eq!([7, 8].map(|x| packed(&[1, 0x80], 1, x)), [1, 1]);
        assert_eq!(packed(&[1, 2], 8, 1), 2);
        for bits in 1..=8 {
            let most = (1_u32 << bits) - 1;
            for code in 0..=most {
                let exact = f64::from(code) * 255.0 / f64::from(most);
                assert_eq!(f64::from(widened(code, bits)), exact.round(), "{code} of {bits} bits");
            }
        }
    }

    #[test]
    fn sizes_that_no_file_holds_are_refused() {
        let options = ReadOptions::default();
        let count = |size, length| Header { size, channels: 3, bits: 8 }.sample_count(length, &options);
        assert_eq!(count([5, 4], 30).unwrap(), 60);
        assert!(matches!(count([0, 4], 30), Err(ImageError::Invalid(_))));
        for size in [[(1 << 20) + 1, 1], [1 << 16, 1 << 16]] {
            assert!(matches!(count(size, 30), Err(ImageError::Limits(_))));
        }
    }
}
