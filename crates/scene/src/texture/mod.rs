//! Values that vary over surfaces.
//!
//! A texture gives a number or a spectrum at a point of a surface. All of a scene's textures stand
//! in the two tables of [`Textures`] and refer to each other by id. Numbers and spectra have the
//! same kinds of texture, so that one generic [`Texture`] serves both:
//!
//! ```text
//! constant       c
//! scale          s·t
//! mix            (1 − a)·t₀ + a·t₁
//! bilerp         four corner values, interpolated over the unit square
//! checkerboard   t₀ and t₁ in alternation, averaged over the footprint of the pixel
//! image          pixels, averaged over the footprint of the pixel
//! ```
//!
//! Footprints come as derivatives by film position, x and y counted in pixels: ∂p/∂x, ∂u/∂x and so
//! on. Zero derivatives ask for the value at the point. A spectrum from RGB depends on what it
//! stands for, its [`SpectrumType`].
//!
//! Source: [Pharr 2023 ch. 10].

mod bilerp;
mod checkerboard;
mod compile;
mod imagemap;
mod mapping;
mod pyramids;
mod spectrum_type;
#[cfg(test)]
mod tests;

use math::{Normal3, Point2, Point3, Vector3};
use spectrum::{SampledSpectrum, SampledWavelengths, Spectrum};
use std::ops::{Add, Mul};

pub use bilerp::Bilerp;
pub use checkerboard::Checkerboard;
pub use compile::compile;
pub use imagemap::{FloatImage, ImageLookup, SpectrumImage};
pub use mapping::{Mapping2d, Mapping3d, TexCoord2d, TexCoord3d};
pub use spectrum_type::{SpectrumType, color_space, compile_spectrum};

/// The place of a texture of numbers in [`Textures`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FloatTextureId(pub u32);

/// The place of a texture of spectra in [`Textures`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SpectrumTextureId(pub u32);

/// Where on a surface, and how densely the film samples it there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TextureContext {
    /// The point, in render space.
    pub p: Point3,
    /// How the point moves with film x.
    pub dpdx: Vector3,
    /// How the point moves with film y.
    pub dpdy: Vector3,
    /// The surface normal, in render space.
    pub n: Normal3,
    /// The surface's own parameters.
    pub uv: Point2,
    /// How u changes with film x.
    pub dudx: f32,
    /// How u changes with film y.
    pub dudy: f32,
    /// How v changes with film x.
    pub dvdx: f32,
    /// How v changes with film y.
    pub dvdy: f32,
    /// Which face of a mesh, for textures that are stored by face.
    pub face_index: u32,
}

/// A texture, of constants `C` and images `I`, that refers to others of its sort by `Id`.
#[derive(Clone, Debug)]
pub enum Texture<C, Id, I> {
    /// The same everywhere.
    Constant(C),
    /// A product.
    Scale {
        /// What is scaled.
        texture: Id,
        /// By how much.
        scale: FloatTextureId,
    },
    /// Something between two textures.
    Mix {
        /// What is mixed.
        textures: [Id; 2],
        /// How much of the second; the rest is of the first.
        amount: FloatTextureId,
    },
    /// Corner values, interpolated.
    Bilerp(Bilerp<C>),
    /// Two textures in alternation.
    Checkerboard {
        /// The first has the square or cube that begins at the origin.
        textures: [Id; 2],
        /// Where each of them is seen.
        pattern: Checkerboard,
    },
    /// An image.
    Image(I),
}

/// A texture of numbers.
pub type FloatTexture = Texture<f32, FloatTextureId, FloatImage>;
/// A texture of spectra.
pub type SpectrumTexture = Texture<Spectrum, SpectrumTextureId, SpectrumImage>;

impl<C, Id: Copy, I> Texture<C, Id, I> {
    /// Whether it is itself averaged over the footprint of a pixel.
    fn is_filtered(&self) -> bool {
        match self {
            Self::Checkerboard { .. } | Self::Image(_) => true,
            Self::Constant(_) | Self::Scale { .. } | Self::Mix { .. } | Self::Bilerp(_) => false,
        }
    }

    /// The value, from those of its parts: `other` evaluates another texture of the same sort.
    fn evaluate<V: Add<Output = V> + Mul<f32, Output = V>>(
        &self,
        textures: &Textures,
        ctx: &TextureContext,
        constant: impl Fn(&C) -> V,
        image: impl Fn(&I) -> V,
        other: impl Fn(Id) -> V,
    ) -> V {
        let mix = |[first, second]: [Id; 2], amount: f32| {
            if amount == 0.0 {
                other(first)
            } else if amount == 1.0 {
                other(second)
            } else {
                other(first) * (1.0 - amount) + other(second) * amount
            }
        };
        match self {
            Self::Constant(value) => constant(value),
            Self::Scale { texture, scale } => other(*texture) * textures.float(*scale, ctx),
            Self::Mix { textures: mixed, amount } => mix(*mixed, textures.float(*amount, ctx)),
            Self::Bilerp(bilerp) => {
                let [v00, v01, v10, v11] = &bilerp.corners;
                let [w00, w01, w10, w11] = bilerp.weights(ctx);
                constant(v00) * w00 + constant(v01) * w01 + constant(v10) * w10 + constant(v11) * w11
            }
            Self::Checkerboard { textures: mixed, pattern } => mix(*mixed, pattern.amount(ctx)),
            Self::Image(pixels) => image(pixels),
        }
    }
}

/// All textures of a scene.
#[derive(Clone, Debug, Default)]
pub struct Textures {
    float: Vec<FloatTexture>,
    spectrum: Vec<SpectrumTexture>,
}

impl Textures {
    /// Adds a texture of numbers. It may refer to textures that are already there.
    pub fn push_float(&mut self, texture: FloatTexture) -> FloatTextureId {
        self.float.push(texture);
        FloatTextureId(self.float.len() as u32 - 1)
    }

    /// Adds a texture of spectra. It may refer to textures that are already there.
    pub fn push_spectrum(&mut self, texture: SpectrumTexture) -> SpectrumTextureId {
        self.spectrum.push(texture);
        SpectrumTextureId(self.spectrum.len() as u32 - 1)
    }

    /// The texture of numbers with this id.
    pub fn float_texture(&self, id: FloatTextureId) -> &FloatTexture {
        &self.float[id.0 as usize]
    }

    /// The texture of spectra with this id.
    pub fn spectrum_texture(&self, id: SpectrumTextureId) -> &SpectrumTexture {
        &self.spectrum[id.0 as usize]
    }

    /// Whether any texture is averaged over the footprint of a pixel.
    pub fn are_filtered(&self) -> bool {
        self.float.iter().any(Texture::is_filtered) || self.spectrum.iter().any(Texture::is_filtered)
    }

    /// The number at a point.
    pub fn float(&self, id: FloatTextureId, ctx: &TextureContext) -> f32 {
        self.float_texture(id).evaluate(
            self,
            ctx,
            |value| *value,
            |image| image.evaluate(ctx),
            |id| self.float(id, ctx),
        )
    }

    /// The spectrum at a point.
    pub fn spectrum(
        &self,
        id: SpectrumTextureId,
        ctx: &TextureContext,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        self.spectrum_texture(id).evaluate(
            self,
            ctx,
            |value| value.sample(lambda),
            |image| image.evaluate(ctx, lambda),
            |id| self.spectrum(id, ctx, lambda),
        )
    }
}
