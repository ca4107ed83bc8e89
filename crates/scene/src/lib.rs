//! The compiled scene: textures, materials, lights and geometry, and the views of it.
//!
//! [`compile`] turns a description into an immutable [`Scene`]. Its parts are stored in tables and
//! refer to each other by small ids. A [`View`] adds the camera.

mod cache;
pub mod camera;
mod compile;
mod dynamic;
mod footprint;
mod id;
mod interaction;
pub mod light;
pub mod light_sampler;
pub mod material;
pub mod medium;
mod names;
mod scene;
mod shutter_sample;
pub mod texture;
mod traits;
mod view;

pub use cache::SceneCache;
pub use compile::{Compiled, compile};
pub use dynamic::MoveError;
pub use footprint::Footprint;
pub use geometry::RayStats;
pub use interaction::SurfaceInteraction;
pub use names::Names;
pub use scene::{GeometryEntry, InstanceEntry, Interfaces, Scene};
pub use shutter_sample::ShutterSample;
pub use traits::{Occurrence, SceneTraits};
pub use view::{CompiledView, View, ViewOptions, world_from_render};
