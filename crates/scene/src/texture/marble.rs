//! Marble: veins across the y axis of texture space, displaced by fractional Brownian motion.
//!
//! The phase y + variation·fbm(p), with p scaled, makes t = ½ + ½·sin(phase) run back and forth
//! through a ramp of colours, grey with one dark vein: nine colours c₀ … c₈, of which the cubic
//! Bézier curve of four successive ones gives each sixth of the ramp, and all are 1.5 times as
//! bright in the end. Each sixth starts one colour after the one before, so that the ramp leaps
//! where they meet; seen in stone, that makes the edges of veins sharp. The colours are albedos in
//! sRGB, whatever the texture is used for.
//!
//! Source: [Pharr 2016 §10.6.6], whose colours these are.

use super::fractal::{Fractal, fbm};
use super::{SpectrumType, TexCoord3d};
use lanes::{Each, Int, Real, sin};
use spectrum::{RgbColorSpace, SampledSpectrum, SampledWavelengths};

/// Veins of marble.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Marble {
    /// The noise that displaces the veins.
    pub fractal: Fractal,
    /// Factor on texture space.
    pub scale: f32,
    /// The amplitude of the displacement.
    pub variation: f32,
}

impl Marble {
    /// The place on the ramp, from 0 to 1, at a point of texture space.
    #[inline(always)]
    pub(super) fn place<R: Real>(&self, at: &TexCoord3d<R>) -> R {
        let at = at.scaled(R::splat(self.scale));
        let displacement = fbm(&at, self.fractal.octaves, self.fractal.roughness);
        let half = R::splat(0.5);
        half + half * sin(at.p.y + R::splat(self.variation) * displacement)
    }
}

/// The reflectance at a place on the ramp.
#[inline(always)]
pub(super) fn reflectance<R: Real>(place: R, lambda: &SampledWavelengths<R>) -> SampledSpectrum<R> {
    SpectrumType::Albedo.sample_rgb(RgbColorSpace::srgb(), color(place), lambda)
}

/// Red, green and blue of the ramp's colours.
static COLORS: [[f32; 9]; 3] = [
    [0.58, 0.58, 0.58, 0.5, 0.6, 0.58, 0.58, 0.2, 0.58],
    [0.58, 0.58, 0.58, 0.5, 0.59, 0.58, 0.58, 0.2, 0.58],
    [0.6, 0.6, 0.6, 0.5, 0.58, 0.6, 0.6, 0.33, 0.6],
];

/// The colour at a place of the ramp from 0 to 1.
#[inline(always)]
fn color<R: Real>(t: R) -> [R; 3] {
    let [one, three] = [1.0, 3.0].each(R::splat);
    let along = t * R::splat(6.0);
    let first = along.floor().clamp(R::zero(), R::splat(5.0));
    let (t, first) = (along - first, first.to_int());
    let s = one - t;
    let weights = [s * s * s, three * s * s * t, three * s * t * t, t * t * t];
    let mut rgb = [R::zero(); 3];
    for (channel, colors) in rgb.iter_mut().zip(&COLORS) {
        for (i, weight) in weights.into_iter().enumerate() {
            *channel += weight * R::gather(colors, first.wrapping_add(R::Int::splat(i as u32)));
        }
    }
    rgb.each(|channel| channel * R::splat(1.5))
}
