//! Warps: maps from uniform numbers to a domain, with their densities and inverses.
//!
//! `sample_x(u)` maps u in [0, 1) or [0, 1)², `x_pdf(p)` is the density of the result per
//! length, area or solid angle of the domain, and `invert_x(p)` returns u. Where a warp needs
//! preparation it is a type with methods `sample`, `pdf` and `invert`. Directions are unit vectors
//! in a local frame with its axis along +z, unless points of space are given.

mod disk;
mod interval;
mod rectangle;
mod sphere;
mod square;
mod triangle;

pub use disk::*;
pub use interval::*;
pub use rectangle::SphericalRectangle;
pub use sphere::*;
pub use square::*;
pub use triangle::*;
