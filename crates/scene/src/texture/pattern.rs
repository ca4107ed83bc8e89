//! The numbers of the operations that are made of noise.
//!
//! They are much code, which programs of numbers and of spectra share: a kernel of its own.

use super::context::ContextArrays;
use super::{Code, Fractal, TexCoord3d, TextureContext, Textures, dots, fractal};
use lanes::{Kernel, MAX_LANES, Real};

impl Textures {
    /// The number at a point of an operation that is made of noise: of marble, the place on its
    /// ramp of colours.
    #[inline(always)]
    pub(super) fn pattern<R: Real>(&self, code: Code, ctx: &TextureContext<R>) -> R {
        if R::LANES == 1 {
            return R::splat(self.pattern_of_one(code, &ctx.lane(0)));
        }
        let contexts = ContextArrays::new(ctx);
        R::load(&R::call(Pattern { textures: self, code, contexts: &contexts }))
    }

    #[inline(never)]
    fn pattern_of_one(&self, code: Code, ctx: &TextureContext) -> f32 {
        self.pattern_in_place(code, ctx)
    }

    #[inline(always)]
    fn pattern_in_place<R: Real>(&self, code: Code, ctx: &TextureContext<R>) -> R {
        match code {
            Code::Dots(index) => dots::coverage(self.mappings[index as usize].map(ctx).st),
            Code::Fbm(index) => {
                let Fractal { mapping, octaves, roughness } = self.fractals[index as usize];
                fractal::fbm(&self.in_space(mapping, ctx), octaves, roughness)
            }
            Code::Wrinkled(index) => {
                let Fractal { mapping, octaves, roughness } = self.fractals[index as usize];
                fractal::turbulence(&self.in_space(mapping, ctx), octaves, roughness)
            }
            Code::Windy(index) => fractal::windy(&self.in_space(index, ctx)),
            Code::Marble(index) => {
                let marble = &self.marbles[index as usize];
                marble.place(&self.in_space(marble.fractal.mapping, ctx))
            }
            Code::Number(_)
            | Code::Spectrum(_)
            | Code::FloatImage(_)
            | Code::SpectrumImage(_)
            | Code::Squares(_)
            | Code::Cubes(_)
            | Code::Facing(_)
            | Code::Scale
            | Code::Step(_)
            | Code::Mix
            | Code::Bilerp(_) => unreachable!("invariant: these are not made of noise"),
        }
    }

    /// A point in the texture space of an entry of the table of maps.
    #[inline(always)]
    pub(super) fn in_space<R: Real>(&self, mapping: u32, ctx: &TextureContext<R>) -> TexCoord3d<R> {
        self.solid_mappings[mapping as usize].map(ctx)
    }
}

struct Pattern<'a> {
    textures: &'a Textures,
    code: Code,
    contexts: &'a ContextArrays,
}

impl Kernel for Pattern<'_> {
    type Output = [f32; MAX_LANES];

    #[inline(always)]
    fn run<R: Real>(self) -> [f32; MAX_LANES] {
        let value: R = self.textures.pattern_in_place(self.code, &self.contexts.load());
        value.to_array()
    }
}
