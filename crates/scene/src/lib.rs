//! The compiled world: textures, materials, lights, cameras and the scene they make.

pub mod camera;
pub mod texture;
