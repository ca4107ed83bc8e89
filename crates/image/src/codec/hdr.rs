//! Radiance pictures: a text header, a line with the size and the order of pixels, then colours of
//! three bytes with a common exponent, packed in runs or not [Ward 1991].
//!
//! Values are radiance: `EXPOSURE` and `COLORCORR`, by which those of a file are multiplied, are
//! divided out. Signatures may name any program.

use std::io::{BufWriter, Write};

use super::{
    Format, Output, ReadOptions, WriteOptions,
    raster::{invalid, take},
};
use crate::{
    depth::SampleDepth,
    encoding::at_most,
    error::ImageError,
    image::{Image, Pixels},
    memory::filled,
    metadata::ImageMetadata,
    source::{PixelSource, color_channels},
};

/// The lengths of lines that are packed component by component.
const PACKED_LENGTHS: std::ops::Range<usize> = 8..1 << 15;

/// The header before the pixels.
struct Header {
    /// Width and height of the picture.
    size: [usize; 2],
    /// Lines of pixels are columns of the picture.
    is_turned: bool,
    /// Whether x and y decrease in the order of pixels.
    is_mirrored: [bool; 2],
    /// The factors on red, green and blue by which values of the file are multiplied.
    factors: [f32; 3],
    /// Width of a pixel over its height.
    pixel_aspect: f32,
}

/// The width and height in the header.
pub fn size(bytes: &[u8]) -> Result<[u32; 2], ImageError> {
    Ok(Header::parse(&mut { bytes })?.size.map(|side| side as u32))
}

/// Values are single floats.
pub fn decode(bytes: &[u8], options: &ReadOptions) -> Result<Image, ImageError> {
    let mut data = bytes;
    let header = Header::parse(&mut data)?;
    let [width, height] = header.size;
    options.check_size(width, height, 12, bytes.len())?;
    let [length, count] = if header.is_turned { [height, width] } else { [width, height] };
    let mut values = filled(3 * width * height, 0.0_f32)?;
    let mut line = filled(length, [0_u8; 4])?;
    let units: [f32; 256] =
        std::array::from_fn(|e| if e == 0 { 0.0 } else { libm::ldexpf(1.0, e as i32 - 136) });
    for at in 0..count {
        read_line(&mut data, &mut line)?;
        for (along, &[r, g, b, exponent]) in line.iter().enumerate() {
            let [x, y] = if header.is_turned { [at, along] } else { [along, at] };
            let x = if header.is_mirrored[0] { width - 1 - x } else { x };
            let y = if header.is_mirrored[1] { height - 1 - y } else { y };
            let unit = units[usize::from(exponent)];
            let place = &mut values[3 * (y * width + x)..][..3];
            for ((place, code), factor) in place.iter_mut().zip([r, g, b]).zip(header.factors) {
                *place = f32::from(code) * unit / factor;
            }
        }
    }
    let mut image = Image::new(width as u32, height as u32, ["R", "G", "B"], Pixels::F32(values))?;
    image.metadata = ImageMetadata { pixel_aspect: header.pixel_aspect, ..image.metadata };
    Ok(image)
}

impl Header {
    /// Reads the header, and leaves the bytes after it.
    fn parse(bytes: &mut &[u8]) -> Result<Self, ImageError> {
        let mut line = || -> Result<String, ImageError> {
            let end = bytes.iter().position(|&byte| byte == b'\n');
            let Some(end) = end else { return invalid("a Radiance header has no end") };
            let line = String::from_utf8_lossy(&bytes[..end]).trim_end().to_owned();
            *bytes = &bytes[end + 1..];
            Ok(line)
        };
        if !line()?.starts_with("#?") {
            return invalid("a Radiance picture begins with `#?`");
        }
        let (mut factors, mut pixel_aspect) = ([1.0; 3], 1.0);
        loop {
            let text = line()?;
            let Some((name, value)) = text.split_once('=') else {
                if text.is_empty() {
                    break;
                }
                // Commands that made the picture, and comments.
                continue;
            };
            let numbers = value.split_whitespace().map_while(|word| word.parse::<f32>().ok());
            let numbers: Vec<f32> = numbers.filter(|number| *number > 0.0 && number.is_finite()).collect();
            match (name.trim(), numbers.as_slice()) {
                ("FORMAT", _) if value.trim() == "32-bit_rle_rgbe" => (),
                ("FORMAT", _) => {
                    let text =
                        format!("Radiance format `{:.40}`: only `32-bit_rle_rgbe` is read", value.trim());
                    return Err(ImageError::Unsupported(text));
                }
                // Each program that changes a picture adds a line.
                ("EXPOSURE", [exposure]) => factors = factors.map(|factor| factor * exposure),
                ("COLORCORR", [r, g, b]) => factors = [factors[0] * r, factors[1] * g, factors[2] * b],
                ("PIXASPECT", [height]) => pixel_aspect /= height,
                ("EXPOSURE" | "COLORCORR" | "PIXASPECT", _) => {
                    return invalid(format!("the Radiance header has the line `{text:.60}`"));
                }
                _ => (),
            }
        }
        let order = line()?;
        let words: Vec<&str> = order.split_whitespace().collect();
        let [first, count, second, length] = words[..] else {
            return invalid(format!("`{order:.60}` is not the size of a Radiance picture"));
        };
        let sides = [count, length].map(|side| side.parse::<usize>().ok().filter(|side| *side < 1 << 24));
        let (is_turned, is_mirrored) = match (first, second) {
            ("-Y" | "+Y", "+X" | "-X") => (false, [second == "-X", first == "+Y"]),
            ("-X" | "+X", "+Y" | "-Y") => (true, [first == "-X", second == "+Y"]),
            _ => return invalid(format!("`{order:.60}` is not the size of a Radiance picture")),
        };
        let [Some(count), Some(length)] = sides else {
            return invalid(format!("`{order:.60}` is not the size of a Radiance picture"));
        };
        let size = if is_turned { [count, length] } else { [length, count] };
        Ok(Self { size, is_turned, is_mirrored, factors, pixel_aspect })
    }
}

/// Reads a line of pixels: of runs for each component, if it begins with 2, 2 and its length, else
/// of pixels, where one of 1, 1, 1 repeats the one before.
fn read_line(data: &mut &[u8], line: &mut [[u8; 4]]) -> Result<(), ImageError> {
    if let [2, 2, high, low, ..] = **data
        && usize::from(u16::from_be_bytes([high, low])) == line.len()
        && PACKED_LENGTHS.contains(&line.len())
    {
        take(data, 4)?;
        return (0..4).try_for_each(|component| read_component(data, line, component));
    }
    let (mut at, mut shift) = (0, 0);
    while at < line.len() {
        let pixel: [u8; 4] = std::array::from_fn({
            let bytes = take(data, 4)?;
            move |i| bytes[i]
        });
        if pixel[..3] != [1; 3] {
            line[at] = pixel;
            (at, shift) = (at + 1, 0);
            continue;
        }
        // Counts that follow each other are the bytes of one, the lowest first.
        let count = usize::from(pixel[3]) << shift;
        let Some(repeated) = at.checked_sub(1).filter(|_| count <= line.len() - at) else {
            return invalid("a run of a Radiance picture is longer than its line");
        };
        let pixel = line[repeated];
        line[at..at + count].fill(pixel);
        (at, shift) = (at + count, (shift + 8).min(24));
    }
    Ok(())
}

fn read_component(data: &mut &[u8], line: &mut [[u8; 4]], component: usize) -> Result<(), ImageError> {
    let mut at = 0;
    while at < line.len() {
        let code = usize::from(take(data, 1)?[0]);
        let is_run = code > 128;
        let count = if is_run { code - 128 } else { code };
        if count == 0 || count > line.len() - at {
            return invalid("a run of a Radiance picture is longer than its line");
        }
        let values = take(data, if is_run { 1 } else { count })?;
        for (index, pixel) in line[at..at + count].iter_mut().enumerate() {
            pixel[component] = values[if is_run { 0 } else { index }];
        }
        at += count;
    }
    Ok(())
}

/// Writes lines from the top, packed component by component where they may be.
pub fn encode(
    picture: &dyn PixelSource,
    options: &WriteOptions,
    output: &mut dyn Output,
) -> Result<(), ImageError> {
    options.depth_among(Format::Hdr, &[SampleDepth::F32])?;
    let channels = picture.channels();
    let color = color_channels(&channels);
    let (width, height) = (picture.width() as usize, picture.height());
    let mut output = BufWriter::new(output);
    write!(output, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n")?;
    let mut row = filled(width * channels.len(), 0.0)?;
    let mut line = filled(width, [0; 4])?;
    for y in 0..height {
        picture.row(y, &mut row);
        for (pixel, values) in line.iter_mut().zip(row.chunks_exact(channels.len())) {
            *pixel = rgbe(color.map(|c| values[c]));
        }
        if !PACKED_LENGTHS.contains(&width) {
            output.write_all(line.as_flattened())?;
            continue;
        }
        output.write_all(&[2, 2, (width >> 8) as u8, width as u8])?;
        (0..4).try_for_each(|component| write_component(&line, component, &mut output))?;
    }
    Ok(output.flush()?)
}

/// The components and the exponent of a colour; values that are too large become the greatest.
fn rgbe(color: [f32; 3]) -> [u8; 4] {
    const GREATEST: f32 = (255.0 / 256.0) * (1_u128 << 127) as f32;
    let color = color.map(|value| at_most(value, GREATEST));
    let (_, exponent) = libm::frexpf(color[0].max(color[1]).max(color[2]));
    if exponent < -127 || color == [0.0; 3] {
        return [0; 4];
    }
    let [r, g, b] = color.map(|value| libm::ldexpf(value, 8 - exponent) as u8);
    [r, g, b, (exponent + 128) as u8]
}

/// Writes runs of a component of a line: a count above 128 and what is repeated, or a count and
/// that many values.
fn write_component(line: &[[u8; 4]], component: usize, output: &mut impl Write) -> Result<(), ImageError> {
    /// Shorter runs take as many bytes as their values.
    const SHORTEST_RUN: usize = 3;
    const MAX_REPEATED: usize = 127;
    const MAX_VALUES: usize = 128;
    let run = |start: usize| {
        let values = line[start..].iter().take(MAX_REPEATED);
        values.take_while(|pixel| pixel[component] == line[start][component]).count()
    };
    let mut start = 0;
    while start < line.len() {
        let length = run(start);
        if length >= SHORTEST_RUN {
            output.write_all(&[128 + length as u8, line[start][component]])?;
            start += length;
            continue;
        }
        let most = line.len().min(start + MAX_VALUES);
        let end = (start + 1..most).find(|&at| run(at) >= SHORTEST_RUN).unwrap_or(most);
        output.write_all(&[(end - start) as u8])?;
        for pixel in &line[start..end] {
            output.write_all(&[pixel[component]])?;
        }
        start = end;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(header: &str, size: &str, data: &[u8]) -> Result<Image, ImageError> {
        let mut bytes = format!("{header}\n\n{size}\n").into_bytes();
        bytes.extend(data);
        decode(&bytes, &ReadOptions::default())
    }

    const HEADER: &str = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe";
    const WHITE: [u8; 4] = [128, 128, 128, 129];

    /// The red of all pixels, row by row.
    fn reds(image: &Image) -> Vec<f32> {
        (0..image.height()).flat_map(|y| (0..image.width()).map(move |x| image.rgb(x, y)[0])).collect()
    }

    #[test]
    fn signatures_name_any_program() {
        for first in ["#?RADIANCE", "#?RGBE", "#?AUTOPANO", "#?", "#?rgbe\r"] {
            let image = picture(first, "-Y 1 +X 1", &WHITE).unwrap();
            assert_eq!(image.rgb(0, 0), [1.0; 3], "{first}");
        }
        assert!(picture("RADIANCE", "-Y 1 +X 1", &WHITE).is_err());
    }

    #[test]
    fn exposure_and_colour_correction_are_divided_out() {
        let header =
            format!("{HEADER}\npcomb a.hdr\nEXPOSURE=2\nEXPOSURE= 4.0\nCOLORCORR=1 2 0.5\nPIXASPECT=0.5");
        let image = picture(&header, "-Y 1 +X 1", &WHITE).unwrap();
        assert_eq!(image.rgb(0, 0), [0.125, 0.0625, 0.25]);
        assert_eq!(image.metadata.pixel_aspect, 2.0);
        for line in ["EXPOSURE=x", "EXPOSURE=0", "COLORCORR=1 2", "FORMAT=32-bit_rle_xyze"] {
            assert!(picture(&format!("{HEADER}\n{line}"), "-Y 1 +X 1", &WHITE).is_err(), "{line}");
        }
    }

    #[test]
    fn pixels_are_in_any_of_eight_orders() {
        // Pixels 1, 2, 3, 4, 5, 6 in the order of the file.
        let data: Vec<u8> = (1..=6).flat_map(|i| [i * 16, 0, 0, 132]).collect();
        for (size, expected) in [
            ("-Y 2 +X 3", [1, 2, 3, 4, 5, 6]),
            ("+Y 2 +X 3", [4, 5, 6, 1, 2, 3]),
            ("-Y 2 -X 3", [3, 2, 1, 6, 5, 4]),
            ("+Y 2 -X 3", [6, 5, 4, 3, 2, 1]),
            ("+X 3 -Y 2", [1, 3, 5, 2, 4, 6]),
            ("-X 3 -Y 2", [5, 3, 1, 6, 4, 2]),
            ("+X 3 +Y 2", [2, 4, 6, 1, 3, 5]),
            ("-X 3 +Y 2", [6, 4, 2, 5, 3, 1]),
        ] {
            let image = picture(HEADER, size, &data).unwrap();
            assert_eq!((image.width(), image.height()), (3, 2), "{size}");
            assert_eq!(reds(&image), expected.map(|i| i as f32), "{size}");
        }
        for size in ["-Y 2", "-Y 2 +Y 3", "-Y x +X 3", "-Y 2 +X -3", "2 3 4 5"] {
            assert!(picture(HEADER, size, &data).is_err(), "{size}");
        }
    }

    #[test]
    fn lines_are_packed_in_either_way_or_not() {
        let flat: Vec<u8> = (0..9_u8).flat_map(|i| [if i < 8 { 16 } else { 32 }, 0, 0, 132]).collect();
        let old = [&[16, 0, 0, 132, 1, 1, 1, 7][..], &[32, 0, 0, 132]].concat();
        let new = [&[2, 2, 0, 9, 136, 16, 1, 32][..], &[137, 0], &[2, 0, 0, 135, 0], &[137, 132]].concat();
        for data in [flat, old, new] {
            let image = picture(HEADER, "-Y 1 +X 9", &data).unwrap();
            assert_eq!(reds(&image), [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 2.0]);
            for length in 0..data.len() {
                assert!(picture(HEADER, "-Y 1 +X 9", &data[..length]).is_err(), "{length}");
            }
        }
        // A count of two bytes, and pixels that look like the start of packed lines.
        let long = [&[16, 0, 0, 132, 1, 1, 1, 0][..], &[1, 1, 1, 1, 32, 0, 0, 132]].concat();
        assert_eq!(reds(&picture(HEADER, "-Y 1 +X 258", &long).unwrap())[255..], [1.0, 1.0, 2.0]);
        let dark = picture(HEADER, "-Y 1 +X 2", &[2, 2, 1, 136, 2, 2, 2, 136]).unwrap();
        assert_eq!(dark.rgb(0, 0), [2.0, 2.0, 1.0]);
        assert!(picture(HEADER, "-Y 1 +X 2", &[1, 1, 1, 1, 9, 9, 9, 9]).is_err());
        assert!(picture(HEADER, "-Y 1 +X 9", &[2, 2, 0, 9, 0]).is_err());
        assert!(picture(HEADER, "-Y 99999 +X 99999", &WHITE).is_err());
    }

    #[test]
    fn codes_are_written_as_they_are_read() {
        for pixel in [[128, 0, 1, 129], [255, 255, 255, 255], [0, 128, 0, 1], [0; 4], [200, 100, 50, 20]] {
            let image = picture(HEADER, "-Y 1 +X 1", &pixel).unwrap();
            assert_eq!(rgbe(image.rgb(0, 0)), pixel);
        }
        assert_eq!(rgbe([f32::NAN, -1.0, 0.0]), [0; 4]);
        assert_eq!(rgbe([f32::MAX, 0.0, f32::INFINITY]), [255, 0, 255, 255]);
        assert_eq!(rgbe([1e-45, 0.0, 0.0]), [0; 4]);
    }

    #[test]
    fn runs_are_written_as_they_are_read() {
        let values: [&[u8]; 6] = [
            &[1, 2, 3, 4, 5, 6, 7, 8, 9],
            &[1; 300],
            &[1, 1, 2, 2, 3, 3, 3, 3, 4, 5],
            &[1, 2, 2, 2, 2, 2, 2, 2],
            &std::array::from_fn::<u8, 255, _>(|i| i as u8),
            &[7; 3],
        ];
        for values in values {
            let image = Image::new(
                values.len() as u32,
                1,
                ["R", "G", "B"],
                Pixels::F32(values.iter().flat_map(|&v| [f32::from(v), 1.0, 0.0]).collect()),
            );
            let image = image.unwrap();
            let mut output = std::io::Cursor::new(Vec::new());
            encode(&image, &WriteOptions::default(), &mut output).unwrap();
            let bytes = output.into_inner();
            let read = decode(&bytes, &ReadOptions::default()).unwrap();
            assert_eq!(reds(&read), reds(&image));
            assert!(bytes.len() < 70 + 5 * values.len(), "{}", bytes.len());
        }
    }
}
