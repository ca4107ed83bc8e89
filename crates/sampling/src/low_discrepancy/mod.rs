//! Low-discrepancy sequences: radical inverses in prime bases, and Sobol' points.

mod radical_inverse;
mod sobol;

pub use radical_inverse::{
    PRIME_COUNT, owen_scrambled_radical_inverse, permuted_radical_inverse, prime, radical_inverse,
};
pub use sobol::{
    SOBOL_DIMENSIONS, fast_owen_scramble, owen_scramble, pascal_digits, reverse_bits, sobol_digits,
};
