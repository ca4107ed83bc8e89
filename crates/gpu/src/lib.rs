//! The engine that renders scenes on GPUs, by wgpu.
//!
//! [`Device`] is the GPU. [`shaders`] has the sources of what runs there: *laws*, which are
//! physics and are translated from Rust, and *plumbing*, which is written in WGSL.

mod device;
pub mod shaders;

pub use device::{Buffer, Device, GpuError, Kernel};
