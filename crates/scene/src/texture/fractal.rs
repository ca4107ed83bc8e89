//! Sums of noise at many frequencies: fractional Brownian motion, turbulence, and waves.
//!
//! An octave is the noise at about twice the frequency of the one before, λ = 1.99, and at ω times
//! its amplitude. (At twice the frequency exactly, all octaves would be zero at the same points.)
//!
//! ```text
//! fbm         Σ ωⁱ·noise(λⁱp)                                clouds, ridges
//! turbulence  Σ ωⁱ·|noise(λⁱp)|                              creases, where the noise is zero
//! windy       |fbm(p/10; ω ½, 3 octaves)|·fbm(p; ω ½, 6 octaves)      waves of varying strength
//! ```
//!
//! A pixel cannot show frequencies above one cycle in two pixels. With a footprint of length ℓ in
//! texture space, those are the octaves from n = log₂(1/2ℓ) on. An octave i fades out where n − i
//! falls from 0.7 to 0.3, and is replaced by its mean: 0 in fbm; about 0.2 in turbulence, which
//! would grow darker with distance else. A point, ℓ = 0, has all octaves that are asked for.
//!
//! Turbulence counts the mean of octave ⌊n⌋ a second time, as pbrt-v4 does: the replacement is
//! 0.2·ω^⌊n⌋ too bright, by the same amount at all points that show all octaves.
//!
//! Sources: [Perlin 1985]; [Pharr 2016 §10.6.3–10.6.5], whose pictures are to be matched.

use super::TexCoord3d;
use super::noise::noise;
use lanes::{Mask, Real, log2};

/// A sum of octaves in a texture space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fractal {
    /// Index of the map to texture space in
    /// [`Textures::solid_mappings`](super::Textures::solid_mappings).
    pub mapping: u32,
    /// The number of octaves seen from nearby.
    pub octaves: u32,
    /// ω, the amplitude of an octave relative to the one before.
    pub roughness: f32,
}

/// The frequency of an octave relative to the one before.
const LACUNARITY: f32 = 1.99;

/// The mean of |noise|, about.
const MEAN: f32 = 0.2;

/// Fractional Brownian motion.
#[inline(always)]
pub(super) fn fbm<R: Real>(at: &TexCoord3d<R>, octaves: u32, roughness: f32) -> R {
    let visible = visible_octaves(at, octaves);
    let (mut sum, mut frequency, mut amplitude) = (R::zero(), 1.0, 1.0);
    for octave in 0..octaves {
        let share = share(visible, octave);
        if !share.gt(R::zero()).any() {
            break;
        }
        sum += share * R::splat(amplitude) * noise(at.p * R::splat(frequency));
        frequency *= LACUNARITY;
        amplitude *= roughness;
    }
    sum
}

/// Turbulence.
#[inline(always)]
pub(super) fn turbulence<R: Real>(at: &TexCoord3d<R>, octaves: u32, roughness: f32) -> R {
    let (visible, mean) = (visible_octaves(at, octaves), R::splat(MEAN));
    let (mut sum, mut frequency, mut amplitude) = (R::zero(), 1.0, 1.0);
    for octave in 0..=octaves {
        let share = share(visible, octave);
        let mut value = mean;
        if share.gt(R::zero()).any() {
            let magnitude = noise(at.p * R::splat(frequency)).abs();
            value = mean * (R::one() - share) + magnitude * share;
        }
        let is_counted_again = visible.floor().eq(R::splat(octave as f32));
        let again = R::select(is_counted_again, mean, R::zero());
        sum += R::splat(amplitude) * if octave < octaves { value + again } else { again };
        frequency *= LACUNARITY;
        amplitude *= roughness;
    }
    sum
}

/// Waves in the wind.
#[inline(always)]
pub(super) fn windy<R: Real>(at: &TexCoord3d<R>) -> R {
    // A loop, so that the code of fbm is there once.
    let mut product = R::one();
    for (scale, octaves) in [(0.1, 3), (1.0, 6)] {
        product = product.abs() * fbm(&at.scaled(R::splat(scale)), octaves, 0.5);
    }
    product
}

/// How many octaves a pixel can show, of those that are asked for.
#[inline(always)]
fn visible_octaves<R: Real>(at: &TexCoord3d<R>, octaves: u32) -> R {
    let squared = at.dpdx.length_squared().max(at.dpdy.length_squared());
    let visible = -R::one() - R::splat(0.5) * log2(squared);
    visible.clamp(R::zero(), R::splat(octaves as f32))
}

/// The share of an octave that is seen where so many are visible: 1 up to that many, a smooth step
/// for the last.
#[inline(always)]
fn share<R: Real>(visible: R, octave: u32) -> R {
    let rest = visible - R::splat(octave as f32);
    let t = ((rest - R::splat(0.3)) / R::splat(0.4)).clamp(R::zero(), R::one());
    t * t * (R::splat(3.0) - R::splat(2.0) * t)
}
