//! Values that vary over surfaces.
//!
//! A texture gives a number or a spectrum at a point of a surface. Both kinds of value have the
//! same textures:
//!
//! ```text
//! constant       c
//! scale          s·t
//! mix            (1 − a)·t₀ + a·t₁
//! bilerp         four corner values, interpolated over the unit square
//! checkerboard   t₀ and t₁ in alternation, averaged over the footprint of the pixel
//! image          pixels, averaged over the footprint of the pixel
//! directionmix   a·t₀ + (1 − a)·t₁, where a = |cosine of the normal and a direction|
//! dots           t₁ in dots, t₀ elsewhere
//! fbm            noise at many frequencies; numbers only
//! wrinkled       magnitudes of noise at many frequencies; numbers only
//! windy          noise of varying strength; numbers only
//! marble         colours across veins that noise displaces; spectra only
//! ```
//!
//! A scene's textures form a graph. It is compiled to flat programs, one for each texture in use,
//! with common subexpressions shared and constants folded ([`Textures`]).
//!
//! Footprints are given as derivatives by film position, x and y counted in pixels: ∂p/∂x, ∂u/∂x
//! and so on. Zero derivatives give the value at the point. A spectrum from RGB depends on its
//! [`SpectrumType`].
//!
//! Source: [Pharr 2023 ch. 10].

mod bilerp;
mod checkerboard;
mod compile;
mod context;
mod dots;
mod fractal;
mod graph;
mod imagemap;
mod mapping;
mod marble;
mod noise;
mod pattern;
mod program;
mod pyramids;
mod spectrum_type;
#[cfg(test)]
mod tests;
mod uv_lookup;

pub use compile::TextureCompiler;
pub use context::TextureContext;
pub use fractal::Fractal;
pub use graph::{MAX_OPERATIONS, MAX_TOTAL_OPERATIONS};
pub use imagemap::{ImageLookup, SpectrumImage};
pub use mapping::{Mapping2d, Mapping3d, TexCoord2d, TexCoord3d};
pub use marble::Marble;
pub(crate) use noise::noise;
pub use program::{Code, MAX_SLOTS, Operation, Program, Textures};
pub use spectrum_type::{SpectrumType, color_space, compile_spectrum};
pub use uv_lookup::UvLookup;

/// Index of the program of a texture of numbers in [`Textures::programs`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FloatTextureId(pub u32);

/// Index of the program of a texture of spectra in [`Textures::programs`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SpectrumTextureId(pub u32);
