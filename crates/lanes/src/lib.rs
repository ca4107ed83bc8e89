//! SIMD: vectors of floats, the instruction sets that compute with them, and dispatch at run time.
//!
//! A [`Task`] is written once for any [`Simd`] and compiled for each instruction set.
//! [`InstructionSet::detect`] finds the best one of the processor, and [`InstructionSet::run`] runs
//! the task with it. Every operation gives the same bits on every set, fused multiply-add
//! included, so that results do not depend on the machine. The one exception is
//! [`Vector::relaxed_mul_sub`], for bounds that are conservative anyway.
//!
//! Only what makes a vector is unsafe: a vector is the proof that the processor has the
//! instructions that compute with it.

// Vector intrinsics are unsafe; only this crate calls them.
#![allow(unsafe_code)]

#[macro_use]
mod simd;

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod baseline;
mod instruction_set;
#[cfg(target_arch = "aarch64")]
mod neon;
mod pair;
mod real;
mod scalar;
mod single;
#[cfg(target_arch = "x86_64")]
mod sse2;

pub use baseline::{first_equal, prefetch};
pub use instruction_set::InstructionSet;
pub use real::{Int, MAX_LANES, Mask, Real};
pub use scalar::F32x1;
pub use simd::{Kernel, Simd, Task, Vector};
