//! Images as textures.
//!
//! Texture coordinates have (0, 0) at the lower left of the image and t upwards, pixels are counted
//! from the top: a lookup is at (s, 1 − t). The pyramid averages over the footprint; what it finds
//! is multiplied by `scale` and, where `invert` is set, taken from one; negative results become
//! zero.
//!
//! Source: [Pharr 2023 §10.4].

use super::{Mapping2d, SpectrumType, TextureContext};
use image::{Pyramid, TextureFilter};
use math::Vec2;
use spectrum::{Rgb, RgbColorSpace, SampledSpectrum, SampledWavelengths};
use std::sync::Arc;

/// What images of numbers and of colours share.
#[derive(Clone, Debug)]
pub struct ImageLookup {
    /// Where on the image a point lies.
    pub mapping: Mapping2d,
    /// The image and its averages.
    pub pyramid: Arc<Pyramid>,
    /// How texels are joined.
    pub filter: TextureFilter,
    /// Factor on the values.
    pub scale: f32,
    /// One minus the scaled value.
    pub invert: bool,
}

impl ImageLookup {
    /// Where the pyramid is looked up: the position, and how it changes with film x and y.
    fn position(&self, ctx: &TextureContext) -> [Vec2; 3] {
        let c = self.mapping.map(ctx);
        [Vec2::new(c.st.x, 1.0 - c.st.y), c.dstdx, c.dstdy]
    }
}

/// An image of numbers: the pyramid's first channel.
#[derive(Clone, Debug)]
pub struct FloatImage {
    /// Where and how the image is looked up.
    pub lookup: ImageLookup,
}

impl FloatImage {
    /// The number at a point.
    pub fn evaluate(&self, ctx: &TextureContext) -> f32 {
        let [st, dst0, dst1] = self.lookup.position(ctx);
        let value = self.lookup.scale * self.lookup.pyramid.lookup(st, dst0, dst1, self.lookup.filter);
        if self.lookup.invert { (1.0 - value).max(0.0) } else { value }
    }
}

/// An image of colours.
#[derive(Clone, Debug)]
pub struct SpectrumImage {
    /// Where and how the image is looked up.
    pub lookup: ImageLookup,
    /// The colour space of the pixels.
    pub space: &'static RgbColorSpace,
    /// What the colours stand for.
    pub spectrum_type: SpectrumType,
}

impl SpectrumImage {
    /// The spectrum at a point.
    pub fn evaluate(&self, ctx: &TextureContext, lambda: &SampledWavelengths) -> SampledSpectrum {
        let [st, dst0, dst1] = self.lookup.position(ctx);
        let pixel = self.lookup.pyramid.lookup_rgb(st, dst0, dst1, self.lookup.filter);
        let scaled = Rgb::from(pixel) * self.lookup.scale;
        let rgb = if self.lookup.invert { Rgb::splat(1.0) - scaled } else { scaled };
        self.spectrum_type.from_rgb(self.space, rgb.clamp_zero()).sample(lambda)
    }
}
