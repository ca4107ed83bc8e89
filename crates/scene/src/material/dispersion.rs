//! Cauchy's index of refraction n = A + B/λ², given at the d line and by the Abbe number.

use lanes::Real;
use math::sqr;

/// The Fraunhofer lines F, d and C, in nanometres.
const F: f32 = 486.134;
const D: f32 = 587.562;
const C: f32 = 656.281;

/// The index of refraction at a wavelength, of a glass of index `ior` at the d line.
#[inline(always)]
pub(super) fn cauchy<R: Real>(ior: R, abbe_number: R, lambda: R) -> R {
    let [f, d, c] = [1.0 / sqr(F), 1.0 / sqr(D), 1.0 / sqr(C)];
    let scale = (ior - R::one()) / (abbe_number * R::splat(f - c));
    ior + scale * (R::one() / sqr(lambda) - R::splat(d))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_follow_the_abbe_number() {
        let [f, d, c] = [F, D, C].map(|line| cauchy(1.6f32, 30.0, line));
        assert!((d - 1.6).abs() < 1e-6);
        assert!(((d - 1.0) / (f - c) - 30.0).abs() < 0.01, "{f} {c}");
    }
}
