//! The images of a scene, decoded when they are first used, and changed where the description of a
//! scene has no other way to say what a material does with them.

use std::collections::HashMap;
use std::sync::Arc;

use description::{Arena, Handle, ImageDesc};
use image::{ColorEncoding, Image, Pixels, ReadOptions};

use super::files::Files;
use super::texture::{Space, Texture};
use crate::gltf::mirrored;
use crate::log::{Fault, Log};

/// What is done to an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Edit {
    None,
    /// Colours are multiplied and moved.
    Color([f64; 3], [f64; 3]),
    /// A channel is multiplied and moved, and is then all that there is.
    Number(usize, f64, f64),
    /// Codes of normals, from −1 to 1 by what multiplies and moves them; y may be mirrored.
    Normals([f64; 3], [f64; 3], bool),
}

/// The images of a scene.
#[derive(Default)]
pub(super) struct Pictures {
    decoded: HashMap<(String, Space), Option<Arc<Image>>>,
    edited: HashMap<(String, Space, [bool; 2], String), Handle<ImageDesc>>,
}

impl Pictures {
    /// The image of a texture; `None` if it cannot be read, which is reported.
    pub fn image(&mut self, texture: &Texture, files: &Files, log: &mut Log) -> Option<Arc<Image>> {
        let key = (texture.file.clone().unwrap_or_else(|name| name), texture.space);
        if let Some(known) = self.decoded.get(&key) {
            return known.clone();
        }
        let fault = |message: String| Fault::new("unreadable-image", &texture.place, message);
        let read = match &texture.file {
            Err(name) if name.is_empty() => Err(fault("the texture has no image".to_owned())),
            Err(name) if name.contains("<UDIM>") => {
                Err(fault(format!("tiles of images are not read: `{name}`")))
            }
            Err(name) => Err(fault(format!("there is no image `{name}`"))),
            Ok(name) => files.read(name).map_err(|error| fault(format!("cannot read `{name}`: {error}"))),
        };
        let encoding = match texture.space {
            Space::Auto => None,
            Space::Raw => Some(ColorEncoding::Linear),
            Space::Srgb => Some(ColorEncoding::Srgb),
        };
        let decoded = read.and_then(|bytes| {
            let options = ReadOptions { encoding, ..ReadOptions::default() };
            image::read(&bytes, &key.0, &options)
                .map_err(|error| fault(format!("cannot read the image `{}`: {error}", key.0)))
        });
        let image = log.keep(decoded).map(Arc::new);
        self.decoded.insert(key, image.clone());
        image
    }

    /// The image of a texture in a scene, mirrored as the texture has it and changed.
    pub fn add(
        &mut self,
        texture: &Texture,
        edit: Edit,
        images: &mut Arena<ImageDesc>,
        files: &Files,
        log: &mut Log,
    ) -> Option<Handle<ImageDesc>> {
        let mut image = self.image(texture, files, log)?;
        let name = texture.file.clone().unwrap_or_default();
        let key = (name.clone(), texture.space, texture.mirrored, format!("{edit:?}"));
        if let Some(&known) = self.edited.get(&key) {
            return Some(known);
        }
        if edit != Edit::None {
            image = Arc::new(edited(&image, edit));
        }
        if texture.mirrored != [false; 2] {
            image = Arc::new(mirrored(&image, texture.mirrored));
        }
        let handle = images.push(ImageDesc { name, image });
        self.edited.insert(key, handle);
        Some(handle)
    }
}

fn edited(image: &Image, edit: Edit) -> Image {
    let (width, height) = (image.width(), image.height());
    let moved = |rgb: [f32; 3], scale: [f64; 3], bias: [f64; 3]| {
        std::array::from_fn::<f32, 3, _>(|i| (f64::from(rgb[i]) * scale[i] + bias[i]) as f32)
    };
    match edit {
        Edit::None => image.clone(),
        Edit::Color(scale, bias) => Image::from_fn(width, height, ["R", "G", "B"], |x, y| {
            moved(image.rgb(x, y), scale, bias).map(|v| v.max(0.0))
        })
        .to_f16(),
        Edit::Number(channel, scale, bias) => Image::from_fn(width, height, ["Y"], |x, y| {
            let value = match channel {
                3 => alpha(image, x, y),
                channel => image.rgb(x, y)[channel],
            };
            [(f64::from(value) * scale + bias) as f32]
        }),
        Edit::Normals(scale, bias, is_mirrored) => Image::from_fn(width, height, ["R", "G", "B"], |x, y| {
            let [x, y, z] = moved(image.rgb(x, y), scale, bias);
            [x, if is_mirrored { -y } else { y }, z].map(|v| 0.5 + v / 2.0)
        }),
    }
}

/// The opacity of a pixel.
fn alpha(image: &Image, x: u32, y: u32) -> f32 {
    let Some(index) = image.alpha_index() else { return 1.0 };
    let at = (y as usize * image.width() as usize + x as usize) * image.channel_count() + index;
    match image.pixels() {
        Pixels::U8(codes, _) => f32::from(codes[at]) / 255.0,
        Pixels::F16(values) => values[at].to_f32(),
        Pixels::F32(values) => values[at],
    }
}
