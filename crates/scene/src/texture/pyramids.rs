//! The pyramids of a scene's images, each made once.

use description::{Arena, ImageDesc, ImageTextureDesc, TextureFilter};
use image::{Image, ImageError, Pixels, Pyramid, WrapMode};
use std::sync::Arc;

/// What a pyramid depends on: the image, what lies beyond it and, for one of numbers, what they
/// are.
type Key = (usize, description::WrapMode, Option<Numbers>);

/// Which numbers stand for an image of several channels. The pbrt-v4 format takes one or the other
/// with the filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Numbers {
    /// Opacity where that is not one everywhere, else the mean of red, green and blue: for filters
    /// that interpolate.
    OpacityOrMean,
    /// The first channel: for filters that take single texels.
    First,
}

/// Makes pyramids of images, and remembers them.
pub(super) struct Pyramids<'a> {
    images: &'a Arena<ImageDesc>,
    made: Vec<(Key, Arc<Pyramid>)>,
}

impl<'a> Pyramids<'a> {
    pub fn new(images: &'a Arena<ImageDesc>) -> Self {
        Self { images, made: Vec::new() }
    }

    /// The pyramid for a texture, of colours or of numbers.
    pub fn get(&mut self, texture: &ImageTextureDesc, in_color: bool) -> Result<Arc<Pyramid>, ImageError> {
        let numbers = (!in_color).then_some(match texture.filter {
            TextureFilter::Point | TextureFilter::Ewa => Numbers::First,
            TextureFilter::Bilinear | TextureFilter::Trilinear => Numbers::OpacityOrMean,
        });
        let key = (texture.image.index(), texture.wrap, numbers);
        if let Some((_, pyramid)) = self.made.iter().find(|(made, _)| *made == key) {
            return Ok(pyramid.clone());
        }
        let image = self.images[texture.image].image.clone();
        let image = numbers.map_or(image.clone(), |numbers| numbers.of(image));
        let wrap = match texture.wrap {
            description::WrapMode::Repeat => WrapMode::Repeat,
            description::WrapMode::Black => WrapMode::Black,
            description::WrapMode::Clamp => WrapMode::Clamp,
            description::WrapMode::OctahedralSphere => WrapMode::OctahedralSphere,
        };
        let pyramid = Arc::new(Pyramid::new(image, wrap)?);
        self.made.push((key, pyramid.clone()));
        Ok(pyramid)
    }
}

impl Numbers {
    /// The one channel that stands for an image.
    fn of(self, image: Arc<Image>) -> Arc<Image> {
        if image.channel_count() == 1 {
            return image;
        }
        // The opacity of a grey image is not looked at.
        let opacity = image.alpha_index().filter(|_| self == Self::OpacityOrMean && image.is_color());
        let opacity = opacity.map(|channel| {
            Image::from_fn(image.width(), image.height(), ["Y"], |x, y| {
                [decoded_opacity(&image, image.channel(x, y, channel))]
            })
        });
        if let Some(opacity) = opacity.filter(|opacity| opacity.values().any(|value| value != 1.0)) {
            return Arc::new(opacity);
        }
        Arc::new(Image::from_fn(image.width(), image.height(), ["Y"], |x, y| {
            let [r, g, b] = image.rgb(x, y);
            [if self == Self::First { r } else { (r + g + b) / 3.0 }]
        }))
    }
}

/// Opacity as the pbrt-v4 format reads it from 8-bit images: decoded as if it were a colour.
fn decoded_opacity(image: &Image, opacity: f32) -> f32 {
    match image.pixels() {
        Pixels::U8(_, encoding) => encoding.to_linear(opacity),
        Pixels::F16(_) | Pixels::F32(_) => opacity,
    }
}
