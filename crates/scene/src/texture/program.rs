//! Textures as flat programs, and their evaluation.
//!
//! A program is a sequence of operations in post-order: the operands of an operation are computed
//! before it. Values are kept in [`MAX_SLOTS`] slots. An operation names the slots of its operands
//! and the slot of its result, so that a value that several operations read is computed once. The
//! last operation writes slot 0.
//!
//! Operations are plain data: larger data than 32 bits is stored in tables of [`Textures`] and
//! referred to by its index. There is no recursion and no branch, so that any back end can run the
//! same programs.

use super::{
    FloatTextureId, ImageLookup, Mapping2d, Mapping3d, SpectrumImage, SpectrumTextureId, TextureContext,
    bilerp, checkerboard,
};
use image::Pyramid;
use lanes::{Each, MAX_LANES, Real};
use spectrum::{N, SampledSpectrum, SampledWavelengths, Spectrum};
use std::ops::{Add, Mul};
use std::sync::Arc;

/// The number of slots of a program.
pub const MAX_SLOTS: usize = 32;

/// What an operation computes. Numbers are indices into the tables of [`Textures`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Code {
    /// A number, the same everywhere.
    Number(f32),
    /// An entry of [`Textures::spectra`].
    Spectrum(u32),
    /// A lookup in an entry of [`Textures::float_images`].
    FloatImage(u32),
    /// A lookup in an entry of [`Textures::spectrum_images`].
    SpectrumImage(u32),
    /// The share of the second texture of a checkerboard of squares, mapped by an entry of
    /// [`Textures::mappings`].
    Squares(u32),
    /// The share of the second texture of a checkerboard of cubes, mapped by an entry of
    /// [`Textures::solid_mappings`].
    Cubes(u32),
    /// The product of operands 0 and 1, of which 1 is a number.
    Scale,
    /// (1 − a)·operand 0 + a·operand 1, where the number a is operand 2. For a = 0 and a = 1 the
    /// value is exactly one operand, even if the other is infinite or NaN.
    Mix,
    /// Operands 0 to 3 at the corners (0, 0), (0, 1), (1, 0), (1, 1) of the unit square,
    /// interpolated at coordinates mapped by an entry of [`Textures::mappings`].
    Bilerp(u32),
}

impl Code {
    /// The number of operands.
    pub fn operand_count(self) -> usize {
        match self {
            Self::Number(_)
            | Self::Spectrum(_)
            | Self::FloatImage(_)
            | Self::SpectrumImage(_)
            | Self::Squares(_)
            | Self::Cubes(_) => 0,
            Self::Scale => 2,
            Self::Mix => 3,
            Self::Bilerp(_) => 4,
        }
    }

    /// Whether the value is averaged over the footprint of a pixel.
    pub fn is_filtered(self) -> bool {
        matches!(self, Self::FloatImage(_) | Self::SpectrumImage(_) | Self::Squares(_) | Self::Cubes(_))
    }
}

/// One step of a program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Operation {
    /// The computation.
    pub code: Code,
    /// The slot of the result.
    pub target: u8,
    /// The slots of the operands; those beyond [`Code::operand_count`] are 0.
    pub operands: [u8; 4],
}

/// A range of [`Textures::operations`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Program {
    /// Index of the first operation.
    pub first: u32,
    /// Number of operations, at least one.
    pub length: u32,
}

/// All textures of a scene: programs, and the tables that their operations refer to.
#[derive(Clone, Debug, Default)]
pub struct Textures {
    pub(super) programs: Vec<Program>,
    pub(super) operations: Vec<Operation>,
    pub(super) spectra: Vec<Spectrum>,
    pub(super) mappings: Vec<Mapping2d>,
    pub(super) solid_mappings: Vec<Mapping3d>,
    pub(super) float_images: Vec<ImageLookup>,
    pub(super) spectrum_images: Vec<SpectrumImage>,
    pub(super) pyramids: Vec<Arc<Pyramid>>,
}

impl Textures {
    /// The programs, by the numbers in [`FloatTextureId`] and [`SpectrumTextureId`].
    pub fn programs(&self) -> &[Program] {
        &self.programs
    }

    /// The operations of all programs.
    pub fn operations(&self) -> &[Operation] {
        &self.operations
    }

    /// Spectra that do not vary over surfaces.
    pub fn spectra(&self) -> &[Spectrum] {
        &self.spectra
    }

    /// Maps to the plane.
    pub fn mappings(&self) -> &[Mapping2d] {
        &self.mappings
    }

    /// Maps to texture space.
    pub fn solid_mappings(&self) -> &[Mapping3d] {
        &self.solid_mappings
    }

    /// Lookups of numbers in images: in the first channel of their pyramid.
    pub fn float_images(&self) -> &[ImageLookup] {
        &self.float_images
    }

    /// Lookups of colours in images.
    pub fn spectrum_images(&self) -> &[SpectrumImage] {
        &self.spectrum_images
    }

    /// The image pyramids that lookups refer to.
    pub fn pyramids(&self) -> &[Arc<Pyramid>] {
        &self.pyramids
    }

    /// Whether any texture is averaged over the footprint of a pixel.
    pub fn are_filtered(&self) -> bool {
        self.operations.iter().any(|operation| operation.code.is_filtered())
    }

    /// The value of a texture that is the same everywhere.
    #[inline]
    pub fn constant(&self, id: FloatTextureId) -> Option<f32> {
        match self.program(id.0) {
            [Operation { code: Code::Number(value), .. }] => Some(*value),
            _ => None,
        }
    }

    /// The number at a point.
    #[inline(always)]
    pub fn float<R: Real>(&self, id: FloatTextureId, ctx: &TextureContext<R>) -> R {
        if let Some(value) = self.constant(id) {
            return R::splat(value);
        }
        let mut values = [0.0; MAX_LANES];
        for (lane, value) in values[..R::LANES].iter_mut().enumerate() {
            *value = self.varying_float(id, &ctx.lane(lane));
        }
        R::load(&values)
    }

    /// The spectrum at a point.
    #[inline(always)]
    pub fn spectrum<R: Real>(
        &self,
        id: SpectrumTextureId,
        ctx: &TextureContext<R>,
        lambda: &SampledWavelengths<R>,
    ) -> SampledSpectrum<R> {
        if let Some(constant) = self.constant_spectrum(id) {
            return constant.sample(lambda);
        }
        let mut values = [[0.0; MAX_LANES]; N];
        for lane in 0..R::LANES {
            let spectrum = self.varying_spectrum(id, &ctx.lane(lane), &lambda.lane(lane));
            for (values, value) in values.iter_mut().zip(spectrum.0) {
                values[lane] = value;
            }
        }
        SampledSpectrum(values.each(|values| R::load(&values)))
    }

    /// The spectrum of a texture that is the same everywhere.
    #[inline]
    pub fn constant_spectrum(&self, id: SpectrumTextureId) -> Option<&Spectrum> {
        match self.program(id.0) {
            [Operation { code: Code::Spectrum(index), .. }] => Some(&self.spectra[*index as usize]),
            _ => None,
        }
    }

    fn varying_float(&self, id: FloatTextureId, ctx: &TextureContext) -> f32 {
        // A program of numbers has no operations on spectra.
        self.evaluate(id.0, ctx, |value| value, |value| value, |_| 0.0)
    }

    fn varying_spectrum(
        &self,
        id: SpectrumTextureId,
        ctx: &TextureContext,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        let spectral = |code| match code {
            Code::Spectrum(index) => self.spectra[index as usize].sample(lambda),
            Code::SpectrumImage(index) => {
                let image = &self.spectrum_images[index as usize];
                let (mapping, pyramid) = self.image(&image.lookup);
                image.evaluate(mapping, pyramid, ctx, lambda)
            }
            _ => SampledSpectrum::ZERO,
        };
        // A number is the spectrum that has its value at all wavelengths.
        self.evaluate(id.0, ctx, SampledSpectrum::splat, |value| value[0], spectral)
    }

    pub(super) fn program(&self, index: u32) -> &[Operation] {
        let Program { first, length } = self.programs[index as usize];
        &self.operations[first as usize..][..length as usize]
    }

    /// The tables' entries that a lookup refers to.
    fn image(&self, lookup: &ImageLookup) -> (&Mapping2d, &Pyramid) {
        (&self.mappings[lookup.mapping as usize], &self.pyramids[lookup.pyramid as usize])
    }

    /// Runs a program on values `V`: `splat` converts a number to a value, `number` is its inverse,
    /// and `spectral` evaluates the operations that return spectra.
    #[inline]
    fn evaluate<V: Copy + Default + Add<Output = V> + Mul<f32, Output = V>>(
        &self,
        program: u32,
        ctx: &TextureContext,
        splat: impl Fn(f32) -> V,
        number: impl Fn(V) -> f32,
        spectral: impl Fn(Code) -> V,
    ) -> V {
        let leaf = |code| match code {
            Code::Number(value) => splat(value),
            Code::FloatImage(index) => {
                let lookup = &self.float_images[index as usize];
                let (mapping, pyramid) = self.image(lookup);
                splat(lookup.evaluate(mapping, pyramid, ctx))
            }
            Code::Squares(index) => splat(checkerboard::squares(&self.mappings[index as usize].map(ctx))),
            Code::Cubes(index) => splat(checkerboard::cubes(&self.solid_mappings[index as usize].map(ctx))),
            _ => spectral(code),
        };
        let operations = self.program(program);
        // The common case: one constant or one image.
        if let [only] = operations {
            return leaf(only.code);
        }
        let mut slots = [V::default(); MAX_SLOTS];
        for operation in operations {
            let operand = |i: usize| slots[usize::from(operation.operands[i])];
            let value = match operation.code {
                Code::Scale => operand(0) * number(operand(1)),
                Code::Mix => mix([operand(0), operand(1)], number(operand(2))),
                Code::Bilerp(index) => {
                    let [w00, w01, w10, w11] = bilerp::weights(self.mappings[index as usize].map(ctx).st);
                    operand(0) * w00 + operand(1) * w01 + operand(2) * w10 + operand(3) * w11
                }
                code => leaf(code),
            };
            slots[usize::from(operation.target)] = value;
        }
        slots[0]
    }
}

/// (1 − `amount`)·first + `amount`·second. A value of weight 0 may be infinite or NaN.
#[inline]
pub(super) fn mix<V: Add<Output = V> + Mul<f32, Output = V>>([first, second]: [V; 2], amount: f32) -> V {
    if amount == 0.0 {
        first
    } else if amount == 1.0 {
        second
    } else {
        first * (1.0 - amount) + second * amount
    }
}
