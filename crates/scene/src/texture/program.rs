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

use super::context::ContextArrays;
use super::{
    FloatTextureId, Fractal, ImageLookup, Mapping2d, Mapping3d, Marble, SpectrumImage, SpectrumTextureId,
    TextureContext, bilerp, checkerboard, marble,
};
use image::Pyramid;
use lanes::{Each, Kernel, MAX_LANES, Real};
use math::{Vec3, Vector3};
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
    /// 1 in the dots and 0 elsewhere, mapped by an entry of [`Textures::mappings`].
    Dots(u32),
    /// The magnitude of the cosine between the normal and an entry of [`Textures::directions`].
    Facing(u32),
    /// The fractional Brownian motion of an entry of [`Textures::fractals`].
    Fbm(u32),
    /// The turbulence of an entry of [`Textures::fractals`].
    Wrinkled(u32),
    /// Waves, mapped by an entry of [`Textures::solid_mappings`].
    Windy(u32),
    /// The reflectance of an entry of [`Textures::marbles`].
    Marble(u32),
    /// 1 where the number that operand 0 is is at least this one, else 0.
    Step(f32),
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
            | Self::Cubes(_)
            | Self::Dots(_)
            | Self::Facing(_)
            | Self::Fbm(_)
            | Self::Wrinkled(_)
            | Self::Windy(_)
            | Self::Marble(_) => 0,
            Self::Step(_) => 1,
            Self::Scale => 2,
            Self::Mix => 3,
            Self::Bilerp(_) => 4,
        }
    }

    /// Whether the value is averaged over the footprint of a pixel.
    pub fn is_filtered(self) -> bool {
        match self {
            Self::FloatImage(_)
            | Self::SpectrumImage(_)
            | Self::Squares(_)
            | Self::Cubes(_)
            | Self::Fbm(_)
            | Self::Wrinkled(_)
            | Self::Windy(_)
            | Self::Marble(_) => true,
            Self::Number(_)
            | Self::Spectrum(_)
            | Self::Dots(_)
            | Self::Facing(_)
            | Self::Step(_)
            | Self::Scale
            | Self::Mix
            | Self::Bilerp(_) => false,
        }
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
    pub(super) directions: Vec<Vector3>,
    pub(super) fractals: Vec<Fractal>,
    pub(super) marbles: Vec<Marble>,
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

    /// Unit directions in render space.
    pub fn directions(&self) -> &[Vector3] {
        &self.directions
    }

    /// Sums of noise.
    pub fn fractals(&self) -> &[Fractal] {
        &self.fractals
    }

    /// Marbles.
    pub fn marbles(&self) -> &[Marble] {
        &self.marbles
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

    /// Whether a texture of spectra is the same everywhere.
    pub fn is_constant(&self, id: SpectrumTextureId) -> bool {
        matches!(self.program(id.0), [Operation { code: Code::Number(_) | Code::Spectrum(_), .. }])
    }

    /// The number at a point.
    #[inline(always)]
    pub fn float<R: Real>(&self, id: FloatTextureId, ctx: &TextureContext<R>) -> R {
        let operations = self.program(id.0);
        if let [Operation { code: Code::Number(value), .. }] = operations {
            return R::splat(*value);
        }
        if R::LANES == 1 {
            return R::splat(self.float_of_one(operations, &ctx.lane(0)));
        }
        let contexts = ContextArrays::new(ctx);
        R::load(&R::call(FloatLookup { textures: self, operations, contexts: &contexts }))
    }

    /// The spectrum at a point.
    #[inline(always)]
    pub fn spectrum<R: Real>(
        &self,
        id: SpectrumTextureId,
        ctx: &TextureContext<R>,
        lambda: &SampledWavelengths<R>,
    ) -> SampledSpectrum<R> {
        let operations = self.program(id.0);
        match operations {
            [Operation { code: Code::Number(value), .. }] => {
                return SampledSpectrum::splat(R::splat(*value));
            }
            [Operation { code: Code::Spectrum(index), .. }] => {
                return self.spectra[*index as usize].sample(lambda);
            }
            _ => {}
        }
        if R::LANES == 1 {
            let spectrum = self.spectrum_of_one(operations, &ctx.lane(0), &lambda.lane(0));
            return SampledSpectrum(spectrum.0.each(R::splat));
        }
        let contexts = ContextArrays::new(ctx);
        let lambda = lambda.lambda().each(R::to_array);
        let values =
            R::call(SpectrumLookup { textures: self, operations, contexts: &contexts, lambda: &lambda });
        SampledSpectrum(values.each(|values| R::load(&values)))
    }

    fn float_of_one(&self, operations: &[Operation], ctx: &TextureContext) -> f32 {
        self.evaluate(operations, ctx, &())
    }

    fn spectrum_of_one(
        &self,
        operations: &[Operation],
        ctx: &TextureContext,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        self.evaluate(operations, ctx, lambda)
    }

    pub(super) fn program(&self, index: u32) -> &[Operation] {
        let Program { first, length } = self.programs[index as usize];
        &self.operations[first as usize..][..length as usize]
    }

    /// The tables' entries that a lookup refers to.
    fn image(&self, lookup: &ImageLookup) -> (&Mapping2d, &Pyramid) {
        (&self.mappings[lookup.mapping as usize], &self.pyramids[lookup.pyramid as usize])
    }

    /// Runs a program on values `V`.
    #[inline(always)]
    fn evaluate<R: Real, V: Value<R>>(
        &self,
        operations: &[Operation],
        ctx: &TextureContext<R>,
        lambda: &V::Wavelengths,
    ) -> V {
        let mut slots = [V::default(); MAX_SLOTS];
        for operation in operations {
            let [a, b, c, d] = operation.operands.each(usize::from);
            let value = match operation.code {
                Code::Number(value) => V::splat(R::splat(value)),
                Code::FloatImage(index) => {
                    let lookup = &self.float_images[index as usize];
                    let (mapping, pyramid) = self.image(lookup);
                    V::splat(lookup.evaluate(mapping, pyramid, ctx))
                }
                Code::Squares(index) => {
                    V::splat(checkerboard::squares(&self.mappings[index as usize].map(ctx)))
                }
                Code::Cubes(index) => V::splat(checkerboard::cubes(&self.in_space(index, ctx))),
                Code::Facing(index) => {
                    V::splat(ctx.n.dot(Vec3::broadcast(self.directions[index as usize])).abs())
                }
                Code::Dots(_) | Code::Fbm(_) | Code::Wrinkled(_) | Code::Windy(_) => {
                    V::splat(self.pattern(operation.code, ctx))
                }
                Code::Spectrum(_) | Code::SpectrumImage(_) | Code::Marble(_) => {
                    V::spectral(self, operation.code, ctx, lambda)
                }
                Code::Step(edge) => {
                    V::splat(R::select(slots[a].number().ge(R::splat(edge)), R::one(), R::zero()))
                }
                Code::Scale => slots[a] * slots[b].number(),
                Code::Mix => mix([slots[a], slots[b]], slots[c].number()),
                Code::Bilerp(index) => {
                    let st = self.mappings[index as usize].map(ctx).st;
                    let [w00, w01, w10, w11] = bilerp::weights(st);
                    slots[a] * w00 + slots[b] * w01 + slots[c] * w10 + slots[d] * w11
                }
            };
            // The last operation writes slot 0.
            slots[usize::from(operation.target)] = value;
        }
        slots[0]
    }
}

/// What a program computes with: numbers or spectra.
pub(super) trait Value<R: Real>: Copy + Default + Add<Output = Self> + Mul<R, Output = Self> {
    /// The wavelengths of spectra.
    type Wavelengths;

    /// The value that stands for a number: itself, or the spectrum that has it at all wavelengths.
    fn splat(number: R) -> Self;

    /// The inverse of [`splat`](Self::splat).
    fn number(self) -> R;

    /// `a` where the mask is true, else `b`.
    fn select(mask: R::Mask, a: Self, b: Self) -> Self;

    /// The value of an operation that gives a spectrum.
    fn spectral(textures: &Textures, code: Code, ctx: &TextureContext<R>, lambda: &Self::Wavelengths)
    -> Self;
}

impl<R: Real> Value<R> for R {
    type Wavelengths = ();

    #[inline(always)]
    fn splat(number: R) -> R {
        number
    }

    #[inline(always)]
    fn number(self) -> R {
        self
    }

    #[inline(always)]
    fn select(mask: R::Mask, a: R, b: R) -> R {
        R::select(mask, a, b)
    }

    /// A program of numbers has no such operations.
    #[inline(always)]
    fn spectral(_: &Textures, _: Code, _: &TextureContext<R>, (): &()) -> R {
        R::zero()
    }
}

impl<R: Real> Value<R> for SampledSpectrum<R> {
    type Wavelengths = SampledWavelengths<R>;

    #[inline(always)]
    fn splat(number: R) -> Self {
        SampledSpectrum::splat(number)
    }

    #[inline(always)]
    fn number(self) -> R {
        self[0]
    }

    #[inline(always)]
    fn select(mask: R::Mask, a: Self, b: Self) -> Self {
        SampledSpectrum::select(mask, a, b)
    }

    #[inline(always)]
    fn spectral(
        textures: &Textures,
        code: Code,
        ctx: &TextureContext<R>,
        lambda: &SampledWavelengths<R>,
    ) -> Self {
        match code {
            Code::SpectrumImage(index) => {
                let image = &textures.spectrum_images[index as usize];
                let (mapping, pyramid) = textures.image(&image.lookup);
                image.evaluate(mapping, pyramid, ctx, lambda)
            }
            Code::Spectrum(index) => textures.spectra[index as usize].sample(lambda),
            Code::Marble(_) => marble::reflectance(textures.pattern(code, ctx), lambda),
            _ => SampledSpectrum::splat(R::zero()),
        }
    }
}

/// Runs a program of numbers. It is a kernel of its own, not a part of the kernels of materials,
/// because it is much code.
struct FloatLookup<'a> {
    textures: &'a Textures,
    operations: &'a [Operation],
    contexts: &'a ContextArrays,
}

impl Kernel for FloatLookup<'_> {
    type Output = [f32; MAX_LANES];

    #[inline(always)]
    fn run<R: Real>(self) -> [f32; MAX_LANES] {
        let value: R = self.textures.evaluate(self.operations, &self.contexts.load(), &());
        value.to_array()
    }
}

/// Runs a program of spectra.
struct SpectrumLookup<'a> {
    textures: &'a Textures,
    operations: &'a [Operation],
    contexts: &'a ContextArrays,
    lambda: &'a [[f32; MAX_LANES]; N],
}

impl Kernel for SpectrumLookup<'_> {
    type Output = [[f32; MAX_LANES]; N];

    #[inline(always)]
    fn run<R: Real>(self) -> [[f32; MAX_LANES]; N] {
        let [a, b, c, d] = self.lambda;
        let lambda = [a, b, c, d].each(|lambda| R::load(lambda));
        // Spectra do not depend on the densities of wavelengths.
        let lambda = SampledWavelengths::new(lambda, [R::one(); N]);
        let value: SampledSpectrum<R> =
            self.textures.evaluate(self.operations, &self.contexts.load(), &lambda);
        value.0.each(R::to_array)
    }
}

/// (1 − `amount`)·first + `amount`·second. A value of weight 0 may be infinite or NaN.
#[inline(always)]
pub(super) fn mix<R: Real, V: Value<R>>([first, second]: [V; 2], amount: R) -> V {
    let mixed = first * (R::one() - amount) + second * amount;
    let mixed = V::select(amount.eq(R::one()), second, mixed);
    V::select(amount.eq(R::zero()), first, mixed)
}
