//! The pyramids of a scene's images, each made once.

use description::{Arena, ImageDesc, ImageTextureDesc};
use image::{Image, ImageError, Pyramid, WrapMode};
use std::sync::Arc;

/// What a pyramid depends on: the image, what lies beyond it and whether it keeps its colours.
type Key = (usize, description::WrapMode, bool);

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
        let key = (texture.image.index(), texture.wrap, in_color);
        if let Some((_, pyramid)) = self.made.iter().find(|(made, _)| *made == key) {
            return Ok(pyramid.clone());
        }
        let image = self.images[texture.image].image.clone();
        let image = if in_color { image } else { numbers(image) };
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

/// The one channel that stands for an image as numbers: its opacity where that is not one everywhere, else
/// the mean of red, green and blue.
fn numbers(image: Arc<Image>) -> Arc<Image> {
    if image.channel_count() == 1 {
        return image;
    }
    let (width, height) = (image.width(), image.height());
    let opacity = image
        .alpha_index()
        .filter(|&alpha| (0..height).any(|y| (0..width).any(|x| image.channel(x, y, alpha) != 1.0)));
    Arc::new(Image::from_fn(width, height, ["Y"], |x, y| match opacity {
        Some(alpha) => [image.channel(x, y, alpha)],
        None => [image.rgb(x, y).iter().sum::<f32>() / 3.0],
    }))
}
