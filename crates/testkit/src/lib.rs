//! Statistical tests on plain numbers: χ², t and z; and lanes against single numbers.
//!
//! [`Chi2`] tests a sampling routine against its density, [`t_test`] and [`z_test`] an estimator
//! against an exact value, [`welch_test`] two estimators against each other. All take `[f32; 2]`,
//! `[f32; 3]` and `f64`, so that every crate can use them.
//!
//! [`lanes_agree`] runs a [`LaneFunction`] on every instruction set. [`data`] finds files of other
//! authors. [`check_generated`] compares a page with the code that it is made of;
//! [`assert_complete`] holds the table of a contract to its closed set.
//!
//! Every test has a generator with a fixed seed ([`Random`]), so that its result is reproducible,
//! and corrects its significance for the number of tests (Šidák's correction).

mod chi2;
mod complete;
mod data;
mod generated;
mod lane_function;
mod means;
mod quadrature;
mod random;
mod special;

pub use chi2::Chi2;
pub use complete::assert_complete;
pub use data::{data, skip};
pub use generated::check_generated;
pub use lane_function::{LaneFunction, lanes_agree};
pub use means::{Moments, t_test, welch_test, z_test};
pub use quadrature::integrate;
pub use random::Random;
pub use special::{chi2_cdf, ln_gamma, normal_cdf, regularized_beta, regularized_gamma, sidak, student_cdf};

/// The probability that any test of a family rejects a true hypothesis; [`sidak`] gives that of one
/// test.
pub const SIGNIFICANCE: f64 = 0.01;
