//! A small planet made of spheres.
//!
//! [`Planet::new`] makes the land of formulas and a seed: meadows, beaches, trees, rocks and frozen
//! lakes around a core, loose balls, and a moon. [`Planet::step`] moves what is loose by gravity
//! and collisions, and whoever walks there ([`Walker`]). [`scene`] writes the planet as it is in
//! the pbrt format.
//!
//! The same steps give the same bits, whatever the number of threads and the instruction set.

mod bodies;
mod contacts;
mod grid;
mod land;
mod noise;
mod planet;
mod rounds;
mod scene;
mod substance;
mod tree;
mod walker;

pub use bodies::{Bodies, State};
pub use planet::{Energy, Mover, Planet};
pub use scene::{Viewpoint, scene};
pub use substance::Substance;
pub use walker::{Input, Walker};
