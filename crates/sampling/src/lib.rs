//! Random numbers, warps with their densities and inverses, distributions, and low-discrepancy
//! samplers.
//!
//! A [`Sampler`] gives the coordinates of a point in [0, 1)ⁿ; a [`warp`] or a distribution maps
//! them to a sample of its density. Samples depend on seeds that the caller passes, never on time
//! or order.

mod alias_table;
mod discrete;
mod hash;
mod hash_sequence;
pub mod low_discrepancy;
mod piecewise_bilinear;
mod piecewise_constant;
mod resampling;
mod reservoir;
mod rng;
pub mod sampler;
pub mod warp;
mod windowed;

pub use alias_table::AliasTable;
pub use discrete::{DiscreteSample, sample_discrete};
pub use hash::{hash, hash_float, mix_bits, mix_quadruple, mix_word, permutation_element};
pub use hash_sequence::HashSequence;
pub use piecewise_bilinear::{LayerWeights, PiecewiseBilinear2d};
pub use piecewise_constant::{PiecewiseConstant1d, PiecewiseConstant2d};
pub use resampling::resample;
pub use reservoir::WeightedReservoir;
pub use rng::Rng;
pub use sampler::{Randomize, Sampler};
pub use windowed::WindowedPiecewiseConstant2d;
