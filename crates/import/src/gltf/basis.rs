//! Images of Basis Universal in KTX2 files (`KHR_texture_basisu`), unpacked by the crate `basisu`.

use std::panic::{AssertUnwindSafe, catch_unwind};

#[cfg(feature = "basis")]
use basisu::{DecodeFlags, TargetFormat, Transcoder};
#[cfg(feature = "basis")]
use image::Pixels;
use image::{ColorEncoding, Image, ImageError};

/// The first bytes of a KTX2 file.
const MAGIC: &[u8] = b"\xabKTX 20\xbb\r\n\x1a\n";
/// Bytes of an unpacked image, for each byte of the file, and always.
const GREATEST_RATIO: u64 = 4096;
const ALWAYS_ALLOWED: u64 = 64 << 20;

/// Whether a file is in the container of this format.
pub(super) fn is_named_by(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// Reads the largest image of a file. Codes are of an encoding, whatever the file says.
pub(super) fn read(bytes: &[u8], encoding: ColorEncoding) -> Result<Image, ImageError> {
    check_size(bytes)?;
    // A panic in another crate must not end a render.
    catch_unwind(AssertUnwindSafe(|| unpack(bytes, encoding)))
        .unwrap_or_else(|_| Err(ImageError::Invalid("damaged KTX2 data".into())))
}

/// Refuses a header whose sizes are more than the file could hold.
fn check_size(bytes: &[u8]) -> Result<(), ImageError> {
    let int = |at: usize| bytes.get(at..)?.first_chunk().map(|bytes| u32::from_le_bytes(*bytes));
    let long = |at: usize| bytes.get(at..)?.first_chunk().map(|bytes| u64::from_le_bytes(*bytes));
    // Width and height, and what the first level becomes without its supercompression.
    let (Some(width), Some(height), Some(level)) = (int(20), int(24), long(96)) else {
        return Err(ImageError::Invalid("the file ends within its header".into()));
    };
    let needed = (u128::from(width) * u128::from(height) * 4).max(level.into());
    let limit = (bytes.len() as u64).saturating_mul(GREATEST_RATIO).max(ALWAYS_ALLOWED);
    if needed > limit.min(16 << 30).into() {
        let text = format!("{width} × {height} pixels in {} bytes", bytes.len());
        return Err(ImageError::Limits(text));
    }
    Ok(())
}

#[cfg(feature = "basis")]
fn unpack(bytes: &[u8], encoding: ColorEncoding) -> Result<Image, ImageError> {
    let refused = |error: basisu::Error| ImageError::Unsupported(format!("KTX2: {error:?}"));
    let texture = Transcoder::new(bytes).map_err(refused)?;
    let (width, height) = texture.base_dimensions();
    let mut codes = texture.transcode(0, TargetFormat::Rgba32, DecodeFlags::NONE).map_err(refused)?;
    if texture.has_alpha() {
        return Image::new(width, height, ["R", "G", "B", "A"], Pixels::U8(codes, encoding));
    }
    codes = codes.as_chunks::<4>().0.iter().flat_map(|&[r, g, b, _]| [r, g, b]).collect();
    Image::new(width, height, ["R", "G", "B"], Pixels::U8(codes, encoding))
}

#[cfg(not(feature = "basis"))]
fn unpack(_: &[u8], _: ColorEncoding) -> Result<Image, ImageError> {
    Err(ImageError::Unsupported(format!("KTX2 {}", super::document::built_without("basis"))))
}
