//! The images of a file: decoded together, and changed where the description of a scene has no
//! other way to say what a material does with them.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use description::{Arena, Handle, ImageDesc};
use image::{ColorEncoding, Image, Pixels, ReadOptions};
use rayon::prelude::*;

use super::basis;
use super::buffer::Buffers;
use super::document::Document;
use super::json::{Fault, Place, Result};
use super::texture::TextureRef;
use super::uri;
use crate::log::Log;
use assets::AssetSource;

/// How the codes of an image are decoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Encoding {
    /// Colours, in sRGB.
    Color,
    /// Numbers, as they are.
    Data,
}

/// What is done to an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Edit {
    /// Nothing.
    None,
    /// Colours are multiplied.
    Tint([f32; 3]),
    /// Normals are turned away from the middle by a factor on x and on y.
    Normals([f32; 2]),
    /// The largest component of colours that are multiplied first.
    Largest([f32; 3]),
    /// Colours that are multiplied first, divided by their largest component.
    Hue([f32; 3]),
    /// Roughness (0) or anisotropy (1) of surfaces whose strength of anisotropy is blue times a
    /// factor, and their roughness a number.
    ByStrength(usize, f32, f32),
    /// The same of surfaces whose roughness is green times a factor, and their strength of
    /// anisotropy a number.
    ByRoughness(usize, f32, f32),
}

type Source = (usize, Encoding);

/// The images of a file.
pub(super) struct Pictures {
    decoded: HashMap<Source, Arc<Image>>,
    edited: HashMap<(Source, [bool; 2], String), Handle<ImageDesc>>,
    names: HashMap<usize, String>,
}

impl Pictures {
    /// Decodes images, each once. One that cannot be decoded is reported.
    pub fn decode(
        document: &Document,
        buffers: &Buffers,
        wanted: &[Source],
        path: &Path,
        assets: &dyn AssetSource,
        log: &mut Log,
    ) -> Self {
        let mut sources = wanted.to_vec();
        sources.sort_by_key(|&(image, encoding)| (image, encoding == Encoding::Data));
        sources.dedup();
        let mut names = HashMap::new();
        let read = sources.iter().filter_map(|&source| {
            let place = document.item("images", source.0)?;
            names.insert(source.0, name(&place, source.0));
            let bytes = bytes(&place, buffers, path, assets);
            Some((source, place.pointer, log.keep(bytes)?))
        });
        let read: Vec<_> = read.collect();
        let decoded: Vec<_> = read
            .par_iter()
            .map(|((_, encoding), _, bytes)| {
                let encoding = match encoding {
                    Encoding::Color => ColorEncoding::Srgb,
                    Encoding::Data => ColorEncoding::Linear,
                };
                if basis::is_named_by(bytes) {
                    return basis::read(bytes, encoding);
                }
                let options = ReadOptions { encoding: Some(encoding), ..ReadOptions::default() };
                image::read(bytes, "", &options)
            })
            .collect();
        let mut pictures = HashMap::new();
        for ((source, pointer, _), decoded) in read.into_iter().zip(decoded) {
            match decoded {
                Ok(image) => {
                    pictures.insert(source, Arc::new(image));
                }
                Err(error) => log.fault(unreadable(&pointer, &error)),
            }
        }
        Self { decoded: pictures, edited: HashMap::new(), names }
    }

    /// The decoded image of a texture.
    pub fn image(&self, texture: &TextureRef, encoding: Encoding) -> Option<&Arc<Image>> {
        self.decoded.get(&(texture.image, encoding))
    }

    /// The image of a texture in a scene, mirrored as the texture has it and changed by an edit.
    /// `None` if it cannot be decoded, which is reported already.
    pub fn add(
        &mut self,
        texture: &TextureRef,
        encoding: Encoding,
        edit: Edit,
        images: &mut Arena<ImageDesc>,
    ) -> Option<Handle<ImageDesc>> {
        let source = (texture.image, encoding);
        let key = (source, texture.mirrored, format!("{edit:?}"));
        if let Some(&handle) = self.edited.get(&key) {
            return Some(handle);
        }
        let mut image = self.decoded.get(&source)?.clone();
        if edit != Edit::None {
            image = Arc::new(edited(&image, edit));
        }
        if texture.mirrored != [false; 2] {
            image = Arc::new(mirrored(&image, texture.mirrored));
        }
        let name = self.names.get(&texture.image).cloned().unwrap_or_default();
        let handle = images.push(ImageDesc { name, image });
        self.edited.insert(key, handle);
        Some(handle)
    }
}

/// The name of an image in messages.
fn name(place: &Place, index: usize) -> String {
    let named = |key: &str| place.string(key).ok().flatten().filter(|name| !name.starts_with("data:"));
    named("uri").or_else(|| named("name")).map_or_else(|| format!("/images/{index}"), str::to_owned)
}

/// What is wrong with an image that no material uses. Its pixels are not decoded, and it may be of
/// a format that is not read.
pub(super) fn check(place: &Place, buffers: &Buffers, path: &Path, assets: &dyn AssetSource) -> Result<()> {
    let bytes = bytes(place, buffers, path, assets)?;
    match image::Format::from_content(&bytes) {
        Some(_) => image::info(&bytes, "").map(drop).map_err(|error| unreadable(&place.pointer, &error)),
        None => Ok(()),
    }
}

fn unreadable(pointer: &str, error: &image::ImageError) -> Fault {
    Fault::new("unreadable-image", pointer, format!("cannot read this image: {error}"))
}

/// The bytes of an image's file.
fn bytes(place: &Place, buffers: &Buffers, path: &Path, assets: &dyn AssetSource) -> Result<Vec<u8>> {
    match (place.string("uri")?, buffers.view(place, "bufferView")?) {
        (None, Some(view)) => Ok(view.bytes().to_vec()),
        (Some(uri), None) => uri::read(uri, path, assets)
            .map_err(|message| Fault::new("unreadable-image", place.pointer_to("uri"), message)),
        _ => Err(place.invalid("an image has either `uri` or `bufferView`")),
    }
}

fn edited(image: &Image, edit: Edit) -> Image {
    let (width, height) = (image.width(), image.height());
    let colors = |f: &dyn Fn([f32; 3]) -> [f32; 3]| {
        Image::from_fn(width, height, ["R", "G", "B"], |x, y| f(image.rgb(x, y))).to_f16()
    };
    let numbers = |f: &dyn Fn(u32, u32) -> f32| Image::from_fn(width, height, ["Y"], |x, y| [f(x, y)]);
    let largest = |[r, g, b]: [f32; 3]| r.max(g).max(b);
    match edit {
        Edit::None => image.clone(),
        Edit::Tint(tint) => colors(&|rgb| tinted(rgb, tint)),
        Edit::Normals([x, y]) => {
            let bent = |[r, g, b]: [f32; 3]| {
                let code = |v: f32, scale: f32| 0.5 + (v - 0.5) * scale;
                [code(r, x), code(g, y), b]
            };
            colors(&bent)
        }
        Edit::Largest(tint) => numbers(&|x, y| largest(tinted(image.rgb(x, y), tint))),
        Edit::Hue(tint) => colors(&|rgb| {
            let rgb = tinted(rgb, tint);
            let most = largest(rgb);
            rgb.map(|v| if most > 0.0 { v / most } else { 1.0 })
        }),
        Edit::ByStrength(result, factor, roughness) => {
            numbers(&|x, y| stretched(image.rgb(x, y)[2] * factor, roughness)[result])
        }
        Edit::ByRoughness(result, factor, strength) => {
            numbers(&|x, y| stretched(strength, image.rgb(x, y)[1] * factor)[result])
        }
    }
}

fn tinted(rgb: [f32; 3], tint: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|c| rgb[c] * tint[c])
}

/// Roughness and anisotropy of OpenPBR of a surface of a strength of anisotropy and a roughness of
/// glTF, so that α is the same along and across.
pub(super) fn stretched(strength: f32, roughness: f32) -> [f32; 2] {
    let across = (roughness * roughness).max(1e-6);
    let along = across + (1.0 - across) * strength * strength;
    let narrow = across / along;
    [(along * ((1.0 + narrow * narrow) / 2.0).sqrt()).sqrt(), 1.0 - narrow]
}

/// The image followed by its mirror image to the right and above.
pub(crate) fn mirrored(image: &Image, [across, up]: [bool; 2]) -> Image {
    let (width, height) = (image.width(), image.height());
    let count = image.channel_count();
    let columns = if across { 2 * width } else { width };
    let rows = if up { 2 * height } else { height };
    let sources = (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))).map(|(x, y)| {
        let x = if x < width { x } else { 2 * width - 1 - x };
        let y = if !up || y >= height { y % height } else { height - 1 - y };
        (y * width + x) as usize * count
    });
    let pixels = match image.pixels() {
        Pixels::U8(codes, encoding) => {
            Pixels::U8(sources.flat_map(|at| codes[at..at + count].iter().copied()).collect(), *encoding)
        }
        Pixels::F16(values) => {
            Pixels::F16(sources.flat_map(|at| values[at..at + count].iter().copied()).collect())
        }
        Pixels::F32(values) => {
            Pixels::F32(sources.flat_map(|at| values[at..at + count].iter().copied()).collect())
        }
    };
    Image::new(columns, rows, image.channels(), pixels).expect("invariant: as many pixels as the size says")
}
