//! A planet of spheres that moves while somebody walks on it.
//!
//! An [`Outing`] is the planet with its walker, and the scene that is rendered of it: time passes
//! in steps of [`STEP`], then the spheres of the compiled scene are moved to where they are, then
//! one picture is rendered, by the CPU or by a GPU. A [`PlanetReport`] has the times of all that
//! without a window.

#[cfg(feature = "gpu")]
mod on_device;
mod outing;
mod report;

pub use outing::{Moment, Outing, STEP, Spent};
pub use planet::Input;
pub use report::PlanetReport;
