//! Images named by scenes, decoded by the `image` crate; photometric files become images, too.

use std::path::Path;

use description::EncodingDesc;
use image::{ColorEncoding, Image, Pixels, ReadOptions};

use crate::ies;
use crate::source::AssetSource;

/// Reads and decodes an image file; on failure, the reason.
pub fn decode_image(
    assets: &dyn AssetSource,
    path: &Path,
    encoding: Option<EncodingDesc>,
) -> Result<Image, String> {
    let bytes = assets.read(path).map_err(|error| error.to_string())?;
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("ies")) {
        return ies::read(&bytes);
    }
    let encoding = encoding.map(|encoding| match encoding {
        EncodingDesc::Linear => ColorEncoding::Linear,
        EncodingDesc::Srgb => ColorEncoding::Srgb,
        EncodingDesc::Gamma(exponent) => ColorEncoding::Gamma(exponent),
    });
    let options = ReadOptions { encoding, ..ReadOptions::default() };
    image::read(&bytes, &path.to_string_lossy(), &options).map_err(|error| error.to_string())
}

/// The substitute for an image that cannot be read.
pub fn black_pixel() -> Image {
    Image::new(1, 1, ["R", "G", "B"], Pixels::F32(vec![0.0; 3]))
        .expect("invariant: one pixel of three values")
}
