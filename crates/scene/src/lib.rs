//! The compiled world: textures, materials, lights, cameras and the scene they make.
//!
//! [`compile`] turns what an author said into a [`Scene`], once; from then on nothing changes.
//! Everything stands in tables and is referred to by small ids.

pub mod camera;
mod compile;
mod interaction;
pub mod light;
pub mod light_sampler;
pub mod material;
mod scene;
pub mod texture;

pub use compile::{Compiled, compile};
pub use geometry::RayStats;
pub use interaction::{Footprint, SurfaceInteraction};
pub use scene::{GeometryEntry, InstanceEntry, Interfaces, Scene, SceneOptions};
