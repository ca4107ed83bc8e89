//! Films, filters and the film file.

mod all_filters;
mod file;
mod film;
mod layers;
mod splats;
