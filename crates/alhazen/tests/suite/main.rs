//! Renders against closed forms, each other and the pictures of other programs.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod agreement;
mod common;
mod converted;
mod documents;
mod engines;
mod furnaces;
mod gltf;
mod gltf_materials;
mod irradiance;
mod malformed;
mod minray;
mod mitsuba;
mod moving_lights;
mod nori;
mod photons;
mod python_settings;
mod radiosity;
mod references;
mod scenes;
mod sizes;
mod sketch;
