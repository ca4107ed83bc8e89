//! Measures the ray engine: the meshes and rays that it is measured by, Embree to hold it against,
//! and the clock.
//!
//! `cargo xtask bench rays` runs the program of this crate; `cargo bench --package alhazen-bench`
//! measures the parts.

pub mod building;
pub mod embree;
pub mod mesh;
pub mod rays;
pub mod table;
pub mod timing;
pub mod tracing;
