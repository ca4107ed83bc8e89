//! The image pyramids of a scene, each built once.

use description::{Arena, ImageChannel, ImageDesc, ImageTextureDesc, TextureFilter};
use image::{Image, ImageError, Pixels, Pyramid};
use std::collections::HashMap;
use std::sync::Arc;

use super::uv_lookup::wrap_mode;

/// What a pyramid depends on: the image, the wrap mode and, for numbers, the channel.
type Key = (usize, description::WrapMode, Option<NumberSource>);

/// How the numbers of a texture are computed from an image of several channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum NumberSource {
    /// Opacity, or the mean of red, green and blue if opacity is one everywhere: pbrt-v4's choice
    /// for filters that interpolate.
    OpacityOrMean,
    /// The first channel: pbrt-v4's choice for filters of single texels.
    First,
    /// The channel that the description names.
    Channel(ImageChannel),
}

/// Builds and caches pyramids of images.
pub(super) struct Pyramids<'a> {
    images: &'a Arena<ImageDesc>,
    made: HashMap<Key, u32>,
}

impl<'a> Pyramids<'a> {
    pub fn new(images: &'a Arena<ImageDesc>) -> Self {
        Self { images, made: HashMap::new() }
    }

    /// The index in `pyramids` of the pyramid for a texture of colours or of numbers.
    pub fn get(
        &mut self,
        texture: &ImageTextureDesc,
        in_color: bool,
        pyramids: &mut Vec<Arc<Pyramid>>,
    ) -> Result<u32, ImageError> {
        let numbers = (!in_color).then_some(match (texture.channel, texture.filter) {
            (Some(channel), _) => NumberSource::Channel(channel),
            (None, TextureFilter::Point | TextureFilter::Ewa) => NumberSource::First,
            (None, TextureFilter::Bilinear | TextureFilter::Trilinear) => NumberSource::OpacityOrMean,
        });
        let key = (texture.image.index(), texture.wrap, numbers);
        if let Some(&index) = self.made.get(&key) {
            return Ok(index);
        }
        let image = self.images[texture.image].image.clone();
        let image = match numbers {
            Some(numbers) => numbers.extract(image)?,
            None => image,
        };
        let index = pyramids.len() as u32;
        pyramids.push(Arc::new(Pyramid::new(image, wrap_mode(texture.wrap))?));
        self.made.insert(key, index);
        Ok(index)
    }
}

impl NumberSource {
    /// An image with these numbers of `image` as its only channel.
    fn extract(self, image: Arc<Image>) -> Result<Arc<Image>, ImageError> {
        let single = |value: &dyn Fn(u32, u32) -> f32| {
            Image::try_from_fn(image.width(), image.height(), ["Y"], |x, y| [value(x, y)]).map(Arc::new)
        };
        let color = |c: usize| single(&|x, y| image.rgb(x, y)[c]);
        match (self, image.alpha_index()) {
            (Self::Channel(ImageChannel::Alpha), Some(alpha)) => single(&|x, y| image.channel(x, y, alpha)),
            (Self::Channel(ImageChannel::Alpha), None) => {
                Err(ImageError::Invalid("there is no channel of opacity".into()))
            }
            _ if image.channel_count() == 1 => Ok(image),
            (Self::First | Self::Channel(ImageChannel::Red), _) => color(0),
            (Self::Channel(ImageChannel::Green), _) => color(1),
            (Self::Channel(ImageChannel::Blue), _) => color(2),
            (Self::OpacityOrMean, alpha) => {
                // The opacity of a grey image is ignored.
                let alpha = alpha.filter(|_| image.is_color());
                let opacity = alpha
                    .map(|alpha| single(&|x, y| decoded_opacity(&image, image.channel(x, y, alpha))))
                    .transpose()?;
                match opacity.filter(|opacity| opacity.values().any(|value| value != 1.0)) {
                    Some(opacity) => Ok(opacity),
                    None => single(&|x, y| {
                        let [r, g, b] = image.rgb(x, y);
                        (r + g + b) / 3.0
                    }),
                }
            }
        }
    }
}

/// Opacity of 8-bit images as in pbrt-v4: decoded as if it were a colour.
fn decoded_opacity(image: &Image, opacity: f32) -> f32 {
    match image.pixels() {
        Pixels::U8(_, encoding) => encoding.to_linear(opacity),
        Pixels::F16(_) | Pixels::F32(_) => opacity,
    }
}
