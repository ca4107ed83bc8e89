//! The engine that renders scenes on GPUs, by wgpu.
//!
//! [`Device`] is the GPU, [`Bvh`] what rays are traced through there. [`shaders`] has the sources
//! of what runs there: *laws*, which are physics and are translated from Rust, and *plumbing*,
//! which is written in WGSL.

mod bvh;
mod device;
pub mod shaders;

pub use bvh::{Bvh, BvhError, Top, Words};
pub use device::{Buffer, Device, GpuError, Kernel};
