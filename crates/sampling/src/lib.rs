//! Random numbers, warps with their densities and inverses, distributions, and low-discrepancy
//! samplers.
//!
//! A [`Sampler`] gives the coordinates of a point in [0, 1)ⁿ, a [`warp`] or a distribution carries
//! such coordinates to where they are wanted. What is drawn depends on seeds that the caller
//! passes, never on time or order.

mod alias_table;
mod discrete;
mod hash;
pub mod low_discrepancy;
mod piecewise_constant;
mod reservoir;
mod rng;
pub mod sampler;
pub mod warp;

pub use alias_table::AliasTable;
pub use discrete::{DiscreteSample, sample_discrete};
pub use hash::{hash, hash_float, mix_bits, permutation_element};
pub use piecewise_constant::{PiecewiseConstant1d, PiecewiseConstant2d};
pub use reservoir::WeightedReservoir;
pub use rng::Rng;
pub use sampler::{Randomize, Sampler};

/// The number in [0, 1) that 32 bits stand for as a binary fraction.
#[inline]
fn unit_interval(bits: u32) -> f32 {
    (bits as f32 * (1.0 / 4_294_967_296.0)).min(math::ONE_MINUS_EPSILON)
}
