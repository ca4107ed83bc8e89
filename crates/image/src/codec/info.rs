//! Information about a picture file: size, layers, channels, storage and header, for most formats
//! without decoding the pixels.

use std::collections::BTreeMap;
use std::fmt;
use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};

use exr::meta::attribute::SampleType;
use exr::meta::{BlockDescription, MetaData};

use super::raster::{Header, channel_names};
use super::{Format, ReadOptions, bmp, exr as open_exr, hdr, jpeg, pfm, png, qoi, tga, tiff, webp};
use crate::error::ImageError;
use crate::metadata::{Attribute, ImageMetadata, Window};

/// Information about a picture file.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageInfo {
    /// The file format.
    pub format: Format,
    /// The layers in the order of the file, at least one; only EXR files have several.
    pub layers: Vec<LayerInfo>,
    /// The full frame, of which the pixels may be a part.
    pub display_window: Window,
    /// Width of a pixel over its height.
    pub pixel_aspect: f32,
    /// The header's further attributes by name; of several EXR parts those of all, the first wins.
    pub attributes: BTreeMap<String, Attribute>,
}

/// A layer: channels with a common name before their last dot.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerInfo {
    /// The name, after the part's name where the file has several parts; empty for the main layer.
    pub name: String,
    /// Where its pixels lie in the frame.
    pub data_window: Window,
    /// The channels in the order of the file, with their full names.
    pub channels: Vec<(String, Sample)>,
    /// How its pixels are packed, where the format has a choice or a method of its own.
    pub compression: Option<&'static str>,
    /// Width and height of tiles; `None` for scan lines.
    pub tiles: Option<[u32; 2]>,
}

/// How one value of a channel is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sample {
    /// An integer with this number of bits.
    Integer(u32),
    /// A floating-point number with this number of bits.
    Float(u32),
    /// Eight bits, and an exponent shared by the channels of a pixel.
    SharedExponent,
}

impl fmt::Display for Sample {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Integer(bits) => write!(f, "{bits}-bit integer"),
            Self::Float(bits) => write!(f, "{bits}-bit float"),
            Self::SharedExponent => f.write_str("8-bit with shared exponent"),
        }
    }
}

/// Reads the information about a picture from the bytes of its file. `name` is used where the
/// content does not determine the format, and may be empty.
///
/// # Errors
/// As those of [`read`](super::read); the pixels of most formats are not checked.
pub fn info(bytes: &[u8], name: &str) -> Result<ImageInfo, ImageError> {
    let format = Format::of(bytes, name)?;
    let inspect = || match format {
        Format::Exr => exr_info(bytes),
        Format::Pfm => {
            let image = pfm::decode(bytes, &ReadOptions::default())?;
            let channels = image.channels().iter().map(|name| (name.clone(), Sample::Float(32))).collect();
            Ok(single_layer(format, [image.width(), image.height()], channels))
        }
        Format::Hdr => {
            let channels = ["R", "G", "B"].map(|name| (name.to_owned(), Sample::SharedExponent));
            Ok(single_layer(format, hdr::size(bytes)?, channels.into()))
        }
        Format::Tiff => {
            let mut file = tiff::Tiff::open(bytes)?;
            let (bits, is_float) = file.sample()?;
            let sample = if is_float { Sample::Float(bits) } else { Sample::Integer(bits) };
            let channels = file.channels().iter().map(|&name| (name.to_owned(), sample)).collect();
            Ok(single_layer(format, file.size(), channels))
        }
        Format::Png => Ok(raster_info(format, png::header(bytes)?)),
        Format::Jpeg => Ok(raster_info(format, jpeg::header(bytes)?)),
        Format::Tga => Ok(raster_info(format, tga::header(bytes)?)),
        Format::Bmp => Ok(raster_info(format, bmp::header(bytes)?)),
        Format::Qoi => Ok(raster_info(format, qoi::header(bytes)?)),
        Format::Webp => Ok(raster_info(format, webp::header(bytes)?)),
    };
    // As in `read`: the decoders of other crates may panic on damaged files.
    catch_unwind(AssertUnwindSafe(inspect))
        .unwrap_or_else(|_| Err(ImageError::Invalid(format!("damaged {format:?} data"))))
}

fn single_layer(format: Format, [width, height]: [u32; 2], channels: Vec<(String, Sample)>) -> ImageInfo {
    let window = Window::of_size(width, height);
    let compression = match format {
        Format::Png => Some("DEFLATE"),
        Format::Jpeg => Some("DCT, lossy"),
        Format::Qoi => Some("QOI"),
        Format::Webp => Some("WebP"),
        _ => None,
    };
    let layer = LayerInfo { name: String::new(), data_window: window, channels, compression, tiles: None };
    ImageInfo {
        format,
        layers: vec![layer],
        display_window: window,
        pixel_aspect: 1.0,
        attributes: BTreeMap::new(),
    }
}

fn raster_info(format: Format, header: Header) -> ImageInfo {
    let sample = Sample::Integer(header.bits);
    let channels = channel_names(header.channels).iter().map(|&name| (name.to_owned(), sample)).collect();
    single_layer(format, header.size, channels)
}

fn exr_info(bytes: &[u8]) -> Result<ImageInfo, ImageError> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(open_exr::from_library)?;
    let mut layers: Vec<LayerInfo> = Vec::new();
    let mut header = ImageMetadata::default();
    for part in meta.headers.iter().rev() {
        let attributes = std::mem::take(&mut header.attributes);
        header = open_exr::metadata(part);
        for (name, value) in attributes {
            header.attributes.entry(name).or_insert(value);
        }
    }
    for part in &meta.headers {
        let part_name = part.own_attributes.layer_name.as_ref().map(open_exr::from_text).unwrap_or_default();
        let first = layers.len();
        for channel in &part.channels.list {
            let full = open_exr::from_text(&channel.name);
            let prefix = full.rsplit_once('.').map_or("", |(layer, _)| layer);
            let name = match (part_name.as_str(), prefix) {
                ("", name) | (name, "") => name.to_owned(),
                (part, layer) if part == layer => layer.to_owned(),
                (part, layer) => format!("{part}.{layer}"),
            };
            let sample = match channel.sample_type {
                SampleType::F16 => Sample::Float(16),
                SampleType::F32 => Sample::Float(32),
                SampleType::U32 => Sample::Integer(32),
            };
            match layers[first..].iter_mut().find(|layer| layer.name == name) {
                Some(layer) => layer.channels.push((full, sample)),
                None => layers.push(LayerInfo {
                    name,
                    data_window: open_exr::from_bounds(part.data_window()),
                    channels: vec![(full, sample)],
                    compression: Some(compression(part.compression)),
                    tiles: match part.blocks {
                        BlockDescription::ScanLines => None,
                        BlockDescription::Tiles(tiles) => {
                            Some([tiles.tile_size.width() as u32, tiles.tile_size.height() as u32])
                        }
                    },
                }),
            }
        }
    }
    Ok(ImageInfo {
        format: Format::Exr,
        layers,
        display_window: header.display_window.unwrap_or(Window::of_size(0, 0)),
        pixel_aspect: header.pixel_aspect,
        attributes: header.attributes,
    })
}

/// The name of a compression method in the format's documents.
fn compression(method: exr::compression::Compression) -> &'static str {
    use exr::compression::Compression::*;
    match method {
        Uncompressed => "none",
        RLE => "RLE",
        ZIP1 => "ZIPS",
        ZIP16 => "ZIP",
        PIZ => "PIZ",
        PXR24 => "PXR24",
        B44 => "B44",
        B44A => "B44A",
        DWAA(_) => "DWAA",
        DWAB(_) => "DWAB",
        HTJ2K32 => "HTJ2K32",
        HTJ2K256 => "HTJ2K256",
    }
}
