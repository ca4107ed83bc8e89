//! The program, run as its users run it.

mod common;
mod compare;
mod console;
mod errors;
mod image;
mod interrupt;
mod meshes;
mod render;
mod resume;
