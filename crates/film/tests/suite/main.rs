//! Films, filters and the film file.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod all_filters;
mod file;
mod film;
mod layers;
mod spectral;
mod splats;
