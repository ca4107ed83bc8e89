//! Files of all formats: their descriptions, and the messages about their errors.

mod corpora;
mod directives;
mod gltf;
mod hostile;
mod meshes;
mod messages;
#[cfg(feature = "usd")]
mod usd;
mod volumes;
