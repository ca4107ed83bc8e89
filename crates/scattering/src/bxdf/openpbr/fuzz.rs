//! Fuzz: a layer of fibres along the normal.
//!
//! The fibres are microflakes whose normals have the distribution of an ellipsoid with the axes 1,
//! 1 and ς along the normal (SGGX), in a layer of optical thickness 1 across the fibres. What is
//! scattered once, with the projected area σ of a flake and h the half vector, is
//!
//! ```text
//! f    = D(h) (1 − e^{−Λ})/(4 (σo μi + σi μo))        Λ = σo/μo + σi/μi
//! D(h) = 1/(π ς (sin²θ_h + cos²θ_h/ς²)²)              σ = √(sin²θ + ς² cos²θ)
//! ```
//!
//! Of what is scattered again, X(μ) = 1 − e^{−σ/μ} − E₁(μ), half goes up, as X(μo) X(μi)/(2π X̄),
//! and half down to the base, with what meets no fibre. Sources: [Heitz 2015], and the sheen of
//! [Zeltner 2022], which is fitted to simulations of such layers.

use crate::grid::Grid;
use lanes::{Each, Real, exp};
use math::{Vector3, spherical_direction, sqr};
use spectrum::SampledSpectrum;
use std::f32::consts::{PI, TAU};
use std::sync::LazyLock;

/// σ², of a direction with a cosine.
#[inline(always)]
fn area2<R: Real>(width: R, cosine: R) -> R {
    R::one() - sqr(cosine) * (R::one() - sqr(width))
}

/// ς of a roughness in [0, 1].
#[inline(always)]
fn width<R: Real>(roughness: R) -> R {
    roughness.clamp(R::splat(0.1), R::one())
}

/// The value of single scattering, for two directions above.
#[inline(always)]
fn single<R: Real>(width: R, wo: Vector3<R>, wi: Vector3<R>) -> R {
    let (h, is_found) = (wo + wi).normalize_masked();
    let ellipse = R::one() - sqr(h.z) + sqr(h.z / width);
    let [o, i] = [wo.z, wi.z].each(|cosine| area2(width, cosine).sqrt());
    let depth = o / wo.z + i / wi.z;
    let scattered = R::one() - exp(-depth);
    let single = scattered / (R::splat(4.0 * PI) * width * sqr(ellipse) * (o * wi.z + i * wo.z));
    R::select(is_found, single, R::zero())
}

/// What fuzz of a roughness scatters of light from one direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scattered {
    /// E₁: upwards, once.
    pub once: f32,
    /// X: more than once, half of it upwards.
    pub more: f32,
}

impl Scattered {
    /// Of a roughness and a cosine, from the table.
    pub fn at(roughness: f32, cosine: f32) -> Self {
        static TABLE: LazyLock<Grid<f32>> = LazyLock::new(|| Grid::new(|r, c| albedo(width(r), c)));
        let nodes = TABLE.around(roughness, cosine);
        let once = nodes.map(|(weight, once)| weight * once).into_iter().sum::<f32>();
        let met = 1.0 - exp(-area2(width(roughness), cosine).sqrt() / cosine.max(1e-6));
        Self { once, more: (met - once).max(0.0) }
    }

    /// The share of light that does not reach the base.
    pub fn upwards(self) -> f32 {
        self.once + 0.5 * self.more
    }
}

/// The value for two directions above, of which fibres scatter `more` than once; `mean` is X̄.
#[inline(always)]
pub(super) fn value<R: Real>(
    color: SampledSpectrum<R>,
    roughness: R,
    mean: R,
    [wo, wi]: [Vector3<R>; 2],
    more: [R; 2],
) -> SampledSpectrum<R> {
    let again = R::splat(0.5) * more[0] * more[1] / (R::splat(PI) * mean);
    color * (color * again + SampledSpectrum::splat(single(width(roughness), wo, wi)))
}

/// E₁ of fibres of a width, by quadrature.
fn albedo(width: f32, cosine: f32) -> f32 {
    const STEPS: usize = 64;
    let cosine = cosine.max(1e-4);
    let wo = spherical_direction((1.0 - sqr(cosine)).sqrt(), cosine, 0.0);
    let middle = |i: usize| (i as f32 + 0.5) / STEPS as f32;
    let light = |i: usize| {
        let (root, phi) = (middle(i / STEPS), PI * middle(i % STEPS));
        let wi = spherical_direction((1.0 - sqr(sqr(root))).sqrt(), sqr(root), phi);
        f64::from(single(width, wo, wi) * wi.z * TAU * 2.0 * root)
    };
    ((0..STEPS * STEPS).map(light).sum::<f64>() / (STEPS * STEPS) as f64) as f32
}
