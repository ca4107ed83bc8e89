//! Statistical tests on plain numbers: χ², t and z.
//!
//! A sampling routine and its density are two claims about one distribution; [`Chi2`] holds them
//! against each other. An estimator and an exact value are held together by [`t_test`] or
//! [`z_test`], two estimators by [`welch_test`]. Everything here speaks `[f32; 2]`, `[f32; 3]` and
//! `f64`, so that each crate can use it.
//!
//! Every test draws from a generator with a fixed seed ([`Random`]) and divides its significance
//! among the number of tests that run side by side (Šidák's correction), so it gives the same
//! answer in every run.

mod chi2;
mod means;
mod quadrature;
mod random;
mod special;

pub use chi2::Chi2;
pub use means::{Moments, t_test, welch_test, z_test};
pub use quadrature::integrate;
pub use random::Random;
pub use special::{chi2_cdf, ln_gamma, normal_cdf, regularized_beta, regularized_gamma, sidak, student_cdf};

/// The chance that a whole family of right tests is refused: shared among its members by [`sidak`].
pub const SIGNIFICANCE: f64 = 0.01;
