//! Reflectance of a film with parallel sides, at one wavelength.
//!
//! With the normal components q_j = √(n_j² − n₀² sin²θ₀) of the wave vector above (0), in (1) and
//! below (2) the film, in units of 2π/λ, all waves that are reflected between its sides sum to
//!
//! ```text
//! r = (r₀₁ + r₁₂ e^{iφ})/(1 + r₀₁ r₁₂ e^{iφ})        φ = 4π q₁ d/λ
//! ```
//!
//! for each polarisation, with r_ij = (q_i − q_j)/(q_i + q_j) across the plane of incidence and
//! (n_j² q_i − n_i² q_j)/(n_j² q_i + n_i² q_j) along it; unpolarised light is reflected by the mean
//! of |r|². Complex indices and q, where the film reflects all light inside, need no other formula.
//! Source: [Born 1999 §1.6.4].

use lanes::{Real, exp, sin_cos};
use math::sqr;
use std::f32::consts::PI;

/// A complex number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Complex<R = f32> {
    pub re: R,
    pub im: R,
}

impl<R: Real> Complex<R> {
    #[inline(always)]
    pub fn real(re: R) -> Self {
        Self { re, im: R::zero() }
    }

    #[inline(always)]
    fn norm2(self) -> R {
        sqr(self.re) + sqr(self.im)
    }

    /// The root with no negative part, of a number with no negative imaginary part.
    #[inline(always)]
    fn root(self) -> Self {
        let (modulus, half) = (self.norm2().sqrt(), R::splat(0.5));
        let re = (half * (modulus + self.re)).max(R::zero()).sqrt();
        let im = (half * (modulus - self.re)).max(R::zero()).sqrt();
        Self { re, im }
    }

    /// e^{i self}.
    #[inline(always)]
    fn exp_i(self) -> Self {
        let (sin, cos) = sin_cos(self.re);
        let scale = exp(-self.im);
        Self { re: scale * cos, im: scale * sin }
    }

    #[inline(always)]
    fn plus(self, b: Self) -> Self {
        Self { re: self.re + b.re, im: self.im + b.im }
    }

    #[inline(always)]
    fn minus(self, b: Self) -> Self {
        Self { re: self.re - b.re, im: self.im - b.im }
    }

    #[inline(always)]
    fn times(self, b: Self) -> Self {
        Self { re: self.re * b.re - self.im * b.im, im: self.re * b.im + self.im * b.re }
    }

    #[inline(always)]
    fn over(self, b: Self) -> Self {
        let product = self.times(Self { re: b.re, im: -b.im });
        Self { re: product.re / b.norm2(), im: product.im / b.norm2() }
    }

    /// (a − b)/(a + b).
    #[inline(always)]
    fn contrast(self, b: Self) -> Self {
        self.minus(b).over(self.plus(b))
    }
}

/// |r|² of both sides by their own r, with what a way through the film and back turns.
#[inline(always)]
fn both_sides<R: Real>(first: Complex<R>, second: Complex<R>, turn: Complex<R>) -> R {
    let again = second.times(turn);
    let ratio = first.plus(again).over(Complex::real(R::one()).plus(first.times(again)));
    ratio.norm2()
}

/// The reflectance of a film of index `film` and the optical thickness of `waves` wavelengths,
/// n₁d/λ, between the indices `above` and `below`, for light from above with the cosine `cosine`.
#[inline(always)]
pub(super) fn film_reflectance<R: Real>(cosine: R, above: R, film: R, below: Complex<R>, waves: R) -> R {
    // Nearer to the horizon both ratios tend to −1 and 1, and their sum over the difference to 0/0.
    let cosine = cosine.max(R::splat(1e-3));
    let across2 = Complex::real(sqr(above) * (R::one() - sqr(cosine)));
    let (s0, s1) = (Complex::real(sqr(above)), Complex::real(sqr(film)));
    let s2 = below.times(below);
    let q0 = Complex::real(above * cosine);
    let q1 = s1.minus(across2).root();
    let q2 = s2.minus(across2).root();
    let turn = q1.times(Complex::real(R::splat(4.0 * PI) * waves / film)).exp_i();
    let perpendicular = both_sides(q0.contrast(q1), q1.contrast(q2), turn);
    let (above_film, below_film) = (s1.times(q0).contrast(s0.times(q1)), s2.times(q1).contrast(s1.times(q2)));
    let parallel = both_sides(above_film, below_film, turn);
    (R::splat(0.5) * (perpendicular + parallel)).clamp(R::zero(), R::one())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{fr_complex, fr_dielectric};

    /// A film of no thickness, or of the index of either side, is not there.
    #[test]
    fn a_film_that_is_not_there_does_not_reflect() {
        for cosine in [1.0f32, 0.7, 0.3, 0.05] {
            for (film, thickness) in [(1.4, 0.0), (1.0, 0.8), (1.5, 0.8)] {
                let found = film_reflectance(cosine, 1.0, film, Complex::real(1.5), thickness);
                assert!((found - fr_dielectric(cosine, 1.5)).abs() < 1e-5, "{cosine} {film}: {found}");
            }
            let metal = Complex { re: 0.4, im: 3.1 };
            let found = film_reflectance(cosine, 1.0, 1.4, metal, 0.0);
            assert!((found - fr_complex(cosine, 0.4, 3.1)).abs() < 1e-5, "{cosine}: {found}");
        }
    }

    /// A quarter of a wavelength of index √n extinguishes the reflection by n.
    #[test]
    fn an_antireflection_coat_does_not_reflect() {
        let index = 1.5f32.sqrt();
        assert!(film_reflectance(1.0, 1.0, index, Complex::real(1.5), 0.25) < 1e-6);
    }

    /// The characteristic matrix of a layer in double precision ([Born 1999 §1.6.2]): the fields at
    /// both sides are joined by (cos β, −i sin β/p; −i p sin β, cos β).
    fn matrix_oracle(cosine: f64, [n0, n1]: [f64; 2], below: (f64, f64), thickness: f64) -> f64 {
        type C = (f64, f64);
        let add = |a: C, b: C| (a.0 + b.0, a.1 + b.1);
        let mul = |a: C, b: C| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
        let norm = |a: C| a.0 * a.0 + a.1 * a.1;
        let div = |a: C, b: C| {
            let c = mul(a, (b.0, -b.1));
            (c.0 / norm(b), c.1 / norm(b))
        };
        let across = n0 * (1.0 - cosine * cosine).sqrt();
        let q1 = (n1 * n1 - across * across).sqrt();
        let square = add(mul(below, below), (-across * across, 0.0));
        let modulus = norm(square).sqrt();
        let q2 = (((modulus + square.0) / 2.0).sqrt(), ((modulus - square.0) / 2.0).max(0.0).sqrt());
        let q0 = n0 * cosine;
        let beta = 2.0 * std::f64::consts::PI * thickness * q1;
        let reflectance = |p0: f64, p1: f64, p2: C| {
            // (e, h) above is the matrix times (1, p₂) below.
            let e = add((beta.cos(), 0.0), mul((0.0, -beta.sin() / p1), p2));
            let h = add((0.0, -p1 * beta.sin()), mul((beta.cos(), 0.0), p2));
            let incident = mul((p0, 0.0), e);
            norm(div(add(incident, (-h.0, -h.1)), add(incident, h)))
        };
        let across_plane = reflectance(q0, q1, q2);
        let along_plane = reflectance(q0 / (n0 * n0), q1 / (n1 * n1), div(q2, mul(below, below)));
        0.5 * (across_plane + along_plane)
    }

    #[test]
    fn films_agree_with_transfer_matrices() {
        for below in [(1.5, 0.0), (1.33, 0.0), (2.4, 0.0), (0.2, 3.4), (1.0, 9.0), (2.9, 3.2)] {
            for film in [1.2f32, 1.4, 2.2] {
                for above in [1.0f32, 1.15] {
                    for thickness in [0.1f32, 0.7, 1.9] {
                        for cosine in [1.0f32, 0.8, 0.4, 0.1] {
                            let metal = Complex { re: below.0, im: below.1 };
                            let found = film_reflectance(cosine, above, film, metal, thickness * film);
                            let [c, n0, n1, d] = [cosine, above, film, thickness].map(f64::from);
                            let index = (f64::from(below.0), f64::from(below.1));
                            let expected = matrix_oracle(c, [n0, n1], index, d);
                            let message = format!("{below:?} {film} {above} {thickness} {cosine}");
                            assert!(
                                (f64::from(found) - expected).abs() < 2e-4,
                                "{message}: {found} {expected}"
                            );
                        }
                    }
                }
            }
        }
    }
}
