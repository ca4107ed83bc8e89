//! Tests of means: a sample against an exact value, or two samples against each other.

use crate::{SIGNIFICANCE, normal_cdf, sidak, student_cdf};

/// Count, mean and variance of a stream of numbers, by Welford's update.
#[derive(Clone, Copy, Debug, Default)]
pub struct Moments {
    /// Number of values.
    pub count: usize,
    /// Their mean.
    pub mean: f64,
    squares: f64,
}

impl Moments {
    /// Adds a value.
    pub fn push(&mut self, x: f64) {
        self.count += 1;
        let delta = x - self.mean;
        self.mean += delta / self.count as f64;
        self.squares += delta * (x - self.mean);
    }

    /// The unbiased estimate of the variance of a value; 0 for fewer than two.
    pub fn variance(&self) -> f64 {
        if self.count < 2 { 0.0 } else { self.squares / (self.count - 1) as f64 }
    }

    /// The variance of the mean.
    pub fn variance_of_mean(&self) -> f64 {
        self.variance() / self.count.max(1) as f64
    }
}

impl FromIterator<f64> for Moments {
    fn from_iter<I: IntoIterator<Item = f64>>(numbers: I) -> Moments {
        let mut moments = Moments::default();
        numbers.into_iter().for_each(|x| moments.push(x));
        moments
    }
}

/// Whether a sample's mean is `expected` (Student's one-sample test), as one of `tests` tests.
///
/// A sample without variance has to have the expected mean up to rounding.
pub fn t_test(sample: &Moments, expected: f64, tests: usize) -> Result<(), String> {
    let variance = sample.variance_of_mean();
    verdict(sample.mean, expected, variance, tests, |t| student_cdf(t, sample.count.max(2) as f64 - 1.0))
}

/// Whether a mean with a known standard error is `expected` (z-test), as one of `tests` tests.
pub fn z_test(mean: f64, standard_error: f64, expected: f64, tests: usize) -> Result<(), String> {
    verdict(mean, expected, standard_error * standard_error, tests, normal_cdf)
}

/// Whether two samples have equal means, with any variances (Welch's test), as one of `tests`
/// tests.
pub fn welch_test(a: &Moments, b: &Moments, tests: usize) -> Result<(), String> {
    let (va, vb) = (a.variance_of_mean(), b.variance_of_mean());
    let freedom = |v: f64, count: usize| v * v / (count.max(2) - 1) as f64;
    let degrees = (va + vb).powi(2) / (freedom(va, a.count) + freedom(vb, b.count));
    verdict(a.mean, b.mean, va + vb, tests, |t| student_cdf(t, degrees))
}

fn verdict(
    mean: f64,
    expected: f64,
    variance: f64,
    tests: usize,
    cdf: impl Fn(f64) -> f64,
) -> Result<(), String> {
    let difference = mean - expected;
    if difference.abs() <= 1e-12 * mean.abs().max(expected.abs()) {
        return Ok(());
    }
    let score = difference / variance.sqrt();
    let p = 2.0 * cdf(-score.abs());
    let alpha = sidak(SIGNIFICANCE, tests);
    if p >= alpha {
        return Ok(());
    }
    Err(format!(
        "mean {mean:.6e} differs from {expected:.6e} by {score:.2} standard errors of {:.3e}: p = {p:.3e} is below {alpha:.3e}",
        variance.sqrt(),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Random;

    fn squares(count: usize, seed: u64, shift: f64) -> Moments {
        let mut random = Random::new(seed);
        (0..count).map(|_| (random.get_1d() as f64).powi(2) + shift).collect()
    }

    #[test]
    fn moments_of_a_short_list() {
        let moments: Moments = [1.0, 2.0, 3.0, 6.0].into_iter().collect();
        assert_eq!((moments.count, moments.mean), (4, 3.0));
        assert!((moments.variance() - 14.0 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn the_right_mean_is_accepted() {
        for seed in 0..20 {
            t_test(&squares(2000, seed, 0.0), 1.0 / 3.0, 20).unwrap();
            welch_test(&squares(2000, seed, 0.0), &squares(900, seed + 100, 0.0), 20).unwrap();
        }
        let sample = squares(2000, 1, 0.0);
        z_test(sample.mean, sample.variance_of_mean().sqrt(), 1.0 / 3.0, 1).unwrap();
    }

    #[test]
    fn a_wrong_mean_is_rejected() {
        let sample = squares(20_000, 1, 0.02);
        t_test(&sample, 1.0 / 3.0, 20).unwrap_err();
        z_test(sample.mean, sample.variance_of_mean().sqrt(), 1.0 / 3.0, 20).unwrap_err();
        welch_test(&sample, &squares(20_000, 2, 0.0), 20).unwrap_err();
        t_test(&Moments::from_iter([0.5; 10]), 0.6, 1).unwrap_err();
        t_test(&Moments::from_iter([f64::NAN; 10]), 0.6, 1).unwrap_err();
    }

    #[test]
    fn means_without_variance_are_compared_exactly() {
        t_test(&Moments::from_iter([0.5; 10]), 0.5, 1).unwrap();
    }
}
