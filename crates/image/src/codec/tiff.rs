//! TIFF by the crate `tiff`: grey and coloured pictures with and without opacity, palettes, and
//! inks (CMYK), of integers and of floats. Colours that are stored multiplied by their opacity
//! (associated alpha) are divided by it, as those of other formats are not.

mod strips;

use std::borrow::Cow;
use std::io::{BufWriter, Cursor, Write};

use half::f16;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::{SampleFormat, Tag};
use tiff::{ColorType, TiffError};

use super::raster::{Layout, channel_names, from_io, invalid, packed, widened};
use super::{Format, Output, ReadOptions, WriteOptions};
use crate::{
    depth::SampleDepth,
    encoding::ColorEncoding,
    error::ImageError,
    image::{Image, Pixels},
    memory::{collected, reserved},
    source::PixelSource,
};

const PALETTE: u16 = 3;
const BLACK_IS_ZERO: u8 = 1;
const RGB: u16 = 2;
const ASSOCIATED: u16 = 1;
const STRAIGHT: u16 = 2;

/// The layout of a file, before its pixels are decoded.
pub struct Tiff<'a> {
    decoder: Decoder<Cursor<Cow<'a, [u8]>>>,
    /// The length of the file.
    length: usize,
    size: [u32; 2],
    bits: u8,
    /// How many samples a pixel has, and which of them are read.
    samples: usize,
    read: Vec<usize>,
    alpha: Alpha,
    /// Red, green and blue of the colours that pixels index.
    palette: Option<Vec<u8>>,
    /// Samples are cyan, magenta, yellow and black ink.
    is_ink: bool,
}

#[derive(Clone, Copy, PartialEq)]
enum Alpha {
    None,
    Straight,
    /// Colours are multiplied by it.
    Associated,
}

fn from_library(error: TiffError) -> ImageError {
    match error {
        TiffError::IoError(error) => from_io(error),
        TiffError::UnsupportedError(error) => ImageError::Unsupported(error.to_string()),
        TiffError::LimitsExceeded => ImageError::Limits("TIFF".into()),
        error => ImageError::Invalid(error.to_string()),
    }
}

impl<'a> Tiff<'a> {
    /// Reads the header of a file.
    pub fn open(bytes: &'a [u8]) -> Result<Self, ImageError> {
        let mut decoder = Decoder::new(Cursor::new(Cow::Borrowed(bytes))).map_err(from_library)?;
        let photometric = decoder.find_tag_unsigned::<u16>(Tag::PhotometricInterpretation);
        let mut palette = None;
        if photometric.map_err(from_library)? == Some(PALETTE) {
            let colors = decoder.get_tag_u16_vec(Tag::ColorMap).map_err(from_library)?;
            // All reds come first, then the greens. The low bytes repeat the high ones.
            let count = colors.len() / 3;
            let color = |i: usize| [0, 1, 2].map(|channel| (colors[channel * count + i] >> 8) as u8);
            palette = Some((0..count).flat_map(color).collect());
            // The library does not look colours up: it is given the indices as a grey picture.
            let grey = as_grey(bytes)
                .ok_or_else(|| ImageError::Unsupported("a palette in a TIFF file of this kind".into()))?;
            decoder = Decoder::new(Cursor::new(Cow::Owned(grey))).map_err(from_library)?;
        }
        let extra = decoder.find_tag_unsigned_vec::<u16>(Tag::ExtraSamples).map_err(from_library)?;
        let extra = extra.unwrap_or_default().first().copied();
        let alpha = match extra {
            Some(ASSOCIATED) => Alpha::Associated,
            Some(STRAIGHT) => Alpha::Straight,
            _ => Alpha::None,
        };
        let mut is_ink = false;
        let (samples, bits, read, alpha) = match decoder.colortype().map_err(from_library)? {
            ColorType::Gray(bits) => (1, bits, vec![0], Alpha::None),
            ColorType::Multiband { bit_depth, num_samples } => {
                let read = if alpha == Alpha::None { vec![0] } else { vec![0, 1] };
                (usize::from(num_samples), bit_depth, read, alpha)
            }
            ColorType::RGB(bits) => (3, bits, vec![0, 1, 2], Alpha::None),
            // Without a tag, the fourth sample is opacity as in other formats.
            ColorType::RGBA(bits) if alpha == Alpha::None => (4, bits, vec![0, 1, 2, 3], Alpha::Straight),
            ColorType::RGBA(bits) => (4, bits, vec![0, 1, 2, 3], alpha),
            ColorType::CMYK(bits @ (8 | 16)) => {
                is_ink = true;
                (4, bits, vec![0, 1, 2, 3], Alpha::None)
            }
            kind => return Err(ImageError::Unsupported(format!("TIFF colours of kind {kind:?}"))),
        };
        let (width, height) = decoder.dimensions().map_err(from_library)?;
        Ok(Self {
            decoder,
            length: bytes.len(),
            size: [width, height],
            bits,
            samples,
            read,
            alpha,
            palette,
            is_ink,
        })
    }

    /// Width and height.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The bits of a value, and whether it is a float.
    pub fn sample(&mut self) -> Result<(u32, bool), ImageError> {
        let format = self.decoder.find_tag_unsigned_vec::<u16>(Tag::SampleFormat).map_err(from_library)?;
        let is_float = format.unwrap_or_default().first() == Some(&SampleFormat::IEEEFP.to_u16());
        Ok((self.bits.into(), is_float))
    }

    /// The names of the channels.
    pub fn channels(&self) -> &'static [&'static str] {
        channel_names(if self.palette.is_some() || self.is_ink { 3 } else { self.read.len() })
    }

    /// 8-bit integers stay so; others become linear floats.
    pub fn decode(mut self, options: &ReadOptions) -> Result<Image, ImageError> {
        let [width, height] = self.size;
        let (columns, rows) = (width as usize, height as usize);
        options.check_size(columns, rows, self.samples * usize::from(self.bits.max(8)) / 8, self.length)?;
        let mut limits = Limits::default();
        let most = usize::try_from(options.byte_limit(self.length)).unwrap_or(usize::MAX);
        limits.decoding_buffer_size = most;
        limits.intermediate_buffer_size = most;
        limits.ifd_value_size = most;
        self.decoder = self.decoder.with_limits(limits);
        // The library aborts where its own allocation fails, so that memory is tested first.
        drop(reserved::<u8>(columns * rows * self.samples * usize::from(self.bits).div_ceil(8))?);
        let mut buffer = DecodingResult::U8(Vec::new());
        let layout = self.decoder.read_image_to_buffer(&mut buffer).map_err(from_library)?;
        if buffer.as_buffer(0).as_bytes().len() < layout.complete_len {
            return Err(ImageError::Limits(format!("{width} × {height} pixels")));
        }
        let is_planar = layout.planes > 1;
        // Where the samples of a pixel are that are read.
        let count = self.read.len();
        let places = (0..columns * rows * count).map(|index| {
            let (pixel, channel) = (index / count, self.read[index % count]);
            if is_planar { channel * columns * rows + pixel } else { pixel * self.samples + channel }
        });
        let total = columns * rows * count;
        let encoding = options.encoding();
        let scaled = |most: f32| move |value: u32| value as f32 / most;
        let pixels = match buffer {
            DecodingResult::U8(bytes) => {
                let codes = collected(total, places.map(|at| self.code(&bytes, columns, at)))?;
                match &self.palette {
                    Some(palette) => Pixels::U8(looked_up(&codes, palette)?, encoding),
                    None if self.is_ink => {
                        let codes = codes.iter().map(|&code| code.into());
                        let colors = without_ink(codes, total, 255.0)?.into_iter().map(|code| code as u8);
                        Pixels::U8(collected(total / 4 * 3, colors)?, encoding)
                    }
                    None if self.alpha == Alpha::Associated => {
                        self.linear(codes.iter().map(|&code| f32::from(code) / 255.0), Some(encoding))?
                    }
                    None => Pixels::U8(codes, encoding),
                }
            }
            _ if self.palette.is_some() => {
                return Err(ImageError::Unsupported("a TIFF palette of more than 256 colours".into()));
            }
            DecodingResult::U16(codes) if self.is_ink => {
                let codes = places.map(|at| codes[at].into());
                let colors = without_ink(codes, total, 65535.0)?.into_iter();
                let linear = |code: f32| encoding.to_linear(code.trunc() / 65535.0);
                Pixels::F32(collected(total / 4 * 3, colors.map(linear))?)
            }
            DecodingResult::U16(codes) => {
                let code = scaled(65535.0);
                self.linear(places.map(|at| code(codes[at].into())), Some(encoding))?
            }
            DecodingResult::U32(codes) => {
                let code = scaled(u32::MAX as f32);
                self.linear(places.map(|at| code(codes[at])), Some(encoding))?
            }
            DecodingResult::F16(values) if self.alpha != Alpha::Associated => {
                Pixels::F16(collected(total, places.map(|at| f16::from_bits(values[at].to_bits())))?)
            }
            DecodingResult::F16(values) => self.linear(places.map(|at| values[at].to_f32()), None)?,
            DecodingResult::F32(values) => self.linear(places.map(|at| values[at]), None)?,
            DecodingResult::F64(values) => self.linear(places.map(|at| values[at] as f32), None)?,
            _ => return Err(ImageError::Unsupported("signed integers of a TIFF file".into())),
        };
        Image::new(width, height, self.channels().iter().copied(), pixels)
    }

    /// The code of a sample of 8 bits or fewer, widened to 8, but for indices.
    fn code(&self, bytes: &[u8], columns: usize, at: usize) -> u8 {
        let bits = usize::from(self.bits);
        if bits == 8 {
            return bytes[at];
        }
        // Rows begin at whole bytes.
        let row_samples = columns * self.samples;
        let row = &bytes[at / row_samples * (row_samples * bits).div_ceil(8)..];
        let code = packed(row, bits, at % row_samples);
        if self.palette.is_some() { code } else { widened(code.into(), self.bits.into()) }
    }

    /// Linear values of codes in [0, 1], or of values without an encoding, with colours that their
    /// opacity is divided out of.
    fn linear(
        &self,
        values: impl Iterator<Item = f32>,
        encoding: Option<ColorEncoding>,
    ) -> Result<Pixels, ImageError> {
        let count = self.read.len();
        let total = self.size[0] as usize * self.size[1] as usize * count;
        let mut values = collected(total, values)?;
        for pixel in values.chunks_exact_mut(count) {
            let (colors, alpha) =
                pixel.split_at_mut(if self.alpha == Alpha::None { count } else { count - 1 });
            let divisor = match (self.alpha, alpha.first()) {
                (Alpha::Associated, Some(&alpha)) if alpha > 0.0 => alpha,
                _ => 1.0,
            };
            for color in colors {
                *color /= divisor;
                if let Some(encoding) = encoding {
                    *color = encoding.to_linear(color.min(1.0));
                }
            }
        }
        Ok(Pixels::F32(values))
    }
}

fn looked_up(indices: &[u8], palette: &[u8]) -> Result<Vec<u8>, ImageError> {
    let mut colors = reserved(3 * indices.len())?;
    for &index in indices {
        let Some(color) = palette.get(3 * usize::from(index)..).and_then(|rest| rest.first_chunk::<3>())
        else {
            return invalid("a TIFF pixel names a colour beyond its palette");
        };
        colors.extend(color);
    }
    Ok(colors)
}

/// Red, green and blue of paper with cyan, magenta, yellow and black ink, of which there are
/// `count` amounts from 0 to `most`.
fn without_ink(inks: impl Iterator<Item = f32>, count: usize, most: f32) -> Result<Vec<f32>, ImageError> {
    let inks = collected(count, inks)?;
    let colors = inks.as_chunks().0.iter().flat_map(|&[c, m, y, black]| {
        let paper = 1.0 - black / most;
        [c, m, y].map(|ink| (most - ink) * paper)
    });
    collected(count / 4 * 3, colors)
}

/// A classic TIFF file with its first picture declared to be grey.
fn as_grey(bytes: &[u8]) -> Option<Vec<u8>> {
    const PHOTOMETRIC: u16 = 262;
    let is_little = bytes.starts_with(b"II");
    let short = |at: usize| {
        let bytes = bytes.get(at..)?.first_chunk()?;
        Some(if is_little { u16::from_le_bytes(*bytes) } else { u16::from_be_bytes(*bytes) })
    };
    let first = bytes.get(4..)?.first_chunk()?;
    let first = if is_little { u32::from_le_bytes(*first) } else { u32::from_be_bytes(*first) } as usize;
    let entries = (0..usize::from(short(first)?)).map(|entry| first + 2 + 12 * entry);
    let entry = entries.into_iter().find(|&at| short(at) == Some(PHOTOMETRIC))?;
    let mut grey = bytes.to_vec();
    // A number of two bytes, at the start of the entry's value.
    let low = entry + 8 + usize::from(!is_little);
    *grey.get_mut(low)? = BLACK_IS_ZERO;
    Some(grey)
}

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
        U8 => strips::write(&layout.codes(picture)?, SampleFormat::Uint, &mut output),
        U16 => strips::write(&layout.wide_codes(picture)?, SampleFormat::Uint, &mut output),
        _ => strips::write(&layout.floats(picture)?, SampleFormat::IEEEFP, &mut output),
    }
    .map_err(from_library)?;
    Ok(output.flush()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A little-endian file of one strip; bits for each sample, its format, the kind of colour, and
    /// what the extra sample is.
    struct File {
        size: [u32; 2],
        samples: u16,
        bits: u16,
        format: u16,
        photometric: u16,
        extra: Option<u16>,
        is_planar: bool,
        palette: Vec<u16>,
    }

    const GREY: File = File {
        size: [1, 1],
        samples: 1,
        bits: 8,
        format: 1,
        photometric: 1,
        extra: None,
        is_planar: false,
        palette: Vec::new(),
    };

    impl File {
        fn read(&self, data: &[u8]) -> Result<Image, ImageError> {
            let bytes = self.bytes(data);
            Tiff::open(&bytes)?.decode(&ReadOptions::default())
        }

        fn bytes(&self, data: &[u8]) -> Vec<u8> {
            let mut entries: Vec<(u16, u16, Vec<u32>)> = vec![
                (256, 4, vec![self.size[0]]),
                (257, 4, vec![self.size[1]]),
                (258, 3, vec![self.bits.into(); self.samples.into()]),
                (259, 3, vec![1]),
                (262, 3, vec![self.photometric.into()]),
                (277, 3, vec![self.samples.into()]),
                (278, 4, vec![self.size[1]]),
                (284, 3, vec![if self.is_planar { 2 } else { 1 }]),
                (339, 3, vec![self.format.into(); self.samples.into()]),
            ];
            let planes = if self.is_planar { u32::from(self.samples) } else { 1 };
            let plane = data.len() as u32 / planes;
            entries.push((279, 4, vec![plane; planes as usize]));
            entries.extend(self.extra.map(|extra| (338, 3, vec![extra.into()])));
            if !self.palette.is_empty() {
                entries.push((320, 3, self.palette.iter().map(|&v| v.into()).collect()));
            }
            entries.push((273, 4, (0..planes).map(|i| 8 + i * plane).collect()));
            entries.sort_by_key(|entry| entry.0);
            let mut bytes = b"II*\0".to_vec();
            let data_end = (8 + data.len()).next_multiple_of(2);
            let mut more: Vec<u8> = Vec::new();
            let mut table = (entries.len() as u16).to_le_bytes().to_vec();
            let more_at = data_end + 2 + 12 * entries.len() + 4;
            for (tag, kind, values) in entries {
                table.extend([tag.to_le_bytes(), kind.to_le_bytes()].concat());
                table.extend((values.len() as u32).to_le_bytes());
                let mut value: Vec<u8> = values
                    .iter()
                    .flat_map(|v| v.to_le_bytes().into_iter().take(if kind == 3 { 2 } else { 4 }))
                    .collect();
                if value.len() > 4 {
                    let at = (more_at + more.len()) as u32;
                    more.extend(value);
                    value = at.to_le_bytes().to_vec();
                }
                value.resize(4, 0);
                table.extend(value);
            }
            bytes.extend((data_end as u32).to_le_bytes());
            bytes.extend(data);
            bytes.resize(data_end, 0);
            bytes.extend(table);
            bytes.extend([0; 4]);
            bytes.extend(more);
            bytes
        }
    }

    fn pixel(image: &Image) -> Vec<f32> {
        (0..image.channel_count()).map(|channel| image.channel(0, 0, channel)).collect()
    }

    #[test]
    fn colours_are_divided_by_associated_opacity() {
        let file = File { samples: 4, photometric: 2, ..GREY };
        let associated = File { extra: Some(1), ..file };
        let srgb = |code: f32| ColorEncoding::Srgb.to_linear(code);
        let image = associated.read(&[100, 50, 0, 200]).unwrap();
        let alpha = 200.0 / 255.0;
        assert_eq!(pixel(&image), [srgb(100.0 / 255.0 / alpha), srgb(50.0 / 255.0 / alpha), 0.0, alpha]);
        assert_eq!(pixel(&associated.read(&[100, 50, 0, 0]).unwrap())[0], srgb(100.0 / 255.0));
        for extra in [None, Some(2)] {
            let straight = File { extra, palette: Vec::new(), ..file };
            assert_eq!(pixel(&straight.read(&[100, 50, 0, 200]).unwrap())[0], srgb(100.0 / 255.0));
        }
        let floats = File { bits: 32, format: 3, palette: Vec::new(), ..associated };
        let data = [2.0_f32, 0.25, 0.0, 0.5].map(f32::to_le_bytes).concat();
        assert_eq!(pixel(&floats.read(&data).unwrap()), [4.0, 0.5, 0.0, 0.5]);
        let unknown = File { samples: 4, extra: Some(0), palette: Vec::new(), ..file };
        assert_eq!(unknown.read(&[100, 50, 0, 200]).unwrap().channels(), ["R", "G", "B"]);
    }

    #[test]
    fn grey_pictures_have_integers_and_floats_of_all_sizes() {
        let half = f16::from_f32(0.5).to_le_bytes().to_vec();
        for (bits, format, data) in
            [(32, 3, 0.5_f32.to_le_bytes().to_vec()), (64, 3, 0.5_f64.to_le_bytes().to_vec()), (16, 3, half)]
        {
            let image = File { bits, format, ..GREY }.read(&data).unwrap();
            assert_eq!((image.channels(), pixel(&image)), (&["Y".to_owned()][..], vec![0.5]), "{bits}");
        }
        for (bits, data) in [(1, vec![0x80]), (2, vec![0xc0]), (4, vec![0xf0]), (8, vec![255])] {
            assert_eq!(pixel(&File { bits, ..GREY }.read(&data).unwrap()), [1.0], "{bits}");
        }
        for (bits, data) in [(16, vec![255; 2]), (32, vec![255; 4])] {
            assert_eq!(pixel(&File { bits, ..GREY }.read(&data).unwrap()), [1.0], "{bits}");
        }
        let inverted = File { photometric: 0, ..GREY };
        assert_eq!(pixel(&inverted.read(&[0]).unwrap()), [1.0]);
        let both = File { samples: 2, extra: Some(2), ..GREY }.read(&[255, 51]).unwrap();
        assert_eq!(pixel(&both), [1.0, 0.2]);
        let premultiplied = File { samples: 2, extra: Some(1), ..GREY }.read(&[51, 51]).unwrap();
        assert_eq!(pixel(&premultiplied), [1.0, 0.2]);
        assert!(File { format: 2, ..GREY }.read(&[1]).is_err(), "signed");
    }

    #[test]
    fn inks_become_colours() {
        let inks = File { samples: 4, photometric: 5, ..GREY };
        let image = inks.read(&[255, 0, 51, 0]).unwrap();
        assert_eq!(image.channels(), ["R", "G", "B"]);
        let srgb = |code: f32| ColorEncoding::Srgb.to_linear(code / 255.0);
        assert_eq!(pixel(&image), [0.0, 1.0, srgb(204.0)]);
        assert_eq!(pixel(&inks.read(&[0, 0, 0, 255]).unwrap()), [0.0; 3]);
        let planes = File { is_planar: true, palette: Vec::new(), ..inks };
        assert_eq!(pixel(&planes.read(&[255, 0, 51, 0]).unwrap()), [0.0, 1.0, srgb(204.0)]);
        let wide = File { bits: 16, palette: Vec::new(), ..inks };
        let half = f32::from(0x7fff_u16) / 65535.0;
        let found = pixel(&wide.read(&[255, 255, 0, 0x80, 0, 0, 0, 0]).unwrap());
        assert_eq!(found, [0.0, ColorEncoding::Srgb.to_linear(half), 1.0]);
        assert!(File { bits: 32, palette: Vec::new(), ..inks }.read(&[0; 16]).is_err());
    }

    #[test]
    fn planes_and_palettes_are_read() {
        let planes = File { size: [2, 1], samples: 3, photometric: 2, is_planar: true, ..GREY };
        let image = planes.read(&[255, 0, 0, 255, 0, 0]).unwrap();
        assert_eq!([image.rgb(0, 0), image.rgb(1, 0)], [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        let wide = |code: u16| code * 257;
        let colors = [[0, 255, 0, 0], [0, 0, 255, 0], [0, 0, 0, 255]].as_flattened().to_vec();
        let palette = colors.into_iter().map(wide).collect();
        let indexed = File { size: [4, 1], bits: 2, photometric: 3, palette, ..GREY };
        let image = indexed.read(&[0b11_10_01_00]).unwrap();
        let found = [0, 1, 2, 3].map(|x| image.rgb(x, 0));
        assert_eq!(found, [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0; 3]]);
        let short = File { palette: vec![0; 6], ..indexed };
        assert!(short.read(&[0b11_10_01_00]).is_err(), "beyond the palette");
    }
}
