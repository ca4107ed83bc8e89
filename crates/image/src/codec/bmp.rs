//! Windows bitmaps: a file header, the header of the bitmap, whose length tells its version, masks
//! of colours or a palette, then rows from the bottom, each of whole groups of four bytes
//! [Microsoft, Bitmap Storage].
//!
//! Opacity is read where the header has a mask for it. What runs skip, and colours beyond the
//! palette, are black.

use std::io::{BufWriter, Write};

use super::{
    Format, Output, ReadOptions, WriteOptions,
    raster::{self, Layout, Raster, invalid, packed, take, widened},
};
use crate::{
    depth::SampleDepth,
    error::ImageError,
    image::Image,
    memory::filled,
    source::{PixelSource, alpha_channel},
};

/// Lengths of headers: of the file, and of bitmaps of several versions.
const FILE_HEADER: usize = 14;
const CORE: usize = 12;
const INFO: usize = 40;
/// With masks of red, green and blue, and with that of opacity.
const VERSION_2: usize = 52;
const VERSION_3: usize = 56;
const VERSION_4: usize = 108;
const VERSION_5: usize = 124;

/// Ways of storing pixels.
const PLAIN: u32 = 0;
const RUNS_OF_8: u32 = 1;
const RUNS_OF_4: u32 = 2;
const MASKED: u32 = 3;

/// The most pixels of a side.
const MAX_SIDE: u32 = u16::MAX as u32;

/// The headers before the pixels.
struct Header {
    size: [u32; 2],
    is_from_top: bool,
    /// The bits of a pixel.
    bits: usize,
    storage: u32,
    /// Where red, green, blue and opacity are in a pixel.
    fields: [Field; 4],
    /// Red, green and blue of the colours that pixels index.
    palette: Vec<[u8; 3]>,
    /// Where the pixels begin.
    data_start: usize,
}

/// Bits of a number.
#[derive(Clone, Copy, Default)]
struct Field {
    shift: u32,
    bits: u32,
}

/// Size and channels.
pub fn header(bytes: &[u8]) -> Result<raster::Header, ImageError> {
    Ok(Header::parse(bytes)?.raster())
}

/// 8-bit codes.
pub fn decode(bytes: &[u8], options: &ReadOptions) -> Result<Image, ImageError> {
    let header = Header::parse(bytes)?;
    let raster::Header { size, channels, .. } = header.raster();
    let mut samples = filled(header.raster().sample_count(bytes.len(), options)?, 0)?;
    let Some(mut data) = bytes.get(header.data_start..) else { return invalid("the data ends early") };
    let width = size[0] as usize;
    if matches!(header.storage, RUNS_OF_8 | RUNS_OF_4) {
        header.read_runs(data, &mut samples)?;
        return Raster { size, channels, samples }.into_image(options);
    }
    let row_length = (width * header.bits).div_ceil(8);
    let height = size[1] as usize;
    for row in 0..height {
        let y = if header.is_from_top { row } else { height - 1 - row };
        let row = take(&mut data, row_length)?;
        data = &data[data.len().min(row_length.next_multiple_of(4) - row_length)..];
        let place = &mut samples[y * width * channels..][..width * channels];
        for (x, place) in place.chunks_exact_mut(channels).enumerate() {
            place.copy_from_slice(&header.pixel(row, x)[..channels]);
        }
    }
    Raster { size, channels, samples }.into_image(options)
}

fn short(bytes: &[u8], at: usize) -> Result<u32, ImageError> {
    match bytes.get(at..).and_then(|rest| rest.first_chunk()) {
        Some(&bytes) => Ok(u16::from_le_bytes(bytes).into()),
        None => invalid("the data ends early"),
    }
}

fn long(bytes: &[u8], at: usize) -> Result<u32, ImageError> {
    Ok(short(bytes, at)? | short(bytes, at + 2)? << 16)
}

impl Header {
    fn parse(bytes: &[u8]) -> Result<Self, ImageError> {
        if !bytes.starts_with(b"BM") {
            return invalid("a bitmap begins with `BM`");
        }
        let data_start = long(bytes, 10)? as usize;
        let length = long(bytes, FILE_HEADER)? as usize;
        let info = &bytes[FILE_HEADER..];
        if !matches!(length, CORE | INFO | VERSION_2 | VERSION_3 | VERSION_4 | VERSION_5) {
            return Err(ImageError::Unsupported(format!("a bitmap whose header has {length} bytes")));
        }
        let is_core = length == CORE;
        let (width, height, at) = if is_core {
            (short(info, 4)? as i32, short(info, 6)? as i32, 8)
        } else {
            (long(info, 4)? as i32, long(info, 8)? as i32, 12)
        };
        if width <= 0 || height == 0 || width.unsigned_abs().max(height.unsigned_abs()) > MAX_SIDE {
            return invalid(format!("a bitmap of {width} × {height} pixels"));
        }
        if short(info, at)? != 1 {
            return invalid("a bitmap has one plane");
        }
        let bits = short(info, at + 2)? as usize;
        let [storage, color_count] = if is_core { [PLAIN, 0] } else { [long(info, 16)?, long(info, 32)?] };
        if height < 0 && !matches!(storage, PLAIN | MASKED) {
            return invalid("a packed bitmap begins at its bottom");
        }
        let mut header = Self {
            size: [width.unsigned_abs(), height.unsigned_abs()],
            is_from_top: height < 0,
            bits,
            storage,
            fields: [Field::default(); 4],
            palette: Vec::new(),
            data_start,
        };
        match (storage, bits) {
            (PLAIN, 1 | 2 | 4 | 8) | (RUNS_OF_8, 8) | (RUNS_OF_4, 4) => {
                header.palette = palette(&info[length.min(info.len())..], is_core, bits, color_count)?;
            }
            (PLAIN, 16) => header.fields = Field::of_masks([0x7c00, 0x3e0, 0x1f, 0], 16)?,
            (PLAIN, 24 | 32) => header.fields = Field::of_masks([0xff_0000, 0xff00, 0xff, 0], 24)?,
            (MASKED, 16 | 32) => {
                let alpha = if length >= VERSION_3 { long(info, 52)? } else { 0 };
                let masks = [long(info, 40)?, long(info, 44)?, long(info, 48)?, alpha];
                header.fields = Field::of_masks(masks, bits as u32)?;
            }
            _ => {
                let text = format!("a bitmap of {bits} bits that is stored in way {storage}");
                return Err(ImageError::Unsupported(text));
            }
        }
        Ok(header)
    }

    fn raster(&self) -> raster::Header {
        raster::Header { size: self.size, channels: 3 + usize::from(self.fields[3].bits > 0), bits: 8 }
    }

    /// Red, green, blue and opacity of a pixel of a row.
    fn pixel(&self, row: &[u8], x: usize) -> [u8; 4] {
        if self.bits <= 8 {
            let [r, g, b] = self.color(packed(row, self.bits, x));
            return [r, g, b, u8::MAX];
        }
        let bytes = &row[x * self.bits / 8..][..self.bits / 8];
        let number = bytes.iter().rev().fold(0, |number, byte| number << 8 | u32::from(*byte));
        self.fields.map(|field| field.code(number))
    }

    /// A colour of the palette.
    fn color(&self, index: u8) -> [u8; 3] {
        self.palette.get(usize::from(index)).copied().unwrap_or_default()
    }

    /// Reads pixels that are packed in runs: a count that is not zero and what is repeated, two
    /// pixels where they have four bits; else 0 and the end of a row (0), of the picture (1), a
    /// step to the right and up (2), or a number of pixels, which are padded to two bytes.
    fn read_runs(&self, mut data: &[u8], samples: &mut [u8]) -> Result<(), ImageError> {
        let [width, height] = self.size.map(|side| side as usize);
        let (mut x, mut row) = (0, 0);
        while row < height {
            let bytes = take(&mut data, 2)?;
            let count = match (bytes[0], usize::from(bytes[1])) {
                (0, 0) => {
                    (x, row) = (0, row + 1);
                    continue;
                }
                (0, 1) => break,
                (0, 2) => {
                    let steps = take(&mut data, 2)?;
                    (x, row) = (x + usize::from(steps[0]), row + usize::from(steps[1]));
                    if x > width || row >= height {
                        return invalid("runs of a bitmap step out of it");
                    }
                    continue;
                }
                (0, count) => count,
                (count, _) => count.into(),
            };
            let pixels = if bytes[0] == 0 {
                take(&mut data, (count * self.bits).div_ceil(8).next_multiple_of(2))?
            } else {
                &bytes[1..]
            };
            // ImageMagick writes runs of eight bits that are too long.
            let is_clipped = bytes[0] > 0 && self.bits == 8;
            if x + count > width && !is_clipped {
                return invalid("a run of a bitmap is longer than its row");
            }
            let places = (height - 1 - row) * width;
            for (place, index) in (x..width.min(x + count)).zip(0..) {
                let index = if bytes[0] == 0 { index } else { index % (8 / self.bits) };
                let color = self.color(packed(pixels, self.bits, index));
                samples[3 * (places + place)..][..3].copy_from_slice(&color);
            }
            x = width.min(x + count);
        }
        Ok(())
    }
}

/// Red, green and blue of the colours at the start of `bytes`, which are blue first.
fn palette(bytes: &[u8], is_core: bool, bits: usize, count: u32) -> Result<Vec<[u8; 3]>, ImageError> {
    let most = 1 << bits;
    let count = if count == 0 { most } else { count as usize };
    if count > most {
        return invalid(format!("a bitmap of {bits} bits with {count} colours"));
    }
    let color_size = if is_core { 3 } else { 4 };
    let colors = take(&mut { bytes }, count * color_size)?.chunks_exact(color_size);
    Ok(colors.map(|color| [color[2], color[1], color[0]]).collect())
}

impl Field {
    /// The bits that are set in masks of pixels of so many bits.
    fn of_masks(masks: [u32; 4], pixel_bits: u32) -> Result<[Self; 4], ImageError> {
        let mut fields = [Self::default(); 4];
        for (index, (field, mask)) in fields.iter_mut().zip(masks).enumerate() {
            if mask == 0 {
                // Opacity alone may be absent.
                if index < 3 {
                    return invalid("a bitmap lacks the mask of a colour");
                }
                continue;
            }
            let (shift, bits) = (mask.trailing_zeros(), mask.count_ones());
            if 32 - mask.leading_zeros() - shift != bits || shift + bits > pixel_bits {
                return invalid(format!("a bitmap has the mask {mask:#x}"));
            }
            // Of more bits than a code has, the high ones are read.
            *field = Self { shift: shift + bits.saturating_sub(8), bits: bits.min(8) };
        }
        Ok(fields)
    }

    /// The 8-bit code of these bits of a number.
    fn code(self, number: u32) -> u8 {
        let code = number >> self.shift;
        match self.bits {
            0 => u8::MAX,
            8 => code as u8,
            bits => widened(code & ((1 << bits) - 1), bits),
        }
    }
}

/// Writes 8 bits: indices of grey, colours, or colours with opacity, for which version 4 has a
/// mask.
pub fn encode(
    picture: &dyn PixelSource,
    options: &WriteOptions,
    output: &mut dyn Output,
) -> Result<(), ImageError> {
    options.depth_among(Format::Bmp, &[SampleDepth::U8])?;
    // Indices of grey have no opacity.
    let has_alpha = alpha_channel(&picture.channels()).is_some();
    let raster = Layout::new(picture, !has_alpha, true).codes(picture)?;
    raster.size_within(u16::MAX)?;
    let [width, height] = raster.size;
    let row_length = (raster.size[0] as usize * raster.channels).next_multiple_of(4);
    let (length, storage) = if raster.has_alpha() { (VERSION_4, MASKED) } else { (INFO, PLAIN) };
    let color_count = if raster.channels == 1 { 256 } else { 0 };
    let data_start = FILE_HEADER + length + 4 * color_count;
    let data_length = row_length as u64 * u64::from(height);
    let Ok(file_length) = u32::try_from(data_start as u64 + data_length) else {
        return Err(ImageError::Limits(format!("a bitmap of {width} × {height} pixels")));
    };

    let mut output = BufWriter::new(output);
    output.write_all(b"BM")?;
    let mut numbers = vec![file_length, 0, data_start as u32, length as u32, width, height];
    numbers.push(1 | (8 * raster.channels as u32) << 16);
    numbers.extend([storage, data_length as u32, 0, 0, color_count as u32, 0]);
    if raster.has_alpha() {
        const SRGB: u32 = u32::from_be_bytes(*b"sRGB");
        numbers.extend([0xff_0000, 0xff00, 0xff, 0xff00_0000, SRGB]);
        // Primaries and gamma, which sRGB makes void.
        numbers.extend([0; 12]);
    }
    numbers.extend((0..color_count as u32).map(|grey| grey * 0x01_0101));
    for number in numbers {
        output.write_all(&number.to_le_bytes())?;
    }
    let mut line = filled(row_length, 0)?;
    for row in raster.rows().rev() {
        line[..row.len()].copy_from_slice(row);
        if raster.channels >= 3 {
            line[..row.len()].chunks_exact_mut(raster.channels).for_each(|pixel| pixel.swap(0, 2));
        }
        output.write_all(&line)?;
    }
    Ok(output.flush()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    const RED: [u8; 3] = [255, 0, 0];
    const GREEN: [u8; 3] = [0, 255, 0];
    const BLACK: [u8; 3] = [0; 3];

    /// A file of this size, depth and way of storing pixels, with what follows the header of
    /// `length` bytes, and pixels.
    fn file(size: [i32; 2], bits: u16, storage: u32, length: usize, after: &[u8], data: &[u8]) -> Vec<u8> {
        let mut header = (length as u32).to_le_bytes().to_vec();
        if length == CORE {
            header.extend(size.map(|side| (side as u16).to_le_bytes()).concat());
        } else {
            header.extend(size.map(i32::to_le_bytes).concat());
        }
        header.extend([1_u16.to_le_bytes(), bits.to_le_bytes()].concat());
        if length > CORE {
            header.extend(storage.to_le_bytes());
            header.resize(INFO, 0);
        }
        header.extend(after);
        header.resize(header.len().max(length), 0);
        let start = (FILE_HEADER + header.len()) as u32;
        [&b"BM"[..], &[0; 8], &start.to_le_bytes(), &header, data].concat()
    }

    fn masks(masks: &[u32]) -> Vec<u8> {
        masks.iter().flat_map(|mask| mask.to_le_bytes()).collect()
    }

    /// A palette of black, red and green, and more of black.
    fn colors(count: usize) -> Vec<u8> {
        let mut colors = [[0; 4], [0, 0, 255, 0], [0, 255, 0, 0]].concat();
        colors.resize(4 * count, 0);
        colors
    }

    fn codes(bytes: &[u8]) -> Result<Vec<u8>, ImageError> {
        let image = decode(bytes, &ReadOptions::default())?;
        assert_eq!(header(bytes)?.channels, image.channel_count());
        let crate::Pixels::U8(codes, _) = image.pixels() else { panic!("codes") };
        Ok(codes.clone())
    }

    #[test]
    fn indices_are_looked_up() {
        for (bits, data) in [(1, 0x50), (2, 0b0001_0000), (4, 0x01)] {
            let after = colors(1 << bits);
            let bytes = file([2, 1], bits, PLAIN, INFO, &after, &[data, 0, 0, 0]);
            assert_eq!(codes(&bytes).unwrap(), [BLACK, RED].concat(), "{bits}");
            for length in 0..bytes.len() - 3 {
                assert!(decode(&bytes[..length], &ReadOptions::default()).is_err(), "{length}");
            }
        }
        let bytes = file([3, -1], 8, PLAIN, VERSION_5, &[&[0; 84][..], &colors(256)].concat(), &[2, 1, 9]);
        assert_eq!(codes(&bytes).unwrap(), [GREEN, RED, BLACK].concat());
        let core = [[0; 3], [0, 0, 255]].concat();
        let bytes = file([1, 2], 1, PLAIN, CORE, &core, &[0x80, 0, 0, 0, 0]);
        assert_eq!(codes(&bytes).unwrap(), [BLACK, RED].concat());
        // Fewer colours than indices.
        let mut bytes = file([2, 1], 8, PLAIN, INFO, &colors(2), &[1, 2]);
        bytes[FILE_HEADER + 32] = 2;
        assert_eq!(codes(&bytes).unwrap(), [RED, BLACK].concat());
        bytes[FILE_HEADER + 33] = 2;
        assert!(codes(&bytes).is_err(), "more colours than indices");
    }

    #[test]
    fn colours_are_fields_of_numbers() {
        let one = |bits, storage, length, after: &[u8], data: &[u8]| {
            codes(&file([1, 1], bits, storage, length, after, data)).unwrap()
        };
        assert_eq!(one(24, PLAIN, INFO, &[], &[1, 2, 3]), [3, 2, 1]);
        assert_eq!(one(24, PLAIN, CORE, &[], &[1, 2, 3]), [3, 2, 1]);
        assert_eq!(one(32, PLAIN, INFO, &[], &[1, 2, 3, 4]), [3, 2, 1]);
        assert_eq!(one(16, PLAIN, INFO, &[], &[0b0100_0001, 0x84]), [8, 16, 8]);
        let rgb565 = masks(&[0xf800, 0x7e0, 0x1f]);
        assert_eq!(one(16, MASKED, INFO, &rgb565, &[0x20, 0xf8]), [255, 4, 0]);
        let bytes = masks(&[0xff, 0xff00, 0xff_0000, 0xff00_0000]);
        assert_eq!(one(32, MASKED, VERSION_2, &bytes[..12], &[1, 2, 3, 4]), [1, 2, 3]);
        assert_eq!(one(32, MASKED, VERSION_3, &bytes, &[1, 2, 3, 4]), [1, 2, 3, 4]);
        assert_eq!(one(32, MASKED, VERSION_4, &bytes, &[1, 2, 3, 4]), [1, 2, 3, 4]);
        let wide = masks(&[0x3ff, 0xffc00, 0x3ff0_0000, 0xc000_0000]);
        assert_eq!(one(32, MASKED, VERSION_4, &wide, &[0xfc, 3, 0, 0x40]), [255, 0, 0, 85]);
        for wrong in [[0, 2, 4], [5, 2, 8], [1 << 16, 2, 4]] {
            let bytes = file([1, 1], 16, MASKED, INFO, &masks(&wrong), &[0; 4]);
            assert!(matches!(codes(&bytes), Err(ImageError::Invalid(_))), "{wrong:?}");
        }
    }

    #[test]
    fn rows_begin_at_the_bottom_unless_the_height_is_negative() {
        let data = [[0, 0, 255, 0], [0, 255, 0, 0]].concat();
        assert_eq!(codes(&file([1, 2], 24, PLAIN, INFO, &[], &data)).unwrap(), [GREEN, RED].concat());
        assert_eq!(codes(&file([1, -2], 24, PLAIN, INFO, &[], &data)).unwrap(), [RED, GREEN].concat());
    }

    #[test]
    fn runs_repeat_step_and_end() {
        let runs = |storage, data: &[u8]| {
            let bits = if storage == RUNS_OF_8 { 8 } else { 4 };
            codes(&file([4, 2], bits, storage, INFO, &colors(1 << bits), data))
        };
        let bottom = |row: [[u8; 3]; 4]| [[BLACK; 4], row].as_flattened().concat();
        let eight = [3, 1, 1, 2, 0, 1];
        assert_eq!(runs(RUNS_OF_8, &eight).unwrap(), bottom([RED, RED, RED, GREEN]));
        assert_eq!(runs(RUNS_OF_8, &[0, 3, 1, 2, 1, 0, 0, 1]).unwrap(), bottom([RED, GREEN, RED, BLACK]));
        assert_eq!(runs(RUNS_OF_8, &[9, 1, 0, 0, 0, 1]).unwrap(), bottom([RED; 4]), "too long");
        let up = [[BLACK, RED, BLACK, BLACK], [BLACK; 4]].as_flattened().concat();
        assert_eq!(runs(RUNS_OF_8, &[0, 2, 1, 1, 1, 1, 0, 1]).unwrap(), up);
        assert_eq!(runs(RUNS_OF_4, &[3, 0x12, 0, 1]).unwrap(), bottom([RED, GREEN, RED, BLACK]));
        assert_eq!(runs(RUNS_OF_4, &[0, 3, 0x12, 0x20, 0, 1]).unwrap(), bottom([RED, GREEN, GREEN, BLACK]));
        for wrong in [&[5, 1, 0, 1][..], &[0, 5, 0, 0, 0, 0], &[0, 2, 5, 0], &[0, 2, 0, 2]] {
            assert!(runs(RUNS_OF_4, wrong).is_err(), "{wrong:?}");
        }
        for length in 0..eight.len() {
            assert!(runs(RUNS_OF_8, &eight[..length]).is_err(), "{length}");
        }
        assert!(codes(&file([4, -2], 8, RUNS_OF_8, INFO, &colors(256), &eight)).is_err(), "from the top");
    }

    #[test]
    fn contradictions_are_refused() {
        for (size, bits, storage, length) in [
            ([0, 1], 24, PLAIN, INFO),
            ([1, 0], 24, PLAIN, INFO),
            ([-1, 1], 24, PLAIN, INFO),
            ([1, i32::MIN], 24, PLAIN, INFO),
            ([1 << 16, 1], 24, PLAIN, INFO),
            ([1, 1], 3, PLAIN, INFO),
            ([1, 1], 8, RUNS_OF_4, INFO),
            ([1, 1], 24, MASKED, INFO),
            ([1, 1], 24, 4, INFO),
            ([1, 1], 24, PLAIN, 64),
            ([1, 1], 24, PLAIN, 8),
        ] {
            let bytes = file(size, bits, storage, length, &[], &[0; 2048]);
            assert!(codes(&bytes).is_err(), "{size:?} {bits} {storage} {length}");
        }
        let large = file([65535, 65535], 8, RUNS_OF_8, INFO, &colors(256), &[0, 1]);
        assert!(matches!(codes(&large), Err(ImageError::Limits(_))));
    }
}
