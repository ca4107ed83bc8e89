//! Pixel arrays, pyramids, file formats and error metrics.
//!
//! An [`Image`] is a rectangle of pixels with named channels, stored as 8-bit codes, half or single
//! floats; values read by [`Image::channel`] are always linear. Row 0 is the top row, x runs to the
//! right. [`read`] decodes a file's bytes, [`write`](write()) encodes by extension; a [`Pyramid`]
//! answers filtered lookups at texture coordinates; [`metrics`] and [`flip`] measure the difference
//! of two pictures; a [`Display`] turns linear colours into those of a display.

pub mod codec;
mod depth;
pub mod display;
mod encoding;
mod error;
pub mod false_color;
pub mod flip;
mod image;
mod memory;
mod metadata;
pub mod metrics;
mod projection;
mod pyramid;
mod resample;
mod source;
mod texels;
mod wrap;

pub use codec::{
    Format, ImageInfo, LayerInfo, ReadOptions, Sample, WriteOptions, encode, info, link_target, open, read,
    replace_file, replace_file_with, write,
};
pub use depth::SampleDepth;
pub use display::{Display, DisplaySettings, DisplayView, DisplayWhite};
pub use encoding::{ColorEncoding, linear_from_srgb, srgb_from_linear};
pub use error::ImageError;
pub use image::{Image, Pixels};
pub use memory::require_memory;
pub use metadata::{Attribute, Chromaticities, ImageMetadata, Window};
pub use projection::Projection;
pub use pyramid::{Pyramid, TextureFilter};
pub use source::{Channel, PixelSource};
pub use wrap::{EdgeMode, WrapMode};
