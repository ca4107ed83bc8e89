//! Portable float maps: a text header `PF` (RGB) or `Pf` (one channel), width, height and a scale
//! whose sign gives the byte order (negative: little endian), then rows of single floats from the
//! **bottom** up [Debevec, PFM format].

use std::io::{BufWriter, Write};

use super::{Format, Output, ReadOptions, WriteOptions};
use crate::{
    depth::SampleDepth,
    error::ImageError,
    image::{Image, Pixels},
    memory::reserved,
    source::{PixelSource, color_channels},
};

/// The values are multiplied by the scale's magnitude.
pub fn decode(bytes: &[u8], options: &ReadOptions) -> Result<Image, ImageError> {
    let mut header = Header { bytes, position: 0 };
    let channels: &[&str] = match header.word()? {
        "PF" => &["R", "G", "B"],
        "Pf" => &["Y"],
        other => return Err(ImageError::Unsupported(format!("PFM of kind {other:?}"))),
    };
    let width: u32 = header.number()?;
    let height: u32 = header.number()?;
    let scale: f32 = header.number()?;
    if scale == 0.0 || !scale.is_finite() {
        return Err(ImageError::Invalid(format!("PFM scale {scale}")));
    }
    options.check_size(width as usize, height as usize, 4 * channels.len(), bytes.len())?;
    let row = width as usize * channels.len();
    let data = &bytes[header.position..];
    if data.len() < 4 * row * height as usize {
        return Err(ImageError::Invalid("PFM data ends early".into()));
    }
    let magnitude = scale.abs();
    let from_bytes = if scale < 0.0 { f32::from_le_bytes } else { f32::from_be_bytes };
    let mut values = reserved(row * height as usize)?;
    for y in (0..height as usize).rev() {
        let (samples, _) = data[4 * row * y..4 * row * (y + 1)].as_chunks();
        values.extend(samples.iter().map(|&sample| magnitude * from_bytes(sample)));
    }
    Image::new(width, height, channels.iter().copied(), Pixels::F32(values))
}

/// Writes little-endian single floats: three channels where the picture has colour, else one.
pub fn encode(
    picture: &dyn PixelSource,
    options: &WriteOptions,
    output: &mut dyn Output,
) -> Result<(), ImageError> {
    options.depth_among(Format::Pfm, &[SampleDepth::F32])?;
    let channels = picture.channels();
    let color = color_channels(&channels);
    let (kind, count) = if color[0] != color[1] { ("PF", 3) } else { ("Pf", 1) };
    let mut output = BufWriter::new(output);
    write!(output, "{kind}\n{} {}\n-1.0\n", picture.width(), picture.height())?;
    let mut row = vec![0.0; picture.width() as usize * channels.len()];
    for y in (0..picture.height()).rev() {
        picture.row(y, &mut row);
        for pixel in row.chunks_exact(channels.len()) {
            for &c in &color[..count] {
                output.write_all(&pixel[c].to_le_bytes())?;
            }
        }
    }
    Ok(output.flush()?)
}

/// Words of the header; one white space ends each, and more may stand before it.
struct Header<'a> {
    bytes: &'a [u8],
    position: usize,
}

impl<'a> Header<'a> {
    fn word(&mut self) -> Result<&'a str, ImageError> {
        let rest = &self.bytes[self.position..];
        let start = rest.iter().position(|byte| !byte.is_ascii_whitespace());
        let word = start.and_then(|start| {
            let length = rest[start..].iter().take(32).position(u8::is_ascii_whitespace)?;
            self.position += start + length + 1;
            std::str::from_utf8(&rest[start..start + length]).ok()
        });
        word.ok_or_else(|| ImageError::Invalid("PFM header".into()))
    }

    fn number<T: std::str::FromStr>(&mut self) -> Result<T, ImageError> {
        let word = self.word()?;
        word.parse().map_err(|_| ImageError::Invalid(format!("PFM header: {word:?} is not a number")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_byte_orders_and_the_scale_are_read() {
        for (scale, encode) in [("-2", f32::to_le_bytes as fn(f32) -> [u8; 4]), ("2.0", f32::to_be_bytes)] {
            let mut bytes = format!("Pf\n1 2\n{scale}\n").into_bytes();
            bytes.extend([0.5f32, 3.0].map(encode).concat());
            let image = decode(&bytes, &ReadOptions::default()).unwrap();
            assert_eq!((image.channel(0, 0, 0), image.channel(0, 1, 0)), (6.0, 1.0));
        }
    }

    #[test]
    fn lies_are_refused() {
        for text in [
            "Pf\n1 2\n-1\nabcd",
            "PF\n100000 100000\n-1\n",
            "Pf\n1 1\n0\nabcd",
            "Pf\n1 -1\n1\n",
            "Pf",
            "PF4\n1 1 1\n",
        ] {
            assert!(decode(text.as_bytes(), &ReadOptions::default()).is_err(), "{text}");
        }
    }
}
