//! Distribution functions: the normal, Student's t and χ² distributions, from the incomplete gamma
//! and beta functions.
//!
//! P(a, x) is summed as a series below its mean and as a continued fraction above it; Iₓ(a, b) is a
//! continued fraction, used on the side where it converges fast [Press 2007 §6.2, §6.4]. Relative
//! error is near 1e-14.

use std::f64::consts::PI;

/// Number of terms after which a series or fraction has converged for all arguments in tests.
const MAX_TERMS: usize = 100_000;
const EPSILON: f64 = 1e-16;
/// Keeps the denominators of a continued fraction away from zero.
const TINY: f64 = 1e-300;

/// ln Γ(x) for x > 0, by Lanczos' approximation (g = 7, nine terms).
pub fn ln_gamma(x: f64) -> f64 {
    const COEFFICIENTS: [f64; 8] = [
        676.5203681218851,
        -1259.1392167224028,
        771.323_428_777_653_1,
        -176.615_029_162_140_6,
        12.507343278686905,
        -0.13857109526572012,
        9.984_369_578_019_572e-6,
        1.5056327351493116e-7,
    ];
    if x < 0.5 {
        return (PI / (PI * x).sin()).ln() - ln_gamma(1.0 - x);
    }
    let x = x - 1.0;
    let sum = COEFFICIENTS
        .iter()
        .enumerate()
        .fold(0.999_999_999_999_809_9, |sum, (i, c)| sum + c / (x + i as f64 + 1.0));
    let t = x + 7.5;
    0.5 * (2.0 * PI).ln() + (x + 0.5) * t.ln() - t + sum.ln()
}

/// P(a, x) = γ(a, x) / Γ(a) for a > 0.
pub fn regularized_gamma(a: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    let scale = (a * x.ln() - x - ln_gamma(a)).exp();
    if x < a + 1.0 {
        let (mut term, mut sum) = (1.0 / a, 1.0 / a);
        for n in 1..MAX_TERMS {
            term *= x / (a + n as f64);
            sum += term;
            if term < sum * EPSILON {
                break;
            }
        }
        return sum * scale;
    }
    let mut b = x + 1.0 - a;
    let mut c = 1.0 / TINY;
    let mut d = 1.0 / b;
    let mut fraction = d;
    for n in 1..MAX_TERMS {
        let n = n as f64;
        let an = -n * (n - a);
        b += 2.0;
        d = 1.0 / away_from_zero(an * d + b);
        c = away_from_zero(b + an / c);
        let factor = c * d;
        fraction *= factor;
        if (factor - 1.0).abs() < EPSILON {
            break;
        }
    }
    1.0 - scale * fraction
}

/// Iₓ(a, b), the regularised incomplete beta function for a, b > 0.
pub fn regularized_beta(a: f64, b: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    if x >= 1.0 {
        return 1.0;
    }
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - regularized_beta(b, a, 1.0 - x);
    }
    let scale = (ln_gamma(a + b) - ln_gamma(a) - ln_gamma(b) + a * x.ln() + b * (1.0 - x).ln()).exp();
    let mut c = 1.0;
    let mut d = 1.0 / away_from_zero(1.0 - (a + b) * x / (a + 1.0));
    let mut fraction = d;
    for n in 1..MAX_TERMS {
        let n = n as f64;
        let even = n * (b - n) * x / ((a + 2.0 * n - 1.0) * (a + 2.0 * n));
        let odd = -(a + n) * (a + b + n) * x / ((a + 2.0 * n) * (a + 2.0 * n + 1.0));
        d = 1.0 / away_from_zero(1.0 + even * d);
        c = away_from_zero(1.0 + even / c);
        fraction *= c * d;
        d = 1.0 / away_from_zero(1.0 + odd * d);
        c = away_from_zero(1.0 + odd / c);
        fraction *= c * d;
        if (c * d - 1.0).abs() < EPSILON {
            break;
        }
    }
    scale * fraction / a
}

fn away_from_zero(x: f64) -> f64 {
    if x.abs() < TINY { TINY } else { x }
}

/// The probability that a standard normal variable is at most `z`.
pub fn normal_cdf(z: f64) -> f64 {
    let half_erf = 0.5 * regularized_gamma(0.5, 0.5 * z * z);
    if z < 0.0 { 0.5 - half_erf } else { 0.5 + half_erf }
}

/// The probability that a χ² variable with `degrees` degrees of freedom is at most `x`.
pub fn chi2_cdf(x: f64, degrees: f64) -> f64 {
    regularized_gamma(0.5 * degrees, 0.5 * x)
}

/// The probability that Student's t with `degrees` degrees of freedom is at most `t`.
pub fn student_cdf(t: f64, degrees: f64) -> f64 {
    let tail = 0.5 * regularized_beta(0.5 * degrees, 0.5, degrees / (degrees + t * t));
    if t < 0.0 { tail } else { 1.0 - tail }
}

/// The significance of one test such that `tests` of them together reject a true hypothesis with
/// probability `significance` [Šidák 1967].
pub fn sidak(significance: f64, tests: usize) -> f64 {
    1.0 - (1.0 - significance).powf(1.0 / tests.max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(value: f64, expected: f64) {
        assert!((value - expected).abs() < 1e-12 * expected.abs().max(1.0), "{value} is not {expected}");
    }

    #[test]
    fn gamma_of_whole_and_half_numbers() {
        near(ln_gamma(5.0), 24f64.ln());
        near(ln_gamma(0.5), PI.sqrt().ln());
        near(ln_gamma(0.25), 3.625_609_908_221_908_f64.ln());
    }

    #[test]
    fn gamma_ratio_of_one_is_the_exponential_distribution() {
        for x in [0.1, 1.0, 1.9, 2.1, 10.0] {
            near(regularized_gamma(1.0, x), 1.0 - (-x).exp());
        }
    }

    #[test]
    fn tabulated_quantiles() {
        near(normal_cdf(1.959_963_984_540_054), 0.975);
        near(normal_cdf(-1.959_963_984_540_054), 0.025);
        near(chi2_cdf(3.841_458_820_694_124, 1.0), 0.95);
        near(chi2_cdf(124.342_113_404_003_9, 100.0), 0.95);
        near(student_cdf(1.0, 1.0), 0.75);
        near(student_cdf(2.228_138_851_964_939, 10.0), 0.975);
        near(student_cdf(-2.228_138_851_964_939, 10.0), 0.025);
    }

    #[test]
    fn beta_is_symmetric_and_known_for_small_exponents() {
        near(regularized_beta(2.0, 1.0, 0.3), 0.09);
        near(regularized_beta(1.0, 3.0, 0.2), 1.0 - 0.8f64.powi(3));
        near(regularized_beta(2.5, 4.5, 0.4), 1.0 - regularized_beta(4.5, 2.5, 0.6));
    }

    #[test]
    fn sidak_correction() {
        near(sidak(0.01, 1), 0.01);
        near(1.0 - (1.0 - sidak(0.01, 50)).powi(50), 0.01);
    }
}
