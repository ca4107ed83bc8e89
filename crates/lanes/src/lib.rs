//! SIMD: vectors of floats, the instruction sets that compute with them, and dispatch at run time.
//!
//! A [`Task`] is written once for any [`Simd`] and compiled for each instruction set.
//! [`InstructionSet::detect`] finds the best one of the processor, and [`InstructionSet::run`] runs
//! the task with it. Every operation gives the same bits on every set, fused multiply-add
//! included, so that results do not depend on the machine. The one exception is
//! [`Vector::relaxed_mul_sub`], for bounds that are conservative anyway.
//!
//! A [`Kernel`] is written for a number with any number of lanes, a [`Real`], be it a single `f32`;
//! [`InstructionSet::dispatch`] runs it with the widest vectors of an instruction set.
//!
//! A vector is the proof that the processor has the instructions that compute with it. What makes a
//! [`Vector`] is unsafe, so that whoever names the type gives the proof. What makes a [`Real`] is
//! safe, because the types of an instruction set are private and no other code can name them: they
//! are reached only as parameters of a `Kernel` or `Task`, which runs on a processor that has the
//! set.

// Vector intrinsics are unsafe; only this crate calls them.
#![allow(unsafe_code)]

#[macro_use]
mod tables;

mod each;
mod function;
mod instruction_set;
mod no_dispatch;
mod one_lane;
mod pair;
mod real;
mod simd;
mod slices;
mod wide;

pub use each::Each;
pub use function::{
    acos, asin, atan, atan2, cbrt, coarse_inverse_sqrt, cos, exp, exp_m1, hypot, ln, ln_1p, log2, pow, powi,
    sin, sin_cos,
};
pub use instruction_set::{F32x1, InstructionSet};
pub use no_dispatch::{first_equal, prefetch};
pub use real::{Callee, Int, Kernel, MAX_LANES, Mask, Real};
pub use simd::{Simd, Task, Vector};
pub use wide::Wide;
