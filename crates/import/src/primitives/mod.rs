//! Mesh primitives: triangles and their surfaces, as files of several formats have them, put
//! together as shapes of a scene.

mod colors;
mod emission;
mod primitive;
mod shape;
mod surface;

pub(crate) use colors::unwrapped;
pub(crate) use primitive::{Primitive, Target};
pub(crate) use shape::{Look, Vertices};
pub(crate) use surface::{Coordinates, Principled, Surface};
