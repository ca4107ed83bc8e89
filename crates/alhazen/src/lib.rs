//! alhazen, a physically based renderer, as a library.
//!
//! The crates of the house under their names, and what joins them into a program.

pub use description;
pub use film;
pub use geometry;
pub use image;
pub use import;
pub use math;
pub use sampling;
pub use scattering;
pub use spectrum;

mod overrides;

pub use overrides::{INTEGRATORS, OverrideError, Overrides, SETTINGS, Setting};
