//! Thumbnails: the pictures by which the index and README show pages.

use std::fs;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::codec::ReadOptions;
use image::{ColorEncoding, Pixels, WrapMode};
use jpeg_encoder::{ColorType, Encoder};

use super::figure::Drawn;

/// Pixels of a thumbnail; a picture of another shape loses its edges.
const SIZE: [u32; 2] = [216, 144];
const QUALITY: u8 = 80;

/// Makes the thumbnail of a picture, unless that is a drawing of lines.
pub fn write(drawn: &Drawn, path: &Path) -> Result<(), String> {
    let Some(encoded) = drawn.picture.strip_prefix("image/jpeg;base64,") else { return Ok(()) };
    let bytes = STANDARD.decode(encoded).map_err(|error| error.to_string())?;
    let wrong = |error: image::ImageError| error.to_string();
    let whole = image::codec::read(&bytes, "", &ReadOptions::default()).map_err(wrong)?;
    let [width, height] = SIZE;
    let scale = (width as f32 / whole.width() as f32).max(height as f32 / whole.height() as f32);
    let [wide, high] = [whole.width(), whole.height()].map(|side| (side as f32 * scale).round() as u32);
    let small = whole.resize(wide, high, WrapMode::Clamp).map_err(wrong)?.to_u8(ColorEncoding::Srgb);
    let Pixels::U8(codes, _) = small.pixels() else { return Err("no codes of 8 bits".into()) };
    let [x, y] = [(wide - width) / 2, (high - height) / 2].map(|side| side as usize);
    let rows = codes.chunks_exact(3 * wide as usize).skip(y).take(height as usize);
    let cropped: Vec<u8> = rows.flat_map(|row| &row[3 * x..][..3 * width as usize]).copied().collect();
    let mut jpeg = Vec::new();
    Encoder::new(&mut jpeg, QUALITY)
        .encode(&cropped, width as u16, height as u16, ColorType::Rgb)
        .map_err(|error| error.to_string())?;
    let folder = path.parent().unwrap_or(path);
    fs::create_dir_all(folder)
        .and_then(|()| fs::write(path, jpeg))
        .map_err(|error| format!("{}: {error}", path.display()))
}
