//! Truevision TGA: a header of 18 bytes, a name, a palette, then pixels, packed in runs or not
//! [Truevision TGA File Format Specification 2.0].
//!
//! Pixels are grey, indices of colours, or colours, blue first. Rows begin at the corner that the
//! header names. Of bits of attributes, those of 16-bit colours are unused, and others are opacity.

use std::io::{BufWriter, Write};

use super::{
    Format, Output, ReadOptions, WriteOptions,
    raster::{self, Layout, Raster, invalid, take, widened},
};
use crate::{
    depth::SampleDepth,
    error::ImageError,
    image::Image,
    memory::{collected, filled, reserved},
    source::PixelSource,
};

/// Kinds of pixels, by their number in the header, to which a packed file adds [`PACKED`].
const INDEXED: u8 = 1;
const COLORED: u8 = 2;
const GREY: u8 = 3;
const PACKED: u8 = 8;

/// Bits of the descriptor: where pixels and rows begin.
const FROM_RIGHT: u8 = 1 << 4;
const FROM_TOP: u8 = 1 << 5;
const ATTRIBUTE_BITS: u8 = 0b1111;

/// The most pixels of a packet.
const MAX_PACKED: usize = 128;

/// The header before the pixels.
struct Header {
    size: [u16; 2],
    kind: u8,
    is_packed: bool,
    /// The bits of a pixel, or of an index.
    bits: u8,
    descriptor: u8,
    palette: Palette,
}

/// Colours that pixels index.
struct Palette {
    /// The index of the first colour.
    first: usize,
    /// The bits of a colour.
    bits: u8,
    colors: Vec<[u8; 4]>,
}

/// Size and channels.
pub fn header(bytes: &[u8]) -> Result<raster::Header, ImageError> {
    Ok(Header::parse(&mut { bytes })?.raster())
}

/// 8-bit codes.
pub fn decode(bytes: &[u8], options: &ReadOptions) -> Result<Image, ImageError> {
    let mut data = bytes;
    let header = Header::parse(&mut data)?;
    let raster::Header { size, channels, .. } = header.raster();
    let mut samples = filled(header.raster().sample_count(bytes.len(), options)?, 0)?;
    let [width, height] = size.map(|side| side as usize);
    let mut pixels = Packets::new(data, &header);
    for row in 0..height {
        let y = if header.descriptor & FROM_TOP != 0 { row } else { height - 1 - row };
        for column in 0..width {
            let x = if header.descriptor & FROM_RIGHT != 0 { width - 1 - column } else { column };
            let pixel = header.pixel(pixels.next()?)?;
            samples[(y * width + x) * channels..][..channels].copy_from_slice(&pixel[..channels]);
        }
    }
    Raster { size, channels, samples }.into_image(options)
}

impl Header {
    /// Reads what precedes the pixels, and leaves the bytes after it.
    fn parse(data: &mut &[u8]) -> Result<Self, ImageError> {
        let fields = take(data, 18)?;
        let short = |at: usize| u16::from_le_bytes([fields[at], fields[at + 1]]);
        let (has_palette, kind, bits, descriptor) = (fields[1] == 1, fields[2], fields[16], fields[17]);
        let mut header = Self {
            size: [short(12), short(14)],
            kind: kind & !PACKED,
            is_packed: kind & PACKED != 0,
            bits,
            descriptor,
            palette: Palette { first: short(3).into(), bits: fields[7], colors: Vec::new() },
        };
        let color_bits = header.color_bits();
        let unsupported = match (header.kind, bits) {
            (INDEXED, 8 | 16) => !is_color(color_bits),
            (COLORED, bits) => !is_color(bits),
            (GREY, 8 | 16) => false,
            _ => true,
        };
        if unsupported {
            let text = format!("a TGA file of kind {kind} with {bits} bits of {color_bits}-bit colours");
            return Err(ImageError::Unsupported(text));
        }
        if descriptor & ATTRIBUTE_BITS > color_bits {
            return invalid("a TGA pixel has more bits of attributes than bits");
        }
        take(data, fields[0].into())?;
        if has_palette {
            let color_size = usize::from(header.palette.bits).div_ceil(8);
            let colors = take(data, color_size * usize::from(short(5)))?;
            if header.kind == INDEXED {
                let colors = colors.chunks_exact(color_size);
                header.palette.colors = collected(colors.len(), colors.map(color))?;
            }
        } else if header.kind == INDEXED {
            return invalid("a TGA file without its palette");
        }
        Ok(header)
    }

    /// The bits of a colour, or of grey and opacity.
    fn color_bits(&self) -> u8 {
        if self.kind == INDEXED { self.palette.bits } else { self.bits }
    }

    fn raster(&self) -> raster::Header {
        let channels =
            if self.kind == GREY { self.bits / 8 } else { 3 + u8::from(self.color_bits() == 32) }.into();
        let bits = if self.color_bits() < 24 && self.kind != GREY { 5 } else { 8 };
        raster::Header { size: self.size.map(u32::from), channels, bits }
    }

    /// The samples of a pixel, as many as there are channels, from its bytes.
    fn pixel(&self, bytes: &[u8]) -> Result<[u8; 4], ImageError> {
        match self.kind {
            INDEXED => {
                let index = bytes.iter().rev().fold(0, |index, byte| index << 8 | usize::from(*byte));
                let color = index.checked_sub(self.palette.first).and_then(|i| self.palette.colors.get(i));
                let Some(color) = color else {
                    return invalid("a TGA pixel names a colour beyond its palette");
                };
                Ok(*color)
            }
            COLORED => Ok(color(bytes)),
            _ => Ok([bytes[0], bytes[bytes.len() - 1], 0, 0]),
        }
    }
}

fn is_color(bits: u8) -> bool {
    matches!(bits, 15 | 16 | 24 | 32)
}

/// Red, green, blue and opacity of a colour of two to four bytes.
fn color(bytes: &[u8]) -> [u8; 4] {
    match *bytes {
        [low, high] => {
            let bits = u32::from(u16::from_le_bytes([low, high]));
            let [r, g, b] = [10, 5, 0].map(|shift| widened(bits >> shift & 31, 5));
            [r, g, b, u8::MAX]
        }
        [b, g, r, a] => [r, g, b, a],
        [b, g, r, ..] => [r, g, b, u8::MAX],
        _ => [0; 4],
    }
}

/// The pixels one after the other. A packet is a byte and a pixel that is repeated, or pixels; the
/// byte's low bits are one less than their number.
struct Packets<'a> {
    data: &'a [u8],
    pixel_size: usize,
    is_packed: bool,
    /// Of the packet, the pixels that are left, and the one that is repeated.
    left: usize,
    repeated: Option<&'a [u8]>,
}

impl<'a> Packets<'a> {
    fn new(data: &'a [u8], header: &Header) -> Self {
        let pixel_size = usize::from(header.bits).div_ceil(8);
        Self { data, pixel_size, is_packed: header.is_packed, left: 0, repeated: None }
    }

    fn next(&mut self) -> Result<&'a [u8], ImageError> {
        if self.is_packed {
            if self.left == 0 {
                let code = take(&mut self.data, 1)?[0];
                self.left = usize::from(code & 127) + 1;
                self.repeated = if code > 127 { Some(take(&mut self.data, self.pixel_size)?) } else { None };
            }
            self.left -= 1;
            if let Some(pixel) = self.repeated {
                return Ok(pixel);
            }
        }
        take(&mut self.data, self.pixel_size)
    }
}

/// Writes 8 bits, packed, from the top left.
pub fn encode(
    picture: &dyn PixelSource,
    options: &WriteOptions,
    output: &mut dyn Output,
) -> Result<(), ImageError> {
    options.depth_among(Format::Tga, &[SampleDepth::U8])?;
    let raster = Layout::new(picture, true, true).codes(picture)?;
    let [width, height] = raster.size_within(u16::MAX)?.map(u16::to_le_bytes);
    let kind = PACKED | if raster.channels < 3 { GREY } else { COLORED };
    let attributes = if raster.has_alpha() { 8 } else { 0 };
    let mut output = BufWriter::new(output);
    output.write_all(&[0, 0, kind, 0, 0, 0, 0, 0, 0, 0, 0, 0])?;
    output.write_all(&[width, height].concat())?;
    output.write_all(&[8 * raster.channels as u8, FROM_TOP | attributes])?;
    let mut line = reserved(raster.size[0] as usize * raster.channels)?;
    for row in raster.rows() {
        line.clear();
        line.extend(row);
        if raster.channels >= 3 {
            line.chunks_exact_mut(raster.channels).for_each(|pixel| pixel.swap(0, 2));
        }
        write_packets(&line, raster.channels, &mut output)?;
    }
    Ok(output.flush()?)
}

/// Writes a row, packet by packet.
fn write_packets(row: &[u8], pixel_size: usize, output: &mut impl Write) -> Result<(), ImageError> {
    let (mut start, count) = (0, row.len() / pixel_size);
    let pixel = |x: usize| &row[x * pixel_size..][..pixel_size];
    let run = |x: usize| (x..count.min(x + MAX_PACKED)).take_while(|&other| pixel(other) == pixel(x)).count();
    while start < count {
        let length = run(start);
        if length > 1 {
            output.write_all(&[127 + length as u8])?;
            output.write_all(pixel(start))?;
            start += length;
            continue;
        }
        let end = (start + 1..count.min(start + MAX_PACKED)).find(|&x| run(x) > 1);
        let end = end.unwrap_or(count.min(start + MAX_PACKED));
        output.write_all(&[(end - start - 1) as u8])?;
        output.write_all(&row[start * pixel_size..end * pixel_size])?;
        start = end;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::WriteOptions;

    /// A file of this kind, size, depth and descriptor, and with a palette, where there is one, of
    /// colours of so many bits and with this first index.
    fn file(kind: u8, size: [u8; 2], bits: u8, descriptor: u8, palette: Option<(u8, u8, &[u8])>) -> Vec<u8> {
        let (first, color_bits, colors) = palette.unwrap_or((0, 0, &[]));
        let count = if color_bits == 0 { 0 } else { colors.len() / usize::from(color_bits.div_ceil(8)) };
        let map = [0, u8::from(palette.is_some()), kind, first, 0, count as u8, 0, color_bits];
        [&map[..], &[0; 4], &[size[0], 0, size[1], 0, bits, descriptor], colors].concat()
    }

    fn read(header: &[u8], data: &[u8]) -> Result<Vec<Vec<u8>>, ImageError> {
        let bytes = [header, data].concat();
        let image = decode(&bytes, &ReadOptions::default())?;
        assert_eq!(super::header(&bytes)?.channels, image.channel_count());
        let crate::Pixels::U8(codes, _) = image.pixels() else { panic!("codes") };
        for length in 0..bytes.len() {
            assert!(decode(&bytes[..length], &ReadOptions::default()).is_err(), "{length}");
        }
        Ok(codes.chunks_exact(image.channel_count()).map(<[u8]>::to_vec).collect())
    }

    #[test]
    fn every_kind_of_pixel_is_read() {
        let plain = |kind, bits, descriptor| file(kind, [1, 1], bits, descriptor, None);
        for (file, data, pixel) in [
            (plain(3, 8, 0), &[9][..], &[9][..]),
            (plain(3, 8, 8), &[9], &[9]),
            (plain(3, 16, 8), &[9, 8], &[9, 8]),
            (plain(2, 24, 0), &[1, 2, 3], &[3, 2, 1]),
            (plain(2, 32, 8), &[1, 2, 3, 4], &[3, 2, 1, 4]),
            // Opacity without bits of attributes.
            (plain(2, 32, 0), &[1, 2, 3, 0], &[3, 2, 1, 0]),
            (plain(2, 16, 1), &[0b0100_0001, 0b1000_0100], &[8, 16, 8]),
            (plain(2, 15, 0), &[0xff, 0x7f], &[255; 3]),
            (file(1, [1, 1], 8, 0, Some((5, 24, &[0, 0, 0, 1, 2, 3]))), &[6], &[3, 2, 1]),
            (file(1, [1, 1], 16, 0, Some((0, 32, &[1, 2, 3, 4]))), &[0, 0], &[3, 2, 1, 4]),
            (file(1, [1, 1], 8, 0, Some((0, 16, &[0x1f, 0]))), &[0], &[0, 0, 255]),
            (file(9, [1, 1], 8, 0, Some((0, 24, &[1, 2, 3]))), &[0x80, 0], &[3, 2, 1]),
        ] {
            assert_eq!(read(&file, data).unwrap(), [pixel], "{file:?}");
        }
    }

    #[test]
    fn pixels_begin_at_any_corner_and_may_be_packed() {
        let pixels = |kind, descriptor, data: &[u8]| {
            read(&file(kind, [3, 2], 8, descriptor, None), data).unwrap().concat()
        };
        let flat = [1, 2, 3, 4, 5, 6];
        assert_eq!(pixels(3, 0x20, &flat), flat);
        assert_eq!(pixels(3, 0, &flat), [4, 5, 6, 1, 2, 3]);
        assert_eq!(pixels(3, 0x30, &flat), [3, 2, 1, 6, 5, 4]);
        assert_eq!(pixels(3, 0x10, &flat), [6, 5, 4, 3, 2, 1]);
        // Packets may go on in the next row, and beyond the last.
        assert_eq!(pixels(11, 0x20, &[0x83, 7, 0x01, 8, 9]), [7, 7, 7, 7, 8, 9]);
        assert_eq!(pixels(11, 0x20, &[0x00, 1, 0xff, 2]), [1, 2, 2, 2, 2, 2]);
    }

    #[test]
    fn contradictions_are_refused() {
        let palette = Some((5, 24, &[1, 2, 3][..]));
        for (file, data) in [
            (file(1, [1, 1], 8, 0, palette), 4),
            (file(1, [1, 1], 8, 0, palette), 6),
            (file(1, [1, 1], 8, 0, None), 0),
            (file(1, [1, 1], 24, 0, palette), 5),
            (file(1, [1, 1], 8, 0, Some((5, 8, &[1]))), 5),
            (file(2, [1, 1], 24, 0, None), 0),
            (file(2, [1, 1], 8, 0, None), 0),
            (file(3, [1, 1], 24, 0, None), 0),
            (file(3, [1, 1], 8, 9, None), 0),
            (file(3, [0, 1], 8, 0, None), 0),
            (file(0, [1, 1], 8, 0, None), 0),
            (file(32, [1, 1], 8, 0, None), 0),
        ] {
            let bytes = [&file[..], &[data]].concat();
            assert!(decode(&bytes, &ReadOptions::default()).is_err(), "{file:?}");
        }
        let large = [&file(2, [255, 255], 32, 0, None)[..], &[0; 9]].concat();
        let options = ReadOptions { max_bytes: 1 << 16, ..ReadOptions::default() };
        assert!(matches!(decode(&large, &options), Err(ImageError::Limits(_))));
    }

    #[test]
    fn rows_are_packed_by_themselves() {
        let written = |codes: &[u8]| {
            let values = codes.iter().map(|&code| f32::from(code) / 255.0).collect();
            let pixels = crate::Pixels::F32(values);
            let image = Image::new(codes.len() as u32 / 4, 1, ["R", "G", "B", "A"], pixels).unwrap();
            let mut output = std::io::Cursor::new(Vec::new());
            encode(&image, &WriteOptions::default(), &mut output).unwrap();
            output.into_inner().split_off(18)
        };
        let (a, b) = ([0, 0, 0, 1], [0, 0, 0, 2]);
        assert_eq!(written(&[a, b].concat()), [&[1][..], &a, &b].concat());
        assert_eq!(written(&[a, a, b].concat()), [&[129][..], &a, &[0], &b].concat());
        assert_eq!(written(&[b, a, a].concat()), [&[0][..], &b, &[129], &a].concat());
        assert_eq!(written(&[a; 130].concat()), [&[255][..], &a, &[129], &a].concat());
    }
}
