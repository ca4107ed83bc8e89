//! Files of all formats: their descriptions, and the messages about their errors.

mod corpora;
mod gltf;
mod hostile;
mod meshes;
mod studio;
#[cfg(feature = "usd")]
mod usd;
mod volumes;
mod wavefront;
