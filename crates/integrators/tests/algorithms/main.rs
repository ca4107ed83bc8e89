//! The algorithms against closed forms and each other, and the contract of sessions.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod adaptive;
mod agreement;
mod ambient_occlusion;
mod border;
mod build;
mod cancellation;
mod direct_light;
mod function;
mod furnace;
mod layers;
mod media;
mod merging;
mod mlt;
mod openpbr;
mod parts;
mod photon_mapping;
mod reflections;

mod session;
mod subsurface;
mod subsurface_light_paths;
mod support;
