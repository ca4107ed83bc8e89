//! The program, run as its users run it.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod common;
mod compare;
mod console;
#[cfg(feature = "gpu")]
mod device;
mod doctor;
#[cfg(unix)]
mod documents;
mod errors;
mod image;
mod inlining;
mod interrupt;
#[cfg(target_os = "linux")]
mod memory;
mod meshes;
mod render;
mod resume;
mod scene;
#[cfg(feature = "serve")]
mod serve;
mod tev;
mod trace;
mod view;
