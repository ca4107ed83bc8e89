//! Pyramids of images.
//!
//! | words | what |
//! |---|---|
//! | 0 | the number of levels |
//! | 1 | how values are stored |
//! | 2 | values a pixel |
//! | 3–5 | which of them are red, green and blue |
//! | 6 | lookups beyond the edges; by axis, those of columns from bit 4 on, of rows from bit 6 on |
//! | 7 | of bytes, the offset of the 256 numbers that they stand for |
//! | 8… | for each level where it begins in the buffer of texels, its width, its height, and 0 |
//!
//! Texels are stored as in the image, as many values a word as it holds, the first one lowest.
//!
//! An image over (u, v), of emission or of normals, is a pyramid of one level, 1 where the nearest
//! texel is seen, two zeros, and three columns of a matrix.

use std::collections::HashMap;
use std::sync::Arc;

use description::Span;
use image::{ColorEncoding, EdgeMode, Image, Pixels, WrapMode};
use scene::texture::UvLookup;

use super::Flattener;
use crate::tags::{StorageTag, WrapTag};

/// The buffer of texels, and where each image begins in it, by its address.
#[derive(Default)]
pub struct Texels {
    pub words: Vec<u32>,
    images: HashMap<usize, u32>,
}

impl Flattener<'_> {
    /// An image over (u, v), which a thing at `span` has; its offset.
    pub fn uv_image(&mut self, image: &Arc<Image>, lookup: &UvLookup, span: Span) -> u32 {
        let pyramid = self.image(std::slice::from_ref(image), lookup.wrap, span);
        let at = self.slab.add([pyramid, lookup.is_nearest.into(), 0, 0]);
        self.slab.extend_numbers(lookup.columns.iter().flat_map(|column| column.to_array()));
        at
    }

    /// The levels of an image, the largest first, which a thing at `span` has; their offset.
    pub fn image(&mut self, levels: &[Arc<Image>], wrap: WrapMode, span: Span) -> u32 {
        let image = &levels[0];
        let [red, green, blue] = image.color_channels();
        // The codes of opacity are linear.
        let is_opacity = image.alpha_index() == Some(red);
        let (format, decoded) = match image.pixels() {
            Pixels::U8(_, encoding) => {
                let encoding = if is_opacity { ColorEncoding::Linear } else { *encoding };
                (StorageTag::Bytes, self.slab.add_numbers(encoding.table()))
            }
            Pixels::F16(_) => (StorageTag::Halves, 0),
            Pixels::F32(_) => (StorageTag::Floats, 0),
        };
        let wrap = match wrap {
            WrapMode::Repeat => WrapTag::Repeat as u32,
            WrapMode::Black => WrapTag::Black as u32,
            WrapMode::Clamp => WrapTag::Clamp as u32,
            WrapMode::OctahedralSphere => WrapTag::Sphere as u32,
            WrapMode::LatitudeLongitude => WrapTag::LatitudeLongitude as u32,
            WrapMode::Axes(axes) => {
                let [across, down] = axes.map(edge);
                WrapTag::Axes as u32 | across << 4 | down << 6
            }
        };
        let channels = [image.channel_count(), red, green, blue].map(|n| n as u32);
        let mut words = vec![levels.len() as u32, format as u32];
        words.extend(channels.into_iter().chain([wrap, decoded]));
        for level in levels {
            words.extend([self.texels(level, span), level.width(), level.height(), 0]);
        }
        self.slab.add(words)
    }

    /// Where an image begins in the buffer of texels.
    fn texels(&mut self, image: &Arc<Image>, span: Span) -> u32 {
        let address = Arc::as_ptr(image) as usize;
        if let Some(&at) = self.texels.images.get(&address) {
            return at;
        }
        if self.texels.words.len() * 4 + image.byte_size() > self.largest_buffer {
            let megabytes = self.largest_buffer >> 20;
            self.refuse(format!("images of more than {megabytes} MiB together"), span);
            return 0;
        }
        let at = self.texels.words.len() as u32;
        match image.pixels() {
            Pixels::U8(codes, _) => {
                let word =
                    |bytes: &[u8]| bytes.iter().rev().fold(0, |word, &byte| word << 8 | u32::from(byte));
                self.texels.words.extend(codes.chunks(4).map(word));
            }
            Pixels::F16(halves) => {
                let bits = |half: Option<&half::f16>| half.map_or(0, |half| u32::from(half.to_bits()));
                self.texels
                    .words
                    .extend(halves.chunks(2).map(|pair| bits(pair.first()) | bits(pair.get(1)) << 16));
            }
            Pixels::F32(floats) => self.texels.words.extend(floats.iter().map(|x| x.to_bits())),
        }
        self.texels.images.insert(address, at);
        at
    }
}

fn edge(mode: EdgeMode) -> u32 {
    match mode {
        EdgeMode::Repeat => WrapTag::Repeat as u32,
        EdgeMode::Black => WrapTag::Black as u32,
        EdgeMode::Clamp => WrapTag::Clamp as u32,
    }
}
