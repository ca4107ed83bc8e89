//! Images as textures.
//!
//! Texture coordinates have (0, 0) at the lower left of the image and t upwards; pixels are counted
//! from the top: a lookup is at (s, 1 − t). The pyramid averages over the footprint; the result is
//! multiplied by `scale` and, where `invert` is set, subtracted from one; negative results become
//! zero.
//!
//! Source: [Pharr 2023 §10.4].

use super::{Mapping2d, SpectrumType, TextureContext};
use image::{Pyramid, TextureFilter};
use lanes::{Each, Real};
use math::Vec2;
use spectrum::{RgbColorSpace, SampledSpectrum, SampledWavelengths};

/// A filtered lookup in an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageLookup {
    /// Index of the map to the image in [`Textures::mappings`](super::Textures::mappings).
    pub mapping: u32,
    /// Index of the image in [`Textures::pyramids`](super::Textures::pyramids).
    pub pyramid: u32,
    /// Reconstruction filter.
    pub filter: TextureFilter,
    /// Factor on the values.
    pub scale: f32,
    /// Whether the result is one minus the scaled value.
    pub invert: bool,
}

impl ImageLookup {
    /// The number at a point: that of the image's first channel.
    #[inline(always)]
    pub(super) fn evaluate<R: Real>(
        &self,
        mapping: &Mapping2d,
        pyramid: &Pyramid,
        ctx: &TextureContext<R>,
    ) -> R {
        let [st, dst0, dst1] = position(mapping, ctx);
        let value = R::splat(self.scale) * pyramid.lookup(st, dst0, dst1, self.filter);
        if self.invert { (R::one() - value).max(R::zero()) } else { value }
    }
}

/// A filtered lookup of colours in an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectrumImage {
    /// Position and filter of the lookup.
    pub lookup: ImageLookup,
    /// The colour space of the pixels.
    pub space: &'static RgbColorSpace,
    /// The type of the spectra.
    pub spectrum_type: SpectrumType,
}

impl SpectrumImage {
    /// The spectrum at a point.
    #[inline(always)]
    pub(super) fn evaluate<R: Real>(
        &self,
        mapping: &Mapping2d,
        pyramid: &Pyramid,
        ctx: &TextureContext<R>,
        lambda: &SampledWavelengths<R>,
    ) -> SampledSpectrum<R> {
        let [st, dst0, dst1] = position(mapping, ctx);
        let pixel = pyramid.lookup_rgb(st, dst0, dst1, self.lookup.filter);
        let (scale, invert) = (R::splat(self.lookup.scale), self.lookup.invert);
        let scaled = pixel.each(|v| v * scale);
        let rgb = scaled.each(|v| if invert { R::one() - v } else { v });
        self.spectrum_type.sample_rgb(self.space, rgb.each(|v| v.max(R::zero())), lambda)
    }
}

/// The position of a lookup in a pyramid, and its derivatives by film x and y.
#[inline(always)]
fn position<R: Real>(mapping: &Mapping2d, ctx: &TextureContext<R>) -> [Vec2<R>; 3] {
    let c = mapping.map(ctx);
    [Vec2::new(c.st.x, R::one() - c.st.y), c.dstdx, c.dstdy]
}
