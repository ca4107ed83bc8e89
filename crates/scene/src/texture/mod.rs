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
mod graph;
mod imagemap;
mod mapping;
mod program;
mod pyramids;
mod spectrum_type;
#[cfg(test)]
mod tests;

use crate::footprint::Footprint;
use lanes::Real;
use math::{Normal3, Point2, Point3, Vector3};

pub use compile::TextureCompiler;
pub use graph::{MAX_OPERATIONS, MAX_TOTAL_OPERATIONS};
pub use imagemap::{ImageLookup, SpectrumImage};
pub use mapping::{Mapping2d, Mapping3d, TexCoord2d, TexCoord3d};
pub use program::{Code, MAX_SLOTS, Operation, Program, Textures};
pub use spectrum_type::{SpectrumType, color_space, compile_spectrum};

/// Index of the program of a texture of numbers in [`Textures::programs`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FloatTextureId(pub u32);

/// Index of the program of a texture of spectra in [`Textures::programs`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SpectrumTextureId(pub u32);

/// A point of a surface, and the footprint of a pixel there, for each lane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TextureContext<R = f32> {
    /// The point, in render space.
    pub p: Point3<R>,
    /// Derivative of the point by film x.
    pub dpdx: Vector3<R>,
    /// Derivative of the point by film y.
    pub dpdy: Vector3<R>,
    /// The surface normal, in render space.
    pub n: Normal3<R>,
    /// The surface parameters (u, v).
    pub uv: Point2<R>,
    /// ∂u/∂x.
    pub dudx: R,
    /// ∂u/∂y.
    pub dudy: R,
    /// ∂v/∂x.
    pub dvdx: R,
    /// ∂v/∂y.
    pub dvdy: R,
    /// Index of the mesh face, for textures that are stored by face.
    pub face_index: u32,
}

impl<R: Real> TextureContext<R> {
    /// The context of a point with normal `n` and parameters `uv`.
    #[inline(always)]
    pub fn new(p: Point3<R>, n: Normal3<R>, uv: Point2<R>, footprint: &Footprint<R>) -> Self {
        let Footprint { dpdx, dpdy, dudx, dudy, dvdx, dvdy } = *footprint;
        Self { p, dpdx, dpdy, n, uv, dudx, dudy, dvdx, dvdy, face_index: 0 }
    }

    /// The context of a lane.
    #[inline(always)]
    pub(crate) fn lane(&self, lane: usize) -> TextureContext {
        TextureContext {
            p: self.p.map(|x| x.lane(lane)),
            dpdx: self.dpdx.map(|x| x.lane(lane)),
            dpdy: self.dpdy.map(|x| x.lane(lane)),
            n: self.n.map(|x| x.lane(lane)),
            uv: self.uv.map(|x| x.lane(lane)),
            dudx: self.dudx.lane(lane),
            dudy: self.dudy.lane(lane),
            dvdx: self.dvdx.lane(lane),
            dvdy: self.dvdy.lane(lane),
            face_index: self.face_index,
        }
    }
}
