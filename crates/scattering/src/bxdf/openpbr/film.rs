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

use math::sqr;
use std::f32::consts::PI;
use std::ops::{Add, Div, Mul, Sub};

/// A complex number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Complex {
    pub re: f32,
    pub im: f32,
}

impl Complex {
    pub fn real(re: f32) -> Self {
        Self { re, im: 0.0 }
    }

    fn norm2(self) -> f32 {
        sqr(self.re) + sqr(self.im)
    }

    /// The root with no negative part, of a number with no negative imaginary part.
    fn sqrt(self) -> Self {
        let modulus = self.norm2().sqrt();
        let [re, im] = [modulus + self.re, modulus - self.re].map(|twice| (0.5 * twice).max(0.0).sqrt());
        Self { re, im }
    }

    /// e^{i self}.
    fn exp_i(self) -> Self {
        let (sin, cos) = lanes::sin_cos(self.re);
        let scale = lanes::exp(-self.im);
        Self { re: scale * cos, im: scale * sin }
    }
}

impl Add for Complex {
    type Output = Self;

    fn add(self, b: Self) -> Self {
        Self { re: self.re + b.re, im: self.im + b.im }
    }
}

impl Sub for Complex {
    type Output = Self;

    fn sub(self, b: Self) -> Self {
        Self { re: self.re - b.re, im: self.im - b.im }
    }
}

impl Mul for Complex {
    type Output = Self;

    fn mul(self, b: Self) -> Self {
        Self { re: self.re * b.re - self.im * b.im, im: self.re * b.im + self.im * b.re }
    }
}

impl Div for Complex {
    type Output = Self;

    fn div(self, b: Self) -> Self {
        let product = self * Self { re: b.re, im: -b.im };
        Self { re: product.re / b.norm2(), im: product.im / b.norm2() }
    }
}

/// The reflectance of a film of `thickness` wavelengths of vacuum and index `film`, between the
/// indices `above` and `below`, for light from above with the cosine `cosine`.
pub(super) fn film_reflectance(cosine: f32, above: f32, film: f32, below: Complex, thickness: f32) -> f32 {
    // Nearer to the horizon both ratios tend to −1 and 1, and their sum over the difference to 0/0.
    let cosine = cosine.max(1e-3);
    let indices = [Complex::real(above), Complex::real(film), below];
    let across2 = Complex::real(sqr(above) * (1.0 - sqr(cosine)));
    let squares = indices.map(|n| n * n);
    let q = [Complex::real(above * cosine), (squares[1] - across2).sqrt(), (squares[2] - across2).sqrt()];
    let turn = (q[1] * Complex::real(4.0 * PI * thickness)).exp_i();
    let whole = |first: Complex, second: Complex| {
        let ratio = (first + second * turn) / (Complex::real(1.0) + first * second * turn);
        ratio.norm2()
    };
    let perpendicular = |i: usize| (q[i] - q[i + 1]) / (q[i] + q[i + 1]);
    let parallel = |i: usize| {
        let (a, b) = (squares[i + 1] * q[i], squares[i] * q[i + 1]);
        (a - b) / (a + b)
    };
    let sum = whole(perpendicular(0), perpendicular(1)) + whole(parallel(0), parallel(1));
    (0.5 * sum).clamp(0.0, 1.0)
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
        assert!(film_reflectance(1.0, 1.0, index, Complex::real(1.5), 0.25 / index) < 1e-6);
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
                            let found = film_reflectance(cosine, above, film, metal, thickness);
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
