//! Radiance pictures: a text header, a line with the size and the order of pixels, then colours of
//! three bytes with a common exponent, packed in runs or not [Ward 1991].
//!
//! Values are radiance: `EXPOSURE` and `COLORCORR`, by which those of a file are multiplied, are
//! divided out. Signatures may name any program.

use super::ReadOptions;
use crate::{
    error::ImageError,
    image::{Image, Pixels},
    memory::filled,
    metadata::ImageMetadata,
};

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

fn invalid<T>(text: impl Into<String>) -> Result<T, ImageError> {
    Err(ImageError::Invalid(text.into()))
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

fn take<'a>(data: &mut &'a [u8], count: usize) -> Result<&'a [u8], ImageError> {
    let Some((taken, rest)) = data.split_at_checked(count) else { return invalid("the data ends early") };
    *data = rest;
    Ok(taken)
}

/// Reads a line of pixels: of runs for each component, if it begins with 2, 2 and its length, else
/// of pixels, where one of 1, 1, 1 repeats the one before.
fn read_line(data: &mut &[u8], line: &mut [[u8; 4]]) -> Result<(), ImageError> {
    if let [2, 2, high, low, ..] = **data
        && usize::from(u16::from_be_bytes([high, low])) == line.len()
        && (8..1 << 15).contains(&line.len())
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
}
