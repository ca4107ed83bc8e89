//! The pyramids of a scene's images, each made once.

use description::{Arena, ImageChannel, ImageDesc, ImageTextureDesc, TextureFilter};
use image::{Image, ImageError, Pixels, Pyramid, WrapMode};
use std::collections::HashMap;
use std::sync::Arc;

/// What a pyramid depends on: the image, what lies beyond it and, for one of numbers, what they
/// are.
type Key = (usize, description::WrapMode, Option<Numbers>);

/// Which numbers stand for an image of several channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Numbers {
    /// Opacity where that is not one everywhere, else the mean of red, green and blue: what the
    /// pbrt-v4 format reads with filters that interpolate.
    OpacityOrMean,
    /// The first channel: what the pbrt-v4 format reads with filters that take single texels.
    First,
    /// The channel that the scene names.
    Channel(ImageChannel),
}

/// Makes pyramids of images, and remembers them.
pub(super) struct Pyramids<'a> {
    images: &'a Arena<ImageDesc>,
    made: HashMap<Key, u32>,
}

impl<'a> Pyramids<'a> {
    pub fn new(images: &'a Arena<ImageDesc>) -> Self {
        Self { images, made: HashMap::new() }
    }

    /// The index in `pyramids` of the pyramid for a texture, of colours or of numbers.
    pub fn get(
        &mut self,
        texture: &ImageTextureDesc,
        in_color: bool,
        pyramids: &mut Vec<Arc<Pyramid>>,
    ) -> Result<u32, ImageError> {
        let numbers = (!in_color).then_some(match (texture.channel, texture.filter) {
            (Some(channel), _) => Numbers::Channel(channel),
            (None, TextureFilter::Point | TextureFilter::Ewa) => Numbers::First,
            (None, TextureFilter::Bilinear | TextureFilter::Trilinear) => Numbers::OpacityOrMean,
        });
        let key = (texture.image.index(), texture.wrap, numbers);
        if let Some(&index) = self.made.get(&key) {
            return Ok(index);
        }
        let image = self.images[texture.image].image.clone();
        let image = match numbers {
            Some(numbers) => numbers.of(image)?,
            None => image,
        };
        let wrap = match texture.wrap {
            description::WrapMode::Repeat => WrapMode::Repeat,
            description::WrapMode::Black => WrapMode::Black,
            description::WrapMode::Clamp => WrapMode::Clamp,
            description::WrapMode::OctahedralSphere => WrapMode::OctahedralSphere,
        };
        let index = pyramids.len() as u32;
        pyramids.push(Arc::new(Pyramid::new(image, wrap)?));
        self.made.insert(key, index);
        Ok(index)
    }
}

impl Numbers {
    /// An image of the one channel that stands for `image`.
    fn of(self, image: Arc<Image>) -> Result<Arc<Image>, ImageError> {
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
                // The opacity of a grey image does not count.
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

/// Opacity as the pbrt-v4 format reads it from 8-bit images: decoded as if it were a colour.
fn decoded_opacity(image: &Image, opacity: f32) -> f32 {
    match image.pixels() {
        Pixels::U8(_, encoding) => encoding.to_linear(opacity),
        Pixels::F16(_) | Pixels::F32(_) => opacity,
    }
}
