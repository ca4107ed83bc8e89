//! Benchmarks of the ray engine: meshes, rays, Embree for comparison, and timing.
//!
//! `cargo xtask bench rays` runs the program of this crate; `cargo bench --package alhazen-bench`
//! runs microbenchmarks of its parts.

pub mod building;
pub mod embree;
pub mod mesh;
pub mod rays;
pub mod table;
pub mod timing;
pub mod tracing;
