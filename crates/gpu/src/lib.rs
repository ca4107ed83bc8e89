//! The engine that renders scenes on GPUs, by wgpu.
//!
//! [`flatten`] makes buffers of a scene, or says what kernels do not draw; a [`Renderer`] adds
//! samples of its pixels to a film, a [`Realtime`] makes pictures at once. [`Device`] is the GPU,
//! [`Bvh`] what rays are traced through there. [`shaders`] has the sources of what runs there:
//! *laws*, which are physics and are translated from Rust, and *plumbing*, which is written in
//! WGSL.
//!
//! What is [`Moving`] has trees that the GPU builds for each picture.
//!
//! A [`Rasterizer`] draws scenes triangle by triangle instead, by the raster pipeline.

mod algorithm;
mod bvh;
mod bxdfs;
mod commands;
mod device;
mod dynamic;
mod flatten;
mod parts;
mod pruning;
mod raster;
mod realtime;
mod records;
mod renderer;
pub mod shaders;
mod tags;
mod trees;

pub use algorithm::Algorithm;
pub use bvh::{Bvh, BvhError, Top, Words};
pub use device::{Binding, Buffer, Device, GpuError, Kernel};
pub use dynamic::{Moving, MovingError, Sorter, Start, Update};
pub use flatten::{Flat, Refusal, Subject, flatten, openpbr_table};
pub use raster::{DrawError, Drawing, Rasterizer};
pub use realtime::{AimError, Picture, Realtime, Stages, Weights};
pub use renderer::{FindFirstHit, Kernels, PassError, Renderer, lacking_stages};
pub use trees::Trees;
